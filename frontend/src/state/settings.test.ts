// @vitest-environment happy-dom
import { expect, it, vi } from "vitest";
import { setLanguage } from "../i18n";
import { applySettings, change, defaultSettings, readSettings, settings } from "./settings";

vi.mock("../i18n", async (original) => ({ ...(await original<typeof import("../i18n")>()), setLanguage: vi.fn() }));

const settled = () => new Promise((resolve) => setTimeout(resolve));

it("keeps what is known and right, and nothing else", () => {
  const read = readSettings(JSON.stringify({ theme: "indoor", scale: "huge", speech: true, stranger: 1 }));
  expect(read).toEqual({ ...defaultSettings, theme: "indoor", speech: true });
});

it("knows a theme that there is: in another the page shows nothing", () => {
  expect(readSettings(JSON.stringify({ theme: "dark" }))).toEqual(defaultSettings);
});

it("bears what is no settings at all", () => {
  for (const stored of [null, "", "{", "null", "7", "[]"]) expect(readSettings(stored)).toEqual(defaultSettings);
});

it("stays in its language when the words of another cannot be loaded, and says so", async () => {
  vi.mocked(setLanguage).mockImplementation((language) => (language === "de" ? Promise.reject(new Error("gone")) : Promise.resolve()));
  const lost = vi.fn();
  change("language", "en");
  applySettings(lost);
  await settled();
  change("language", "de");
  await settled();
  expect(lost).toHaveBeenCalledExactlyOnceWith("de");
  expect(settings.value.language).toBe("en");
});

it("keeps what another tab chose meanwhile, and shows it", () => {
  const theirs = JSON.stringify({ ...settings.value, theme: "indoor" });
  localStorage.setItem("crossfix.settings", theirs);
  dispatchEvent(new StorageEvent("storage", { key: "crossfix.settings", newValue: theirs }));
  expect(settings.value.theme).toBe("indoor");
  change("units", "imperial");
  expect(readSettings(localStorage.getItem("crossfix.settings"))).toMatchObject({ theme: "indoor", units: "imperial" });
});

it("keeps what could not be stored here when another tab chooses something else", () => {
  const key = "crossfix.settings";
  const oldValue = JSON.stringify({ ...settings.value, theme: "outdoor", tones: true });
  localStorage.setItem(key, oldValue);
  vi.stubGlobal("localStorage", {
    setItem: () => {
      throw new DOMException("full");
    },
  });
  change("tones", false);
  vi.unstubAllGlobals();
  const newValue = JSON.stringify({ ...JSON.parse(oldValue), theme: "indoor" });
  dispatchEvent(new StorageEvent("storage", { key, oldValue, newValue }));
  expect(settings.value).toMatchObject({ theme: "indoor", tones: false });
  const back = JSON.stringify({ ...JSON.parse(newValue), theme: "outdoor" });
  dispatchEvent(new StorageEvent("storage", { key, oldValue: newValue, newValue: back }));
  expect(settings.value.theme).toBe("outdoor");
});
