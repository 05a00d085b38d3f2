// @vitest-environment happy-dom
import { afterEach, expect, it, vi } from "vitest";
import { setLanguage } from "../i18n";
import * as api from "../sources/api";
import { suggestedSpec } from "./suggested";

const spec = { name: "of the server", threshold_m: 7 };
vi.spyOn(api, "defaults").mockResolvedValue({ spec } as unknown as Awaited<ReturnType<typeof api.defaults>>);
afterEach(() => setLanguage("en"));

it("names a suggested search in the page's language, and takes the rest as the server suggests it", async () => {
  expect(await suggestedSpec()).toEqual({ name: "New mission", threshold_m: 7 });
  await setLanguage("de");
  expect(await suggestedSpec()).toEqual({ name: "Neue Mission", threshold_m: 7 });
});
