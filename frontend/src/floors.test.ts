// Imports point down: a file uses its own floor and the floors below it.
import { expect, it } from "vitest";

const FLOORS = ["wire", "units", "i18n", "sources", "state", "commands", "panels", "edit", "map", "pages", "app"];

const files = import.meta.glob<string>(["./*/**/*.{ts,tsx}", "!**/*.test.*"], {
  query: "?raw",
  import: "default",
  eager: true,
});

const floorOf = (path: string) => FLOORS.indexOf(path.split("/")[1]!);

const importsOf = (path: string, text: string) =>
  [...text.matchAll(/(?:from|import\()\s*"(\.[^"]+)"/g)].map(([, to]) => new URL(to!, `file:///src/${path}`).pathname.replace("/src", "."));

it("every folder has its floor", () => {
  expect(Object.keys(files).filter((path) => floorOf(path) < 0)).toEqual([]);
});

it.each(FLOORS)("%s uses what is below it only", (floor) => {
  const mine = Object.entries(files).filter(([path]) => floorOf(path) === FLOORS.indexOf(floor));
  const upward = mine.flatMap(([path, text]) => importsOf(path, text).map((to) => ({ path, to })));
  expect(upward.filter(({ path, to }) => floorOf(to) > floorOf(path))).toEqual([]);
});
