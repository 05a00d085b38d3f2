import { expect, it } from "vitest";
import { formatExact } from "./exact";
import { locale } from "./locale";

it("writes as many decimals as there are, four at most, in the page's language", () => {
  expect([868.3, 150, 1.05, 433.123456].map(formatExact)).toEqual(["868.3", "150", "1.05", "433.1235"]);
  locale.value = "de";
  expect(formatExact(868.3)).toBe("868,3");
  locale.value = "en";
});
