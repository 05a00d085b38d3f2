// What a claim about an emitter that moves is worth by now: the same formula as planner/movement.py.
import type { EmitterSpec } from "../wire";
import type { EmitterState } from "./emitter";

type Movement = EmitterSpec["movement"];

/** Seconds after which the direction is forgotten; as in backend/search/localization.py. */
const PERSISTENCE_S: Record<Exclude<Movement["kind"], "still">, number> = { animal: 30, walking: 180, drifting: 900 };

/** Root mean square of the way gone in that time: v tau sqrt(2 (t / tau - 1 + exp(-t / tau))), metres. */
export function wayM(movement: Movement, seconds: number): number {
  if (movement.kind === "still") return 0;
  const persistence = PERSISTENCE_S[movement.kind];
  const share = Math.max(0, seconds) / persistence;
  return movement.speed_m_s * persistence * Math.sqrt(2 * Math.max(0, share + Math.expm1(-share)));
}

export interface Claim {
  at: string;
  thenM: number;
  nowM: number;
}

/** Null for one that stands still or was never localized. */
export function claimOf(emitter: EmitterState | undefined, movement: Movement | undefined, nowMs: number): Claim | null {
  const claim = emitter?.claim;
  const thenM = claim?.fact.estimate?.expected_rmse_m;
  if (!claim || thenM === undefined || !movement || movement.kind === "still") return null;
  const way = wayM(movement, (nowMs - Date.parse(claim.at)) / 1000);
  return { at: claim.at, thenM, nowM: Math.hypot(thenM, way) };
}
