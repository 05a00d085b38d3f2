import { describe, expect, it } from "vitest";
import { BrokenFrame, decodeBeliefFrame } from "./beliefFrame";

async function deflate(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new CompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function shuffle(values: Float32Array): Uint8Array {
  const bytes = new Uint8Array(values.buffer);
  const out = new Uint8Array(bytes.length);
  for (let i = 0; i < values.length; i++) for (let b = 0; b < 4; b++) out[b * values.length + i] = bytes[4 * i + b]!;
  return out;
}

async function frame(encoding: string, nx: number, ny: number, body: Uint8Array): Promise<ArrayBuffer> {
  const bounds = [
    [7, 50],
    [7.1, 50],
    [7.1, 50.1],
    [7, 50.1],
  ];
  const header = new TextEncoder().encode(
    JSON.stringify({ type: "belief", mission_id: "m", emitter_id: "e", seq: 9, bearings: 2, nx, ny, bounds, encoding, peak: 0.25 }),
  );
  const packed = await deflate(body);
  const out = new Uint8Array(4 + header.length + packed.length);
  new DataView(out.buffer).setUint32(0, header.length, true);
  out.set(header, 4);
  out.set(packed, 4 + header.length);
  return out.buffer;
}

describe("decodeBeliefFrame", () => {
  it("gives back the float32 cells it was made of", async () => {
    const cells = Float32Array.from({ length: 6 }, (_, i) => i / 5);
    const decoded = decodeBeliefFrame(await frame("f32-shuffle-zlib", 3, 2, shuffle(cells)));
    expect([...decoded.cells]).toEqual([...cells]);
    expect(decoded).toMatchObject({ missionId: "m", emitterId: "e", seq: 9, bearings: 2, nx: 3, ny: 2, peak: 0.25 });
    expect(decoded.bounds[2]).toEqual([7.1, 50.1]);
  });

  it("reads the thin encoding to within half a step of its logarithm", async () => {
    const wanted = [1, 0.5, 0.01, 1e-5];
    const bytes = Uint8Array.from([...wanted.map((p) => Math.round(255 * (1 + Math.log10(p) / 6))), 0, 0]);
    const decoded = decodeBeliefFrame(await frame("u8-log-zlib", 3, 2, bytes));
    for (const [i, p] of wanted.entries()) expect(Math.abs(Math.log10(decoded.cells[i]! / p))).toBeLessThan(6 / 255 / 2 + 1e-6);
    expect([...decoded.cells.slice(4)]).toEqual([0, 0]);
  });

  it("refuses a body that does not fill the grid", async () => {
    const short = await frame("f32-shuffle-zlib", 3, 2, shuffle(new Float32Array(5)));
    expect(() => decodeBeliefFrame(short)).toThrow(BrokenFrame);
  });

  it("refuses a frame that ends inside its header", async () => {
    const whole = await frame("u8-log-zlib", 1, 1, Uint8Array.of(9));
    expect(() => decodeBeliefFrame(whole.slice(0, 20))).toThrow(BrokenFrame);
    expect(() => decodeBeliefFrame(whole.slice(0, -6))).toThrow(BrokenFrame);
    expect(() => decodeBeliefFrame(new ArrayBuffer(2))).toThrow(BrokenFrame);
  });
});
