import { beforeEach, expect, it, vi } from "vitest";
import * as api from "./api";
import { inTilePlace, overlay } from "./mapsApi";
import { inPlace, places } from "./places";

const turn = () => new Promise((resolve) => setTimeout(resolve));

/** Requests whose answers do not come, or break off after their headers. */
let asked: { path: string; end: (body: string) => void }[] = [];

beforeEach(() => {
  asked = [];
  vi.stubGlobal("fetch", (path: string, { signal }: RequestInit) => {
    let end = (_body: string) => {};
    const body = new ReadableStream<Uint8Array>({
      start(stream) {
        end = (text) => {
          stream.enqueue(new TextEncoder().encode(text));
          stream.close();
        };
        signal?.addEventListener("abort", () => stream.error(signal.reason));
      },
    });
    asked.push({ path, end });
    return Promise.resolve(new Response(body));
  });
});

const paths = () => asked.map(({ path }) => path);

it("a waiting one begins when another has ended, well or not, and never when it is no longer wanted", async () => {
  const inPlace = places(1);
  const begun: string[] = [];
  const ends: Record<string, (ok: boolean) => void> = {};
  const work = (name: string, wanted?: AbortSignal) =>
    inPlace(() => {
      begun.push(name);
      return new Promise<void>((resolve, reject) => {
        ends[name] = (ok) => (ok ? resolve() : reject(new Error(name)));
      });
    }, wanted);
  const leaves = new AbortController();
  const [first, second, third] = [work("first"), work("second", leaves.signal), work("third")];
  leaves.abort(new Error("left"));
  await expect(second).rejects.toThrow("left");
  ends.first!(false);
  await expect(first).rejects.toThrow("first");
  await turn();
  expect(begun).toEqual(["first", "third"]);
  ends.third!(true);
  await third;
  void work("fourth");
  expect(begun).toEqual(["first", "third", "fourth"]);
});

it("what is no longer wanted by the time it is asked for takes no place, be one free or not", async () => {
  const inPlace = places(1);
  const work = vi.fn(() => Promise.resolve());
  const gone = AbortSignal.abort(new Error("gone"));
  await expect(inPlace(work, gone)).rejects.toThrow("gone");
  let end = () => {};
  const first = inPlace(() => new Promise<void>((resolve) => (end = resolve)));
  await expect(inPlace(work, gone)).rejects.toThrow("gone");
  end();
  await first;
  expect(work).not.toHaveBeenCalled();
  await inPlace(work);
  expect(work).toHaveBeenCalledOnce();
});

it("a tile that is let go in the instant in which its place comes free is not loaded, and leaves the place", async () => {
  const ends: (() => void)[] = [];
  const others = [1, 2, 3, 4].map(() => inPlace(() => new Promise<void>((resolve) => ends.push(resolve))));
  const load = vi.fn(() => new Promise<never>(() => undefined));
  const moves = new AbortController();
  const tile = inTilePlace(load, moves.signal).catch(() => "moved on");
  ends[0]!();
  void Promise.resolve().then(() => moves.abort());
  expect(await Promise.race([tile, turn()])).toBe("moved on");
  expect(load).not.toHaveBeenCalled();
  const next = vi.fn(() => Promise.resolve());
  void inPlace(next);
  expect(next).toHaveBeenCalledOnce();
  for (const end of ends) end();
  await Promise.all(others);
});

it("an order leaves at once, however much waits for slow answers", async () => {
  const leaves = new AbortController();
  const others = Array.from({ length: 7 }, (_, i) => api.requestEmpty(`/slow/${i}`, { signal: leaves.signal }).catch(() => "left"));
  await turn();
  expect(asked.length, "answers that have begun keep their connections").toBe(4);
  void api.sendCommand("m", { kind: "hold" });
  void api.orderCraft("c", { kind: "hold" });
  expect(paths().slice(4)).toEqual(["/api/missions/m/commands", "/api/crafts/c/commands"]);
  asked[0]!.end("{}");
  await vi.waitFor(() => expect(paths()).toContain("/api/slow/4"));
  leaves.abort();
  await Promise.all(others);
  expect(paths()).not.toContain("/api/slow/6");
});

it("slow tiles and overlays leave places for what somebody waits for", async () => {
  const overlays = ["a", "b", "c"].map(overlay);
  const moved = new AbortController();
  const load = vi.fn(() => new Promise<never>(() => undefined));
  const tiles = [1, 2, 3].map(() => inTilePlace(load, moved.signal).catch(() => "moved on"));
  void api.health();
  await turn();
  expect(paths()).toEqual(["/api/overlays/a", "/api/overlays/b", "/api/health"]);
  for (const { end } of asked) end("{}");
  await vi.waitFor(() => expect(paths()).toContain("/api/overlays/c"));
  await vi.waitFor(() => expect(load).toHaveBeenCalledTimes(1));
  asked.at(-1)!.end("{}");
  await Promise.all(overlays);
  await vi.waitFor(() => expect(load).toHaveBeenCalledTimes(2));
  moved.abort();
  expect(await Promise.all(tiles)).toEqual(["moved on", "moved on", "moved on"]);
});
