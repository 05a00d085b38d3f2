// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { expect, it } from "vitest";
import type { Calibration } from "../sources/libraryApi";
import { ErrorMap } from "./ErrorMap";

it("draws bearings on both sides of the antimeridian beside each other", () => {
  const bearings = [179.999, -179.999, 179.997].map((lon) => ({ place: { lat: 0, lon }, error_deg: 3, outlier: false }));
  act(() => render(<ErrorMap bearings={bearings as unknown as Calibration["bearings"]} />, document.body));
  const across = [...document.querySelectorAll("circle")].map((one) => Number(one.getAttribute("cx")));
  expect(across.map(Math.round)).toEqual([160, 310, 10]);
});
