import type { Reason } from "../wire";
import type { EmitterState } from "./emitter";

/** Why "localized" is not said: not what a belief said before it contained any of the bearings. */
export function notYet({ belief, bearings }: Pick<EmitterState, "belief" | "bearings">): readonly Reason[] {
  const counted = bearings.filter((b) => !b.excluded).length;
  if (counted > 0 && !belief?.fact.bearings) return [{ code: "bearings_not_in_belief", bearings: counted }];
  return belief && !belief.fact.localized ? belief.fact.not_yet : [];
}
