// @vitest-environment happy-dom
import { afterEach, expect, it, vi } from "vitest";
import { sayWordsIn, setLanguage } from "../i18n";
import { en } from "../i18n/en";
import type { pagesEn } from "../i18n/pages.en";
import * as api from "../sources/api";
import { suggestedSpec } from "./suggested";

vi.spyOn(api, "defaults").mockResolvedValue({ spec: { name: "of the server", threshold_m: 7 } } as unknown as Awaited<
  ReturnType<typeof api.defaults>
>);
afterEach(() => setLanguage("en"));

it("names a suggested search in the page's language, and takes the rest as the server suggests it", async () => {
  expect(await suggestedSpec()).toEqual({ name: "New search", threshold_m: 7 });
  await setLanguage("de");
  expect(await suggestedSpec()).toEqual({ name: "Neue Suche", threshold_m: 7 });
});

it("leaves the server's name where the words are still on their way", async () => {
  sayWordsIn(en as typeof en & typeof pagesEn);
  expect((await suggestedSpec()).name).toBe("of the server");
});
