// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import { someSpec } from "../wire/examples";
import { draft } from "./draft";
import { ProfileRow } from "./ProfileRow";
import { profiles, removeProfile } from "./profiles";

afterEach(() => {
  render(null, document.body);
  draft.value = null;
});

it("Enter in the profile's name saves the profile, not the mission", () => {
  draft.value = { key: "new", spec: someSpec(), hasArea: true, suggested: false, text: {} };
  const submitted = vi.fn();
  act(() =>
    render(
      <form onSubmit={submitted}>
        <ProfileRow />
      </form>,
      document.body,
    ),
  );
  const name = document.querySelector<HTMLInputElement>("[data-testid=profile-name]")!;
  const enter = () => {
    const pressed = new KeyboardEvent("keydown", { key: "Enter", bubbles: true, cancelable: true });
    act(() => void name.dispatchEvent(pressed));
    return pressed.defaultPrevented;
  };
  expect(enter()).toBe(true);
  expect(profiles.value).toEqual([]);
  act(() => {
    name.value = " quad ";
    name.dispatchEvent(new Event("input", { bubbles: true }));
  });
  expect(enter()).toBe(true);
  expect(profiles.value.map((p) => p.name)).toEqual(["quad"]);
  expect(submitted).not.toHaveBeenCalled();
  removeProfile("quad");
});
