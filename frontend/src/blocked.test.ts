// @vitest-environment happy-dom
// A browser that blocks what pages keep throws as soon as they touch it: the page must work all the same.
import { expect, it, vi } from "vitest";

vi.mock("./map/createMap", () => ({ preparePmtiles: vi.fn() }));

const files = import.meta.glob<string>(["./*/**/*.{ts,tsx}", "!**/*.test.*"], { query: "?raw", import: "default", eager: true });

it("reads what is kept in one place only, which catches", () => {
  const reading = Object.entries(files).filter(([, text]) => /(local|session)Storage\.(get|remove)Item/.test(text));
  expect(reading.map(([path]) => path)).toEqual([]);
});

it("loads, and drafts and forgets, where the browser keeps nothing", async () => {
  for (const name of ["localStorage", "sessionStorage"]) {
    vi.stubGlobal(name, null);
    Object.defineProperty(globalThis, name, {
      configurable: true,
      get: () => {
        throw new DOMException("Access is denied for this document.", "SecurityError");
      },
    });
  }
  const [{ defaultSettings, settings }, { basemap, chooseBasemap }, { overlayIds }, { profiles }, drafts, { forgetSaving }, { queue }] =
    await Promise.all([
      import("./state/settings"),
      import("./map/basemap"),
      import("./map/overlays"),
      import("./edit/profiles"),
      import("./edit/draft"),
      import("./edit/saving"),
      import("./commands/reportBearings"),
    ]);
  expect([settings.value, basemap.value, overlayIds.value, profiles.value]).toEqual([defaultSettings, null, [], []]);
  expect(queue.value).toBeDefined();
  expect(drafts.storedDraft("new")).toBeNull();
  drafts.forget("new");
  forgetSaving("new");
  chooseBasemap("alps");
  chooseBasemap(null);
  expect(basemap.value).toBeNull();
});
