// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import * as api from "../sources/api";
import type { CompassKnown, Health } from "../wire";
import { CompassCard } from "./CompassCard";

vi.mock("../sources/api");

const learned: CompassKnown = {
  craft_id: "craft-1",
  antenna: "yagi",
  flights: 7,
  bearings: 25,
  places_known: 2,
  bias_deg: 6.2,
  bias_spread_deg: 1.8,
  expected_bias_deg: 5,
  sigma_scale: 0.7,
  outlier_rate: 0.031,
};
const unknown: CompassKnown = { ...learned, flights: 0, bearings: 0, places_known: 0, bias_deg: null, bias_spread_deg: null };

const part = (testId: string) => document.querySelector<HTMLElement>(`[data-testid=${testId}]`);
const click = (testId: string) => act(() => part(testId)!.click());

beforeEach(() => {
  const vehicles = [{ craft_id: "craft-1", connected: true, autopilot: "px4", reason: null }];
  vi.mocked(api.health).mockResolvedValue({ vehicles } as unknown as Health);
  vi.mocked(api.compass).mockResolvedValue(learned);
  vi.mocked(api.forgetCompass).mockResolvedValue(unknown);
});

afterEach(() => {
  render(null, document.body);
  vi.clearAllMocks();
});

const shown = async () => {
  act(() => render(<CompassCard offsetDeg={1.5} />, document.body));
  await vi.waitFor(() => expect(part("compass-bias")).not.toBeNull());
};

it("says what was learned, from how many flights, and what the next search expects", async () => {
  await shown();
  expect(api.compass).toHaveBeenCalledWith("craft-1", 1.5);
  expect(part("compass-bias")!.textContent).toMatch(/\+6° ± 2° with “yagi”; flights learned from: 7 \(bearings: 25\)/);
  expect(part("compass-places")!.textContent).toContain("found: 2");
  expect(part("compass")!.textContent).toContain(
    "for all its emitters, a turn of up to 10°, errors 0.7 × as stated and 3 % wrong bearings",
  );
});

it("forgets only after a second tap", async () => {
  await shown();
  click("compass-forget");
  expect(api.forgetCompass).not.toHaveBeenCalled();
  click("compass-forget-yes");
  expect(api.forgetCompass).toHaveBeenCalledWith("craft-1", 1.5);
  await vi.waitFor(() => expect(part("compass-bias")).toBeNull());
  expect(part("compass")!.textContent).toContain("Nothing learned yet");
});

it("says what went wrong, and that nothing is known without a flight", async () => {
  vi.mocked(api.forgetCompass).mockRejectedValue(new Error("away"));
  await shown();
  click("compass-forget");
  click("compass-forget-yes");
  await vi.waitFor(() => expect(part("compass-problem")).not.toBeNull());
  expect(part("compass-bias")).not.toBeNull();
});
