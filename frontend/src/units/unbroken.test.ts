import { expect, it } from "vitest";
import { unbroken } from "./unbroken";

it("keeps numbers and their units together, and nothing else", () => {
  expect(unbroken("Akku 60 %: in 326 m Entfernung, 19 % angesetzt")).toBe("Akku 60\u00a0%: in 326\u00a0m Entfernung, 19\u00a0% angesetzt");
  expect(unbroken("There are 62,700 m² to fly in; 0.2 s old, 1.2 km.")).toBe(
    "There are 62,700\u00a0m² to fly in; 0.2\u00a0s old, 1.2\u00a0km.",
  );
  expect(unbroken("14 satellites, 3 more, NAV_DLL_ACT = 2.")).toBe("14 satellites, 3 more, NAV_DLL_ACT = 2.");
});
