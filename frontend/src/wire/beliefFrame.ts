// One belief as it travels: 4-byte little-endian header length, JSON header, body (see backend/wire/belief_frame.py).
// Read in one go: a stream's turns through a busy event loop take longer than the inflating itself.
import { unzlibSync } from "fflate";

export type LonLat = [number, number];

export interface BeliefFrame {
  missionId: string;
  emitterId: string;
  /** Of the event that told of it; 0: a prior, or a belief that is only supposed. */
  seq: number;
  bearings: number;
  nx: number;
  ny: number;
  /** SW, SE, NE, NW of the grid's outer edge. */
  bounds: [LonLat, LonLat, LonLat, LonLat];
  /** Largest probability of a cell. */
  peak: number;
  /** ny rows of nx cells, south to north, west to east; probability divided by `peak`. */
  cells: Float32Array;
}

interface Header {
  type: string;
  mission_id: string;
  emitter_id: string;
  seq: number;
  bearings: number;
  nx: number;
  ny: number;
  bounds: [LonLat, LonLat, LonLat, LonLat];
  encoding: "f32-shuffle-zlib" | "u8-log-zlib";
  peak: number;
}

export class BrokenFrame extends Error {}

function inflate(body: Uint8Array): Uint8Array {
  try {
    return unzlibSync(body);
  } catch (error) {
    throw new BrokenFrame(`The belief frame cannot be inflated: ${error instanceof Error ? error.message : String(error)}.`);
  }
}

function unshuffle(bytes: Uint8Array, count: number): Float32Array {
  const plain = new Uint8Array(count * 4);
  for (let i = 0; i < count; i++) {
    for (let byte = 0; byte < 4; byte++) plain[4 * i + byte] = bytes[byte * count + i]!;
  }
  return new Float32Array(plain.buffer);
}

/** p = 10^(6 (u/255 - 1)), 0 stays 0: the inverse of u = round(255 (1 + log10(p) / 6)). */
const LOG_LEVELS = Float32Array.from({ length: 256 }, (_, u) => (u === 0 ? 0 : 10 ** (6 * (u / 255 - 1))));

/** Of a frame that travels inside JSON. */
export const bytesOf = (base64: string): ArrayBuffer => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)).buffer;

export function decodeBeliefFrame(buffer: ArrayBuffer): BeliefFrame {
  if (buffer.byteLength < 4) throw new BrokenFrame("The belief frame is shorter than its own header length.");
  const headerLength = new DataView(buffer).getUint32(0, true);
  if (4 + headerLength > buffer.byteLength) throw new BrokenFrame("The belief frame ends inside its header.");
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, headerLength))) as Header;
  if (header.type !== "belief") throw new BrokenFrame(`A frame of type ${header.type} is not a belief.`);
  const body = inflate(new Uint8Array(buffer, 4 + headerLength));
  const count = header.nx * header.ny;
  const expected = header.encoding === "f32-shuffle-zlib" ? 4 * count : count;
  if (body.length !== expected) {
    throw new BrokenFrame(`The belief frame holds ${body.length} bytes, ${header.nx} x ${header.ny} cells need ${expected}.`);
  }
  const cells = header.encoding === "f32-shuffle-zlib" ? unshuffle(body, count) : Float32Array.from(body, (u) => LOG_LEVELS[u]!);
  return {
    missionId: header.mission_id,
    emitterId: header.emitter_id,
    seq: header.seq,
    bearings: header.bearings,
    nx: header.nx,
    ny: header.ny,
    bounds: header.bounds,
    peak: header.peak,
    cells,
  };
}
