// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it } from "vitest";
import { vehicle } from "../state/vehicle";
import type { Preview } from "../wire";
import { someSpec } from "../wire/examples";
import { type Draft, draft } from "./draft";
import { PreviewCard } from "./PreviewCard";
import { preview } from "./preview";

afterEach(() => {
  act(() => render(null, document.body));
  draft.value = preview.value = null;
});

const short = (time_90_s: number): boolean => {
  const spec = someSpec();
  const [lon, lat] = spec.area.coordinates[0]![0] as [number, number];
  vehicle.value = { ...vehicle.value, at: [lon, lat] };
  draft.value = { spec, hasArea: true } as unknown as Draft;
  const found = {
    times_s: [60, 70, 80],
    expected_time_s: 70,
    time_90_s,
    first_place: { lat, lon },
    reason: { code: "planned_meanwhile", expected_time_s: 70, tried: 3 },
  } as unknown as Preview;
  preview.value = { running: false, found, problem: null };
  act(() => render(<PreviewCard />, document.body));
  return document.querySelector("[data-testid=preview-battery]")!.classList.contains("battery-short");
};

it("a battery that does not cover the time in nine of ten is short, whatever the simulated searches took", () => {
  expect(short(100)).toBe(false);
  expect(short(1e5)).toBe(true);
});
