import { expect, it } from "vitest";
import type { MessageKey } from ".";
import { de } from "./de";
import { en as bar } from "./en";
import { pagesEn } from "./pages.en";

const en: Record<MessageKey, string> = { ...bar, ...pagesEn };
const places = (text: string) => [...text.matchAll(/\{(\w+)\}/g)].map((m) => m[1]).toSorted();

it("every translation has the same places to fill in", () => {
  for (const key of Object.keys(en) as MessageKey[]) expect(places(de[key]), key).toEqual(places(en[key]));
});

it("nothing was left untranslated but what is the same in both", () => {
  const same = (Object.keys(en) as MessageKey[]).filter((key) => en[key] === de[key] && /[a-z]{5}/.test(en[key].replace(/\{\w+\}/g, "")));
  expect(same.toSorted()).toEqual([
    "bar.link",
    "check.position",
    "check.remote_id",
    "edit.kind",
    "health.server",
    "instruments.autopilot",
    "instruments.database",
    "map.layer.relief",
    "role.operator",
    "settings.language.de",
    "settings.language.en",
    "settings.units.imperial",
  ]);
});
