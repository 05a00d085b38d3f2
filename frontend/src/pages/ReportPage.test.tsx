// @vitest-environment happy-dom
import { type JSX, render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";
import * as api from "../sources/api";
import * as coursesApi from "../sources/coursesApi";
import { flown, record, someBearing, someSpec } from "../wire/examples";
import { ComparePage } from "./ComparePage";
import { ReportPage } from "./ReportPage";

const open = async (page: JSX.Element) => {
  act(() => render(page, document.body));
  await act(() => new Promise((resolve) => setTimeout(resolve)));
};
const problems = () => document.querySelectorAll(".problem").length;

afterEach(() => act(() => render(null, document.body)));

it("reports a mission without the failure of another, and a failure without another mission", async () => {
  vi.spyOn(api, "events")
    .mockRejectedValueOnce(new Error("no server"))
    .mockResolvedValueOnce([...flown])
    .mockRejectedValueOnce(new Error("no server"));
  await open(<ReportPage route={{ page: "report", missionIds: ["nope"] }} />);
  expect(problems()).toBe(1);
  await open(<ReportPage route={{ page: "report", missionIds: ["m"] }} />);
  expect(problems()).toBe(0);
  expect(document.querySelector("[data-testid=report-mission]")).not.toBeNull();
  await open(<ReportPage route={{ page: "report", missionIds: ["nope"] }} />);
  expect(problems()).toBe(1);
  expect(document.querySelector("[data-testid=report-mission]")).toBeNull();
});

it("reports no quality of a bearing that a person entered", async () => {
  const told = someBearing({ source: { kind: "person", name: "Ada" }, sweep_id: null, quality: 1 });
  vi.spyOn(api, "events").mockResolvedValueOnce(record({ kind: "mission_drafted", spec: someSpec() }, told));
  await open(<ReportPage route={{ page: "report", missionIds: ["m"] }} />);
  const cells = document.querySelectorAll("[data-testid=report-bearings] tbody td");
  expect([...cells].at(-1)!.textContent).toBe("–");
});

it("compares missions without a failure that is over", async () => {
  vi.spyOn(api, "missions").mockReturnValue(new Promise(() => undefined));
  vi.spyOn(coursesApi, "courses")
    .mockRejectedValueOnce(new Error("no server"))
    .mockResolvedValueOnce({ mission_id: "m", name: "hare", ended_s: 1, emitters: [], bearings_s: [], courses: [] } as never);
  await open(<ComparePage route={{ page: "compare", missionIds: ["nope"] }} />);
  expect(problems()).toBe(1);
  await open(<ComparePage route={{ page: "compare", missionIds: ["m"] }} />);
  expect(problems()).toBe(0);
});
