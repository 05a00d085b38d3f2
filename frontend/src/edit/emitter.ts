// The emitter that the form edits: the first one of the search. What is known beforehand is known of all alike.
import type { EmitterSpec, MissionSpec } from "../wire";

/** Where it stands in the draft. */
export const EMITTER = "emitters.0";
export const PRIOR = "emitters.all.prior";

export const firstEmitter = ({ emitters }: MissionSpec): EmitterSpec => emitters[0]!;
