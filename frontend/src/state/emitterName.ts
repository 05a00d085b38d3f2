// What an emitter is called among those of its mission.
import type { EmitterSpec, Reason } from "../wire";

/** Its label; with its number in the specification when another one has the same. */
export function emitterName(emitters: readonly EmitterSpec[], id: string): string {
  const index = emitters.findIndex((emitter) => emitter.emitter_id === id);
  const label = emitters[index]?.label;
  if (!label) return id;
  return emitters.some((other, i) => i !== index && other.label === label) ? `${label} ${index + 1}` : label;
}

/** The same reason, in which an emitter has its name in the place of its id. */
export function namingEmitter(emitters: readonly EmitterSpec[], reason: Reason): Reason {
  return "emitter_id" in reason ? { ...reason, emitter_id: emitterName(emitters, reason.emitter_id) } : reason;
}
