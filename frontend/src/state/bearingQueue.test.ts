import { describe, expect, it } from "vitest";
import { add, answered, KEPT, lastOf, nextOf, pending, type Queue, read, restore, takeBackLast, withdrawn } from "./bearingQueue";

const report = (bearing_id: string) => ({
  bearing_id,
  by: "Ada",
  emitter_id: null,
  place: { lat: 50.6, lon: 7.2 },
  bearing_deg: 12,
  sigma_deg: 12,
  snr_db: null,
  taken_at_utc: null,
});
const filled = (...ids: string[]): Queue => ids.reduce<Queue>((queue, id) => add(queue, "m", report(id)), []);
const stages = (queue: Queue) => queue.map((one) => one.stage);

describe("bearings on their way", () => {
  it("wait in their order until the server has them", () => {
    let queue = filled("a", "b");
    expect(nextOf(queue)!.report.bearing_id).toBe("a");
    queue = answered(queue, "a", null);
    expect(nextOf(queue)!.report.bearing_id).toBe("b");
    expect(pending(queue)).toBe(1);
    queue = answered(queue, "b", "The search is over.");
    expect(stages(queue)).toEqual(["sent", "refused"]);
    expect(nextOf(queue)).toBeUndefined();
  });
  it("are taken back from the last on, sent or not", () => {
    let queue = takeBackLast(answered(filled("a", "b"), "a", null), "m");
    expect(stages(queue)).toEqual(["sent", "withdrawing"]);
    queue = takeBackLast(withdrawn(queue, "b"), "m");
    expect(stages(queue)).toEqual(["withdrawing", "back"]);
    queue = takeBackLast(withdrawn(queue, "a"), "m");
    expect(lastOf(queue, "m")).toBeUndefined();
    expect(pending(queue)).toBe(0);
  });
  it("count again when they were taken back by mistake, and say so when the server refuses that", () => {
    const back = withdrawn(takeBackLast(answered(filled("a"), "a", null), "m"), "a");
    const again = restore(back, "a");
    expect(nextOf(again)!.stage).toBe("restoring");
    expect(stages(answered(again, "a", null))).toEqual(["sent"]);
    expect(answered(again, "a", "Ben left it out.")[0]).toMatchObject({ stage: "back", problem: "Ben left it out." });
    expect(restore(filled("a"), "a")).toEqual(filled("a"));
  });
  it("answered after they were taken back are withdrawn all the same", () => {
    const queue = answered(takeBackLast(filled("a"), "m"), "a", null);
    expect(nextOf(queue)!.stage).toBe("withdrawing");
  });
  it("of another mission are left alone", () => {
    expect(takeBackLast(filled("a"), "other")).toEqual(filled("a"));
  });
  it("survive the browser's storage, and nonsense in it does not", () => {
    const queue = filled("a", "b");
    expect(read(JSON.stringify(queue))).toEqual(queue);
    for (const nonsense of [null, "", "{", "7", "[1, null, {}]"]) expect(read(nonsense)).toEqual([]);
  });
  it("are not kept without end once the server has them", () => {
    const ids = Array.from({ length: KEPT + 5 }, (_, i) => `b${i}`);
    const sent = ids.reduce<Queue>((queue, id) => answered(add(queue, "m", report(id)), id, null), []);
    expect(sent.map((one) => one.report.bearing_id)).toEqual(ids.slice(5));
  });
  it("are all kept while the server has not heard of them", () => {
    const ids = Array.from({ length: 3 * KEPT }, (_, i) => `b${i}`);
    const queue = add(answered(takeBackLast(filled(...ids), "m"), "b0", null), "m", report("last"));
    expect(pending(queue)).toBe(3 * KEPT);
    expect(nextOf(queue)!.report.bearing_id).toBe("b1");
  });
});
