// "Localized at 14:02 within 9 m; by now within 60 m": of an emitter that moves.
import { t } from "../i18n";
import { claimOf } from "../state/claim";
import { emittersThen } from "../state/moment";
import { settings } from "../state/settings";
import { mission, shownTimeMs } from "../state/shown";
import { formatClock, formatLength } from "../units/quantities";

export function Claim() {
  const { spec, emitterId } = mission.value;
  const movement = spec?.emitters.find((e) => e.emitter_id === emitterId)?.movement;
  const claim = claimOf(emittersThen.value.get(emitterId ?? ""), movement, shownTimeMs.value);
  if (!claim) return null;
  const units = settings.value.units;
  return (
    <p class="claim" data-testid="claim" data-then={claim.thenM} data-now={claim.nowM}>
      {t("estimate.claim", {
        time: formatClock(claim.at),
        error: formatLength(claim.thenM, units),
        now: formatLength(claim.nowM, units),
      })}
    </p>
  );
}
