// The belief shown: the frame of the emitter shown, of the event that told of it.
import { computed, effect, signal } from "@preact/signals";
import type { Source } from "../sources/source";
import type { BeliefFrame } from "../wire/beliefFrame";
import { live, source } from "./connection";
import { cursor, happened, liveMission } from "./moment";
import { supposedHere } from "./supposed";

/** Frames by emitter and the event they belong to, the prior by the event since which it is the specification's. */
const frames = new Map<string, BeliefFrame>();
const keyOf = (emitterId: string, seq: number) => `${emitterId} ${seq}`;
const belief = signal<BeliefFrame | null>(null);

/** The picture to draw: what is supposed, else what happened. */
export const shownBelief = computed(() => supposedHere.value?.frame ?? belief.value);

const pushed = computed(() => live.value.beliefs);
const hello = computed(() => live.value.hello);
const missionId = computed(() => happened.value.missionId);
const emitterId = computed(() => happened.value.emitterId);
const shownSeq = computed(() => (happened.value.spec ? (happened.value.belief?.seq ?? happened.value.specSeq) : null));

/** While a mission is read from its beginning, its old beliefs pass by unasked. */
const hasCaughtUp = computed(() => cursor.value !== null || liveMission.value.lastSeq >= (hello.value?.last_seq ?? Infinity));

effect(() => {
  source.value;
  frames.clear();
});

/** The server sends a frame before its event: one that is not there by then has to be asked for, again after a new greeting. */
effect(() => {
  const [from, id, emitter, seq] = [source.value, missionId.value, emitterId.value, shownSeq.value];
  hello.value;
  for (const frame of pushed.value.values()) if (frame.seq > 0) frames.set(keyOf(frame.emitterId, frame.seq), frame);
  if (seq === null || emitter === null || !from || !id) belief.value = null;
  else if (frames.has(keyOf(emitter, seq))) belief.value = frames.get(keyOf(emitter, seq))!;
  else {
    if (belief.peek()?.emitterId !== emitter) belief.value = null;
    if (hasCaughtUp.value) void ask(from, id, emitter, seq);
  }
});

async function ask(from: Source, id: string, emitter: string, seq: number): Promise<void> {
  const frame = await from.belief(id, emitter, seq).catch(() => null);
  if (source.peek() !== from || emitterId.peek() !== emitter || shownSeq.peek() !== seq) return;
  if (frame) frames.set(keyOf(emitter, seq), frame);
  belief.value = frame;
}
