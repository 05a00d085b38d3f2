import { reasonRemedy, reasonText, t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { formatPlace } from "../units/coordinates";
import { formatDuration, formatLength } from "../units/quantities";
import type { AreaOutlook } from "../wire";
import type { OutlookState } from "./outlook";

function Expected({ found }: { found: AreaOutlook }) {
  const { belief, plan } = found;
  const { units, coordinates } = settings.value;
  const before = mission.value.belief?.fact.estimate?.expected_rmse_m;
  const after = belief.estimate?.expected_rmse_m;
  return (
    <>
      {after === undefined ? (
        <p>{t("area.noEstimate", { count: belief.bearings })}</p>
      ) : (
        <p data-testid="outlook-error">
          {t("area.error", { count: belief.bearings, after: formatLength(after, units) })}
          {before !== undefined && <span class="muted"> {t("area.errorNow", { before: formatLength(before, units) })}</span>}
        </p>
      )}
      {belief.localized && <p>{t("area.localized")}</p>}
      {plan?.expected_time_s != null && (
        <p>
          <strong data-testid="outlook-time">{t("preview.expected", { time: formatDuration(plan.expected_time_s) })}</strong>
          {plan.time_90_s !== null && `, ${t("preview.in90", { time: formatDuration(plan.time_90_s) })}`}
        </p>
      )}
      {plan && <p class="muted">{t("area.next", { place: formatPlace(plan.place, coordinates) })}</p>}
      {found.no_plan && !belief.localized && (
        <p class="refused" role="alert">
          {t("area.noPlan", { reason: reasonText(found.no_plan) })}
        </p>
      )}
    </>
  );
}

/** Said before the slide: may it be searched from here, and what do the bearings so far say there? */
export function OutlookCard({ judged }: { judged: OutlookState }) {
  const { found, problem } = judged;
  return (
    <section aria-label={t("area.outlook")} data-testid="outlook" data-allowed={found?.allowed ?? ""}>
      {problem && <ProblemBox problem={problem} />}
      {found?.reason && !found.allowed && (
        <p class="refused" role="alert" data-testid="outlook-refused">
          {t("area.refused", { reason: reasonText(found.reason) })} {reasonRemedy(found.reason)}
        </p>
      )}
      {found && <Expected found={found} />}
    </section>
  );
}
