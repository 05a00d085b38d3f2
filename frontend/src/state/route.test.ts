// @vitest-environment happy-dom
import { expect, it } from "vitest";
import { missionAddress, parseRoute } from "./route";

it("addresses lead to their pages, strange ones to the list", () => {
  expect(parseRoute("")).toEqual({ page: "missions" });
  expect(parseRoute("#/new")).toEqual({ page: "new", from: null });
  expect(parseRoute("#/new/abc")).toEqual({ page: "new", from: "abc" });
  expect(parseRoute("#/mission/a-1/edit")).toEqual({ page: "edit", missionId: "a-1" });
  expect(parseRoute("#/nowhere")).toEqual({ page: "missions" });
  expect(parseRoute(missionAddress("x y"))).toEqual({ page: "mission", missionId: "x y" });
  expect(parseRoute("#/join/a%b%")).toEqual({ page: "join", code: "a%b%" });
});
