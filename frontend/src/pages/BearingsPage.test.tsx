// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { cursor, look } from "../state/moment";
import { open } from "../state/open";
import { session } from "../state/session";
import { BearingsPage } from "./BearingsPage";

const part = <T extends HTMLElement = HTMLButtonElement>(name: string) => document.querySelector<T>(`[data-testid="${name}"]`)!;
const field = () => part<HTMLInputElement>("report-direction");
const type = (input: HTMLInputElement, text: string) =>
  act(() => {
    input.value = text;
    input.dispatchEvent(new InputEvent("input", { bubbles: true }));
  });

let fix: PositionCallback;
let fail: PositionErrorCallback;
const clearWatch = vi.fn();
const stand = (lat: number) => act(() => fix({ coords: { latitude: lat, longitude: 7, accuracy: 5 } } as GeolocationPosition));

beforeEach(() => {
  session.value = null;
  vi.stubGlobal("fetch", () => Promise.reject(new TypeError("no link")));
  Object.defineProperty(navigator, "geolocation", {
    configurable: true,
    value: {
      watchPosition: (onFix: PositionCallback, onFail: PositionErrorCallback) => {
        [fix, fail] = [onFix, onFail];
        return 1;
      },
      clearWatch,
    },
  });
  open(new FakeSource());
  act(() => render(<BearingsPage route={{ missionId: "m" }} />, document.body));
});
afterEach(() => {
  act(() => render(null, document.body));
  vi.unstubAllGlobals();
  clearWatch.mockClear();
});

it("leaves a bearing alone that is being typed while the phone tells where it is", () => {
  act(() => part("report-gps").click());
  stand(50);
  type(field(), "2");
  stand(50.1);
  expect(field().value).toBe("2");
  type(field(), `${field().value}7,4`);
  stand(50.2);
  expect(field().value).toBe("27,4");
  act(() => void field().dispatchEvent(new FocusEvent("blur")));
  expect(field().value).toBe("027");
});

it("shows what the buttons beside it make of a bearing whose field was never left", () => {
  type(field(), "270");
  act(() => part<HTMLButtonElement>("report-direction").closest(".report-direction")!.querySelector("button")!.click());
  expect(field().value).toBe("265");
});

it("takes a tap for a direction once the phone tells where it is", () => {
  expect(part("report-mode-here").getAttribute("aria-pressed")).toBe("true");
  act(() => part("report-gps").click());
  expect(part("report-mode-direction").getAttribute("aria-pressed")).toBe("true");
  act(() => fail({ code: 1, PERMISSION_DENIED: 1 } as GeolocationPositionError));
  expect(part("report-mode-here").getAttribute("aria-pressed")).toBe("true");
  expect(clearWatch).toHaveBeenCalled();
});

it("goes on asking a phone that does not know just now where it is", () => {
  act(() => part("report-gps").click());
  stand(50);
  act(() => fail({ code: 2, PERMISSION_DENIED: 1 } as GeolocationPositionError));
  expect(part("report-gps").getAttribute("aria-pressed")).toBe("false");
  expect(document.querySelector("[role=alert]")).not.toBeNull();
  expect(clearWatch).not.toHaveBeenCalled();
  stand(50.1);
  expect(part("report-gps").getAttribute("aria-pressed")).toBe("true");
});

it("shows the present, whatever moment was reviewed before", () => {
  act(() => render(null, document.body));
  look(3);
  act(() => render(<BearingsPage route={{ missionId: "m" }} />, document.body));
  expect(cursor.value).toBeNull();
});

it("leaves a declination alone that is being typed", () => {
  const declination = [...document.querySelectorAll<HTMLInputElement>(".report-who input")].at(-1)!;
  type(declination, "-");
  expect(declination.value).toBe("-");
  type(declination, "-1,");
  act(() => part("report-gps").click());
  stand(50);
  expect(declination.value).toBe("-1,");
});
