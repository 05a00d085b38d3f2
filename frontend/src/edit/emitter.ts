// The emitter that the form edits: the first one of the search. The others are left as they are.
import type { EmitterSpec, MissionSpec } from "../wire";

/** Where it stands in the draft. */
export const EMITTER = "emitters.0";
export const PRIOR = `${EMITTER}.prior`;

export const firstEmitter = ({ emitters }: MissionSpec): EmitterSpec => emitters[0]!;
