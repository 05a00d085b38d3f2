// What all checked missions of an antenna or a vehicle say: how right bearings, fixes and forecasts were, and what to change.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { learnInto, profiles } from "../edit/profiles";
import { type MessageKey, t } from "../i18n";
import { ErrorMap } from "../panels/ErrorMap";
import { ProblemBox } from "../panels/ProblemNote";
import { type Calibration, calibration, type Suggested } from "../sources/libraryApi";
import { missionAddress } from "../state/route";
import { settings } from "../state/settings";
import { formatDuration, formatLength, formatNumber, signedDegrees } from "../units/quantities";
import type { Problem } from "../wire";
import "../style/review.css";

type Share = Calibration["c95"];

interface ReliabilityProperties {
  label: MessageKey;
  share: Share;
  wanted: number | null;
  sharpness?: string | null;
}

/** A bar with its interval and the share that is wanted; how much was stated on average: what is vague is right easily. */
function Reliability({ label, share, wanted, sharpness = null }: ReliabilityProperties) {
  const percent = (value: number) => Math.round(100 * value);
  return (
    <tr data-testid="reliability" data-of={share.of}>
      <th scope="row">{t(label)}</th>
      <td class="number">{share.of === 0 ? "–" : `${percent(share.share)} %`}</td>
      <td>
        <svg class="reliability" viewBox="0 0 100 12" preserveAspectRatio="none" aria-hidden="true">
          <rect class="reliability-range" x={100 * share.low} y="3" width={100 * (share.high - share.low)} height="6" />
          {share.of > 0 && <rect class="reliability-share" x={100 * share.share - 0.6} y="0" width="1.2" height="12" />}
          {wanted !== null && <line class="reliability-wanted" x1={wanted} x2={wanted} y1="0" y2="12" vector-effect="non-scaling-stroke" />}
        </svg>
      </td>
      <td class="muted">
        {t("calibration.interval", { low: percent(share.low), high: percent(share.high), of: share.of })}
        {wanted !== null && ` · ${t("calibration.wanted", { percent: wanted })}`}
      </td>
      <td data-testid="sharpness" data-label={sharpness === null ? undefined : t("calibration.sharpness")}>
        {sharpness}
      </td>
    </tr>
  );
}

function Suggestion({ suggested }: { suggested: Suggested }) {
  const [taken, setTaken] = useState<string | null>(null);
  const known = profiles.value;
  return (
    <section class="card suggestion" data-testid="suggestion">
      <div class="grow">
        <h2>{t("calibration.suggested")}</h2>
        <p>
          {t("calibration.sigma", {
            sigma: formatNumber(suggested.sigma_deg, 1),
            outliers: Math.round(100 * suggested.outlier_probability),
          })}{" "}
          {t("calibration.offset", {
            offset: signedDegrees(suggested.offset_deg, 1),
            error: formatNumber(suggested.offset_std_error_deg, 1),
          })}
          {suggested.speed_m_s !== null &&
            ` ${t("calibration.motion", { speed: formatNumber(suggested.speed_m_s, 1), constant: formatNumber(suggested.constant_s ?? 0, 1) })}`}
        </p>
        {known.length === 0 && <p class="muted">{t("calibration.noProfile")}</p>}
        {taken !== null && <p role="status">{t("calibration.taken", { name: taken })}</p>}
      </div>
      {known.map(({ name }) => (
        <button
          type="button"
          class="primary"
          data-testid="take-over"
          key={name}
          onClick={() => {
            learnInto(name, suggested);
            setTaken(name);
          }}
        >
          {t("calibration.takeOver", { name })}
        </button>
      ))}
    </section>
  );
}

function Choose({ label, value, all, onChoose }: { label: MessageKey; value: string; all: string[]; onChoose: (v: string) => void }) {
  return (
    <label class="field-inline">
      {t(label)}
      <select value={value} onChange={(e) => onChoose(e.currentTarget.value)}>
        <option value="">{t("calibration.any")}</option>
        {all.map((one) => (
          <option value={one} key={one}>
            {one}
          </option>
        ))}
      </select>
    </label>
  );
}

function Found({ found }: { found: Calibration }) {
  const units = settings.value.units;
  const { sharpness_deg: sigma, sharpness_m: stated, forecast_90_s: forecast, forecast_took_s: took } = found;
  return (
    <>
      <p data-testid="calibration-of">
        {t("calibration.of", { missions: found.missions, bearings: found.bearings.length, lost: found.not_found })}
        {found.error_ratio !== null && ` ${t("calibration.ratio", { ratio: formatNumber(found.error_ratio, 2) })}`}
      </p>
      <table class="table reliabilities">
        <thead>
          <tr>
            <td />
            <th scope="col" colSpan={3}>
              {t("calibration.held")}
            </th>
            <th scope="col">{t("calibration.sharpness")}</th>
          </tr>
        </thead>
        <tbody>
          <Reliability
            label="calibration.one"
            share={found.within_1_sigma}
            wanted={68}
            sharpness={sigma !== null ? `±${formatNumber(sigma, 1)}°` : null}
          />
          <Reliability label="calibration.two" share={found.within_2_sigma} wanted={95} />
          <Reliability
            label="calibration.c95"
            share={found.c95}
            wanted={95}
            sharpness={stated !== null ? `±${formatLength(stated, units)}` : null}
          />
          <Reliability
            label="calibration.forecast"
            share={found.forecast_90}
            wanted={90}
            sharpness={
              forecast !== null && took !== null
                ? t("calibration.forecastSharpness", { stated: formatDuration(forecast), took: formatDuration(took) })
                : null
            }
          />
          <Reliability label="calibration.outliers" share={found.outliers} wanted={null} />
        </tbody>
      </table>
      {found.suggested ? (
        <Suggestion suggested={found.suggested} />
      ) : (
        <p class="muted">{t("calibration.tooFew", { needed: found.needed })}</p>
      )}
      {found.bearings.length > 0 && <ErrorMap bearings={found.bearings} />}
      {found.fixes.length > 0 && (
        <table class="table">
          <thead>
            <tr>
              <th scope="col">{t("missions.name")}</th>
              <th scope="col">{t("calibration.error")}</th>
              <th scope="col">{t("estimate.rmse")}</th>
              <th scope="col">{t("estimate.c95")}</th>
            </tr>
          </thead>
          <tbody>
            {found.fixes.map((fix) => (
              <tr key={`${fix.mission_id} ${fix.emitter_id}`}>
                <td>
                  <a href={missionAddress(fix.mission_id)}>{fix.name}</a>
                </td>
                <td class="number">{formatLength(fix.error_m, units)}</td>
                <td class="number">±{formatLength(fix.stated_m, units)}</td>
                <td>{t(fix.inside ? "calibration.hit" : "calibration.missed")}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </>
  );
}

const told = ({ bearings, fixes, forecast_90 }: Calibration) => bearings.length + fixes.length + forecast_90.of > 0;

/** Why there are no figures. chosen: they are asked of one vehicle or antenna. */
function Nothing({ found, chosen }: { found: Calibration; chosen: boolean }) {
  const { missions, not_found: lost } = found;
  const none = t(chosen ? "calibration.noneOfThese" : "calibration.empty");
  return (
    <p class="card" data-testid="calibration-nothing">
      {missions > 0 ? t("calibration.nothingTold", { missions, lost }) : none}
    </p>
  );
}

export function CalibrationPage() {
  const [craft, setCraft] = useState("");
  const [antenna, setAntenna] = useState("");
  const [found, setFound] = useState<Calibration | null>(null);
  const [loading, setLoading] = useState(true);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    let current = true;
    setLoading(true);
    setProblem(null);
    calibration(craft, antenna).then(
      (answer) => {
        if (!current) return;
        setFound(answer);
        setLoading(false);
      },
      (error: unknown) => {
        if (!current) return;
        setProblem(asProblem(error));
        setLoading(false);
      },
    );
    return () => {
      current = false;
    };
  }, [craft, antenna]);
  const chosen = craft !== "" || antenna !== "";
  return (
    <div class="page" data-testid="calibration">
      <div class="page-head">
        <h1>{t("menu.calibration")}</h1>
        <Choose label="calibration.craft" value={craft} all={found?.crafts ?? []} onChoose={setCraft} />
        <Choose label="calibration.antenna" value={antenna} all={found?.antennas ?? []} onChoose={setAntenna} />
      </div>
      {problem && <ProblemBox problem={problem} />}
      {loading && (
        <p class="muted" role="status" data-testid="calibration-loading">
          {t("calibration.loading")}
        </p>
      )}
      {found && !loading && !problem && (told(found) ? <Found found={found} /> : <Nothing found={found} chosen={chosen} />)}
    </div>
  );
}
