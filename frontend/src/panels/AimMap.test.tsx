// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Area } from "../wire";
import { AimMap } from "./AimMap";

const AREA: Area = {
  type: "Polygon",
  coordinates: [
    [
      [7.2, 50.6],
      [7.21, 50.6],
      [7.21, 50.61],
      [7.2, 50.6],
    ],
  ],
};
const map = () => document.querySelector<SVGSVGElement>("[data-testid=aim-map]")!;
const onHere = vi.fn();

function show(area: Area | null): void {
  act(() =>
    render(
      <AimMap
        area={area}
        others={[]}
        advised={null}
        way={[]}
        ways={[]}
        here={null}
        bearing={null}
        sigma={12}
        mode="here"
        onHere={onHere}
        onDirection={() => undefined}
      />,
      document.body,
    ),
  );
  map().getScreenCTM = () => new DOMMatrix();
}

beforeEach(() => {
  onHere.mockClear();
  vi.stubGlobal(
    "DOMMatrix",
    class {
      inverse() {
        return this;
      }
    },
  );
  vi.stubGlobal(
    "DOMPoint",
    class {
      constructor(
        readonly x: number,
        readonly y: number,
      ) {}
      matrixTransform() {
        return this;
      }
    },
  );
});
afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
});

it("takes no tap before it shows a search: it would be a place off Africa", () => {
  show(null);
  expect(map().getAttribute("aria-busy")).toBe("true");
  map().dispatchEvent(new MouseEvent("click", { bubbles: true, clientX: 180, clientY: 180 }));
  expect(onHere).not.toHaveBeenCalled();

  show(AREA);
  expect(map().getAttribute("aria-busy")).toBe("false");
  map().dispatchEvent(new MouseEvent("click", { bubbles: true, clientX: 180, clientY: 180 }));
  expect(onHere).toHaveBeenCalledOnce();
  expect(onHere.mock.calls[0]![0].lat).toBeCloseTo(50.605, 3);
});
