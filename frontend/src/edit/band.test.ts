import { expect, it } from "vitest";
import { someSpec } from "../wire/examples";
import { bandMessage } from "./band";
import { set } from "./path";

it.each([
  [120, null],
  [10, null],
  [130, /130/],
  [9, /9/],
])("an altitude of %s m in a band of 10 to 120 m is judged while it is typed", (altitude, words) => {
  const message = bandMessage(set(someSpec(), "flight.altitude_relative_m", altitude));
  if (words === null) expect(message).toBeNull();
  else expect(message).toMatch(words);
});
