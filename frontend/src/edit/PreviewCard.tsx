import { reasonText, t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import { coveredShare, plannedBudget } from "../state/budget";
import { telemetry } from "../state/heard";
import { settings } from "../state/settings";
import { vehicle } from "../state/vehicle";
import { formatPlace } from "../units/coordinates";
import { formatDuration } from "../units/quantities";
import type { MissionSpec } from "../wire";
import { draft } from "./draft";
import { settledDraft } from "./drawing";
import { askPreview, histogram, preview } from "./preview";

function Histogram({ times }: { times: readonly number[] }) {
  const { fromS, toS, counts } = histogram(times, 24);
  const top = Math.max(...counts);
  return (
    <figure class="histogram">
      <svg viewBox="0 0 24 10" preserveAspectRatio="none" role="img" aria-label={t("preview.histogram", { count: times.length })}>
        {counts.map((count, i) => (
          <rect x={i + 0.05} width={0.9} y={10 - (10 * count) / top} height={(10 * count) / top} key={i} />
        ))}
      </svg>
      <figcaption>
        <span>{formatDuration(fromS)}</span>
        <span>{t("preview.histogram", { count: times.length })}</span>
        <span>{formatDuration(toS)}</span>
      </figcaption>
    </figure>
  );
}

/** How many of the simulated searches the charge covers, the way home from the farthest corner and the reserve kept. */
function BatteryCover({ times, worst, spec }: { times: readonly number[]; worst: number | null; spec: MissionSpec }) {
  const at = vehicle.value.at;
  const reported = telemetry.value?.value.battery_percent ?? null;
  if (!at || times.length < 2) return null;
  const budget = plannedBudget(reported ?? 100, at, spec);
  const share = coveredShare(budget, times);
  const key = reported === null ? "preview.batteryFull" : "preview.battery";
  return (
    <p data-testid="preview-battery" data-share={share} class={share < 0.9 || !coveredShare(budget, [worst!]) ? "battery-short" : ""}>
      <strong>{t(key, { charge: Math.round(budget.chargePercent), share: Math.floor(100 * share) })}</strong>{" "}
      <span class="muted">{t("preview.batteryKept", { kept: Math.round(budget.keptPercent) })}</span>
    </p>
  );
}

export function PreviewCard() {
  const state = preview.value;
  const found = state?.found;
  return (
    <section class="panel" aria-label={t("preview.title")} data-testid="preview">
      <h2>
        {t("preview.title")}
        <button
          type="button"
          data-testid="preview-run"
          disabled={state?.running || !draft.value?.hasArea}
          onClick={() => void askPreview(settledDraft())}
        >
          {t(state?.running ? "preview.running" : "preview.run")}
        </button>
      </h2>
      {state?.problem && <ProblemBox problem={state.problem} />}
      {found && (
        <>
          {found.expected_time_s !== null && (
            <p>
              <strong data-testid="preview-time">{t("preview.expected", { time: formatDuration(found.expected_time_s) })}</strong>
              {found.time_90_s !== null && `, ${t("preview.in90", { time: formatDuration(found.time_90_s) })}`}
            </p>
          )}
          {found.times_s.length > 1 && <Histogram times={found.times_s} />}
          <BatteryCover times={found.times_s} worst={found.time_90_s} spec={draft.value!.spec} />
          <p class="muted">
            {t("preview.first", { place: formatPlace(found.first_place, settings.value.coordinates), reason: reasonText(found.reason) })}
          </p>
        </>
      )}
    </section>
  );
}
