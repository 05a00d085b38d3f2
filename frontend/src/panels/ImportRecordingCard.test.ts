// @vitest-environment happy-dom
import { expect, it } from "vitest";
import { chosenCard } from "../state/card";
import { mission } from "../state/shown";
import { submit } from "./ImportRecording";

it("stays on the card on which it says what came of a file", async () => {
  expect([chosenCard.value, mission.value.phase]).toEqual(["estimate", "draft"]);
  await submit("m", document.createElement("form"));
  expect(chosenCard.value).toBe("checks");
});
