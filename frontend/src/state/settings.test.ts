// @vitest-environment happy-dom
import { expect, it } from "vitest";
import { defaultSettings, readSettings } from "./settings";

it("keeps what is known and right, and nothing else", () => {
  const read = readSettings(JSON.stringify({ theme: "indoor", scale: "huge", stranger: 1 }));
  expect(read.theme).toBe("indoor");
  expect(read.scale).toBe(defaultSettings.scale);
  expect(read).not.toHaveProperty("stranger");
});

it("bears what is no settings at all", () => {
  for (const stored of [null, "", "{", "null", "7", "[]"]) expect(readSettings(stored)).toEqual(defaultSettings);
});
