// Where the emitter probably is, how wrong that may be, and how long until it may be said.
import { computed } from "@preact/signals";
import { useState } from "preact/hooks";
import { type MessageKey, reasonText, t } from "../i18n";
import { polygonsOf } from "../state/areas";
import { shownBelief } from "../state/belief";
import { chargeAfter, flightBudget, lasts } from "../state/budget";
import { source } from "../state/connection";
import { distanceM, extent, lonLat } from "../state/geometry";
import { craftStatus, telemetry } from "../state/heard";
import { reviewTimeMs } from "../state/moment";
import { shareWithin } from "../state/nearness";
import { notYet } from "../state/notYet";
import { change, settings } from "../state/settings";
import { mission, shownTimeMs } from "../state/shown";
import { supposedHere } from "../state/supposed";
import { remainingTime } from "../state/timeLeft";
import { vehicle } from "../state/vehicle";
import { type CoordinateFormat, formatPlace } from "../units/coordinates";
import { formatArea, formatBearing, formatDuration, formatLength, formatNumber, signedDegrees } from "../units/quantities";
import type { Area, MissionEnded, SourceErrors } from "../wire";
import { AntennaDoubt } from "./AntennaDoubt";
import { Claim } from "./Claim";
import { copyText } from "./clipboard";
import { Icon } from "./Icon";
import { WhichShown } from "./WhichShown";

const FORMATS: readonly CoordinateFormat[] = ["dd", "dms", "utm", "mgrs"];

/** How far the region reaches and which way, as the report says it. */
function reachWords(region: Area): string {
  const { metres, bearing } = extent(polygonsOf(region).flatMap(([outline]) => outline ?? []));
  return t("estimate.reach", { length: formatLength(metres, settings.value.units), bearing: formatBearing(bearing) });
}

function Coordinates({ lat, lon }: { lat: number; lon: number }) {
  const [copied, setCopied] = useState(false);
  const format = settings.value.coordinates;
  const text = formatPlace({ lat, lon }, format);
  return (
    <div class="coordinates">
      <output data-testid="estimate-coordinates" data-lat={lat} data-lon={lon}>
        {text}
      </output>
      <select
        aria-label={t("estimate.format")}
        value={format}
        onChange={(e) => change("coordinates", e.currentTarget.value as CoordinateFormat)}
      >
        {FORMATS.map((f) => (
          <option value={f} key={f}>
            {f.toUpperCase()}
          </option>
        ))}
      </select>
      <button
        type="button"
        class="icon"
        data-testid="copy"
        aria-label={t(copied ? "estimate.copied" : "estimate.copy")}
        title={t("estimate.copy")}
        onClick={() => {
          void copyText(text).then((done) => {
            setCopied(done);
            setTimeout(() => setCopied(false), 1500);
          });
        }}
      >
        <Icon name={copied ? "check" : "copy"} />
      </button>
    </div>
  );
}

function TimeLeft() {
  const left = remainingTime(mission.value, shownTimeMs.value);
  if (!left) return null;
  return (
    <div data-testid="time-left" data-seconds={left.meanS}>
      <dt>{t("estimate.localizedIn")}</dt>
      <dd>
        {left.meanS > 0 ? t("estimate.about", { time: formatDuration(left.meanS) }) : t("estimate.overdue")}
        {left.worstS !== null && left.worstS > 0 && <small>{t("estimate.in90", { time: formatDuration(left.worstS) })}</small>}
      </dd>
    </div>
  );
}

/** The charge when it will be localized, against the way home and the reserve. Only of now: a review has no battery. */
function BatteryThen() {
  const { spec, home } = mission.value;
  const battery = telemetry.value?.value.battery_percent ?? null;
  const toReturn = craftStatus.value?.value.battery_to_return_percent ?? null;
  const at = vehicle.value.at;
  const left = remainingTime(mission.value, shownTimeMs.value);
  if (battery === null || toReturn === null || !spec || !home || !at || !left || reviewTimeMs.value !== null) return null;
  const budget = flightBudget(battery, toReturn, distanceM(at, lonLat(home)), spec);
  const worstS = left.worstS ?? left.meanS;
  const verdict = lasts(budget, worstS) ? "enough" : lasts(budget, left.meanS) ? "tight" : "short";
  const percent = (seconds: number) => Math.max(0, Math.round(chargeAfter(budget, seconds)));
  return (
    <div class="battery-then" data-testid="battery-then" data-verdict={verdict}>
      <dt>{t("estimate.batteryThen")}</dt>
      <dd class={`battery-${verdict}`}>
        {t("estimate.batteryMean", { percent: percent(left.meanS) })}{" "}
        <small>
          {left.worstS !== null && t("estimate.battery90", { percent: percent(left.worstS) })}{" "}
          {t(`estimate.battery.${verdict}` satisfies MessageKey, { kept: Math.round(budget.keptPercent) })}
        </small>
      </dd>
    </div>
  );
}

/** What the expected error must fall below: of an emitter that moves more than the mission asks for. */
const goalM = computed<number | null>(() => {
  const { belief, spec } = mission.value;
  return belief?.fact.goal_m ?? spec?.localization.expected_rmse_m ?? null;
});

/** How likely the emitter is as near to the estimate as it has to be known; null until the belief is there. */
const insideGoal = computed<number | null>(() => {
  const { belief } = mission.value;
  const frame = shownBelief.value;
  const estimate = belief?.fact.estimate;
  if (!estimate || goalM.value === null || frame?.bearings !== belief.fact.bearings) return null;
  return shareWithin(frame, lonLat(estimate), goalM.value);
});

function Goal({ asked }: { asked: number }) {
  const share = insideGoal.value;
  const goal = goalM.value ?? asked;
  const units = settings.value.units;
  const length = formatLength(goal, units);
  return (
    <>
      <small data-testid="inside-goal" data-share={share}>
        {share === null ? t("estimate.threshold", { length }) : t("estimate.within", { length, percent: Math.round(100 * share) })}
      </small>
      {goal > asked && <small data-testid="moving-goal">{t("estimate.movingGoal", { asked: formatLength(asked, units) })}</small>}
    </>
  );
}

const sourceName = (source: SourceErrors["source"]): string => {
  switch (source.kind) {
    case "craft":
      return t("estimate.source.craft");
    case "import":
      return t("estimate.source.import");
    case "person":
      return t("estimate.source.named", { name: source.name });
  }
};

/** What all bearings of a source are turned by, as far as they tell; the estimate has taken it off. */
function Compass({ errors }: { errors: SourceErrors }) {
  return (
    <div data-testid="compass-bias" data-bias={errors.bias_deg}>
      <dt>{sourceName(errors.source)}</dt>
      <dd>
        {t("estimate.bias", { bias: signedDegrees(errors.bias_deg), error: Math.max(1, Math.round(errors.bias_std_error_deg)) })}
        <small> {t("estimate.biasUsed", { scale: formatNumber(errors.sigma_scale, 1) })}</small>
      </dd>
    </div>
  );
}

/** Every reason but that of a failure names the outcome itself. */
const endWords = ({ outcome, reason }: MissionEnded): string =>
  outcome === "failed" ? `${t("outcome.failed")}: ${reasonText(reason)}` : reasonText(reason);

export function EstimatePanel() {
  const { belief, spec, ended, missionId, emitterId, bearings } = mission.value;
  const units = settings.value.units;
  const fact = belief?.fact;
  const estimate = fact?.estimate;
  const localized = fact?.localized ?? false;
  const missing = notYet(mission.value);
  return (
    <section class="panel estimate" data-testid="estimate" data-tour="3" aria-label={t("estimate.title")}>
      <h2>
        {t("estimate.title")}
        {supposedHere.value && <span class="supposed">{t("whatIf.mark")}</span>}
        {fact && (
          <span class={`verdict ${localized ? "verdict-yes" : ""}`} data-testid="verdict" data-localized={localized}>
            {t(localized ? "estimate.localized" : "estimate.notYet")}
          </span>
        )}
      </h2>
      <WhichShown />
      <Claim />
      {!fact && <p class="muted">{t("estimate.none")}</p>}
      {fact && !estimate && <p data-testid="inconsistent">{t("estimate.inconsistent")}</p>}
      {fact && estimate && fact.contradicting.length > 0 && (
        <p data-testid="against">{t("estimate.against", { against: fact.contradicting.length, bearings: fact.bearings })}</p>
      )}
      {estimate && (
        <>
          {fact.bearings > 0 && <Coordinates lat={estimate.lat} lon={estimate.lon} />}
          <dl class="figures">
            <div>
              <dt>{t("estimate.rmse")}</dt>
              <dd data-testid="expected-rmse" data-value={estimate.expected_rmse_m}>
                ±{formatLength(estimate.expected_rmse_m, units)}
                {spec && <Goal asked={spec.localization.expected_rmse_m} />}
              </dd>
            </div>
            <div>
              <dt>{t("estimate.c95")}</dt>
              <dd data-testid="c95-area" data-value={estimate.c95_area_m2}>
                {formatArea(estimate.c95_area_m2, units)}
                <small> {reachWords(estimate.c95 as Area)}</small>
              </dd>
            </div>
            {fact.sources.map((source) => (
              <Compass key={JSON.stringify(source.source)} errors={source} />
            ))}
            <TimeLeft />
            <BatteryThen />
          </dl>
        </>
      )}
      {!estimate && (
        <dl class="figures">
          <TimeLeft />
          <BatteryThen />
        </dl>
      )}
      {missing.length > 0 && (
        <ul class="reasons" data-testid="not-yet">
          {missing.map((reason, i) => (
            <li key={i}>{reasonText(reason)}</li>
          ))}
        </ul>
      )}
      {ended && (
        <p class="outcome" data-testid="outcome" data-outcome={ended.fact.outcome}>
          {endWords(ended.fact)}
        </p>
      )}
      {ended && missionId && emitterId && bearings.length > 1 && source.value?.keptByServer && (
        <AntennaDoubt missionId={missionId} emitterId={emitterId} key={missionId + emitterId + belief?.seq} />
      )}
    </section>
  );
}
