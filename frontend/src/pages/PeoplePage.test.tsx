// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import * as access from "../sources/accessApi";
import { PeoplePage } from "./PeoplePage";

vi.mock("../sources/accessApi");
vi.mock("../state/session", async () => {
  const { signal } = await import("@preact/signals");
  const signedIn = signal({ person_id: "ada", name: "Ada", role: "pilot", admin: true });
  return { me: signedIn, session: signedIn, refreshSession: vi.fn() };
});

afterEach(() => render(null, document.body));

const bob: access.Person = { person_id: "bob", name: "Bob", role: "operator", admin: false, active: true, sessions: 1 };

it("takes no further change until the one under way is shown", async () => {
  let answer: () => void = () => {};
  vi.mocked(access.ownSessions).mockResolvedValue({ sessions: [] });
  vi.mocked(access.people).mockResolvedValue({ people: [bob] });
  vi.mocked(access.invitations).mockResolvedValue({ invitations: [] });
  vi.mocked(access.tokens).mockResolvedValue({ tokens: [] });
  vi.mocked(access.changePerson).mockReturnValue(new Promise((resolve) => (answer = () => resolve(undefined as never))));
  const part = (name: string) => document.querySelector<HTMLElement>(`[data-testid=${name}]`)!;
  act(() => render(<PeoplePage />, document.body));
  await vi.waitFor(() => expect(part("person")).not.toBeNull());
  act(() => part("shut-out").click());
  expect(part("people").inert).toBe(true);
  vi.mocked(access.people).mockResolvedValue({ people: [{ ...bob, active: false }] });
  await act(async () => answer());
  await vi.waitFor(() => expect(part("people").inert).toBe(false));
  act(() => part("person").querySelector<HTMLInputElement>("input")!.click());
  expect(vi.mocked(access.changePerson).mock.lastCall).toEqual(["bob", { role: "operator", admin: true, active: false }]);
});

it("makes one invitation, however often it is pressed", async () => {
  vi.mocked(access.invite).mockReturnValue(new Promise(() => {}));
  const invite = () => document.querySelector<HTMLButtonElement>("[data-testid=invite]")!;
  act(() => render(<PeoplePage />, document.body));
  await vi.waitFor(() => expect(invite()).not.toBeNull());
  for (let presses = 0; presses < 2; presses++) act(() => invite().click());
  expect(access.invite).toHaveBeenCalledOnce();
});
