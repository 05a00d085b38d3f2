// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import * as access from "../sources/accessApi";
import { Invitations } from "./Invitations";

vi.mock("../sources/accessApi");

afterEach(() => render(null, document.body));

const one = (id: string): access.Invitation => ({
  invitation_id: id,
  role: "operator",
  admin: false,
  made_by: "Ada",
  expires_utc: "2026-11-24T00:00:00Z",
});

const links = () => [...document.querySelectorAll<HTMLInputElement>("[data-testid=invitation-link]")].map((input) => input.value);

it("shows the other links on when one invitation is taken back: no link is shown twice", async () => {
  const ids = ["a", "b"];
  for (const id of ids) vi.mocked(access.invite).mockResolvedValueOnce({ invitation: one(id), link: `https://x/#/join/${id}`, qr: "" });
  vi.mocked(access.takeBackInvitation).mockResolvedValue(undefined);
  const attempt = (doing: Promise<unknown>) => void doing;
  act(() => render(<Invitations list={ids.map(one)} sending={false} attempt={attempt} />, document.body));
  const count = document.querySelectorAll("select")[1]!;
  act(() => {
    count.value = "2";
    count.dispatchEvent(new Event("change", { bubbles: true }));
  });
  act(() => document.querySelector<HTMLElement>("[data-testid=invite]")!.click());
  await vi.waitFor(() => expect(links()).toEqual(["https://x/#/join/a", "https://x/#/join/b"]));
  act(() => document.querySelector<HTMLElement>("[data-testid=invitation] button")!.click());
  await vi.waitFor(() => expect(links()).toEqual(["https://x/#/join/b"]));
});
