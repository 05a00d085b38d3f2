// @vitest-environment happy-dom
import { render } from "preact";
import { expect, it } from "vitest";
import { MiniMap } from "./MiniMap";

const wrapped = (lon: number) => ((lon + 540) % 360) - 180;

function drawn(west: number) {
  const ring = [
    [0, 0],
    [0.01, 0],
    [0.01, 0.005],
    [0, 0.005],
    [0, 0],
  ];
  const at = ([lon, lat]: number[]) => [wrapped(west + lon!), 50 + lat!];
  const sketch = { outline: [ring.map(at)], places: [at([0.002, 0.001])], found: { a: at([0.008, 0.004]) }, truth: {} };
  const root = document.createElement("div");
  render(<MiniMap sketch={sketch as never} />, root);
  const found = root.querySelector(".mini-found")!;
  return [root.querySelector(".mini-area")!.getAttribute("d"), Number(found.getAttribute("cx")).toFixed(1)];
}

it("draws a mission across the antimeridian as it draws one elsewhere", () => {
  expect(drawn(179.995)).toEqual(drawn(7.2));
});
