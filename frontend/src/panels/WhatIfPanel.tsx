// The review's question: what would have been believed and chosen here with another sensor or planner?
import { signal } from "@preact/signals";
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { reasonText, t } from "../i18n";
import * as api from "../sources/api";
import type { Supposition } from "../sources/coursesApi";
import { momentSeq } from "../state/moment";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { countedThen, flownBearings, supposed, supposedHere } from "../state/supposed";
import { formatBearing, formatLength, formatNumber } from "../units/quantities";
import type { AntennaReview, BearingMeasured, Problem, WhatIf, WhatIfRequest } from "../wire";
import { bytesOf, decodeBeliefFrame } from "../wire/beliefFrame";
import { SavePattern } from "./AntennaDoubt";
import { ProblemBox } from "./ProblemNote";
import { Choice, FurtherWishes, furtherWishes, isBudgetUnread, KeepVariant, Typed } from "./WhatIfMore";

const PLANNERS = {
  halving: { method: "rollout", selection: "sequential_halving" },
  uniform: { method: "rollout", selection: "uniform" },
  ellipse: { method: "base_policy", base_policy: "ellipse" },
  fisher: { method: "base_policy", base_policy: "fisher" },
} as const satisfies Record<string, Partial<WhatIfRequest>>;

type PlannerName = keyof typeof PLANNERS;

const sigma = signal("");
const outliers = signal("");
const mounting = signal("");
const pattern = signal<File | null>(null);
const planner = signal<PlannerName | "">("");

/** A typed number, null for an empty field; NaN for what is none. */
const typed = (text: string): number | null => (text.trim() === "" ? null : Number(text.replace(",", ".")));

/** What a sweep tells: its bearing, or that it tells nothing; null when it would not have been taken. */
function sweepWords(fact: BearingMeasured | WhatIf["sweeps"][number] | undefined): { text: string; why?: string } | null {
  if (!fact) return null;
  if (fact.kind === "sweep_rejected") return { text: t("whatIf.rejected"), why: reasonText(fact.reason) };
  return { text: t("sweep.bearing", { bearing: formatBearing(fact.bearing_deg), sigma: formatNumber(fact.sigma_deg, 1) }) };
}

function Steps({ answer }: { answer: WhatIf }) {
  const units = settings.value.units;
  const words = (rmse: number | null, localized: boolean | null) =>
    `${rmse === null ? "–" : `±${formatLength(rmse, units)}`}${localized ? ` ${t("whatIf.localized")}` : ""}`;
  return (
    <table class="candidates" data-testid="what-if-steps">
      <thead>
        <tr>
          <th scope="col">{t("whatIf.after")}</th>
          <th scope="col">{t("whatIf.flown")}</th>
          <th scope="col">{t("whatIf.supposed")}</th>
        </tr>
      </thead>
      <tbody>
        {answer.steps.slice(1).map((step, index) => {
          const flown = flownBearings.value[index];
          const would = answer.sweeps.findLast((s) => s.place_number === flown?.place_number);
          const [before, then] = [sweepWords(flown), sweepWords(would)];
          return (
            <tr key={step.bearings}>
              <td>{step.bearings}</td>
              <td>
                {words(step.flown_expected_rmse_m, step.flown_localized)}
                <small>{before?.text}</small>
              </td>
              <td>
                {words(step.expected_rmse_m, step.localized)}
                <small title={then?.why}>{then?.text}</small>
              </td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}

/** Whether the flight's own sweeps fit the antenna that was measured, and the pattern that they show instead. */
function Review({ missionId, emitterId }: { missionId: string; emitterId: string }) {
  const [found, setFound] = useState<AntennaReview | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const ask = async () => {
    setProblem(null);
    try {
      setFound(await api.antennaReview(missionId, emitterId));
    } catch (error) {
      setProblem(asProblem(error));
    }
  };
  const proposed = found?.proposed;
  return (
    <div class="what-if-pattern" data-testid="antenna-review">
      <button type="button" class="small" data-testid="antenna-review-ask" onClick={() => void ask()}>
        {t("whatIf.antenna.check")}
      </button>
      {problem && <ProblemBox problem={problem} />}
      {found && (
        <p class={found.doubt ? "refused" : "muted"} data-testid="antenna-review-answer">
          {found.doubt ? reasonText(found.doubt) : t("whatIf.antenna.fits", { count: found.sweeps })}
        </p>
      )}
      {proposed && (
        <>
          <button
            type="button"
            class="small"
            data-testid="antenna-review-take"
            onClick={() => (pattern.value = new File([proposed.text], proposed.filename, { type: "application/json" }))}
          >
            {t("whatIf.antenna.take")}
          </button>
          <SavePattern proposed={proposed} />
        </>
      )}
    </div>
  );
}

function Antenna() {
  return (
    <>
      <Typed part="mounting" label="whatIf.mounting" flown={t("whatIf.asItIs")} typed={mounting} />
      <div class="what-if-pattern">
        <label class="button">
          {pattern.value?.name ?? t("whatIf.pattern")}
          <input
            class="visually-hidden"
            type="file"
            accept=".json,.csv,.tsv,.txt"
            data-testid="what-if-pattern"
            onChange={(e) => {
              pattern.value = e.currentTarget.files?.[0] ?? null;
              e.currentTarget.value = "";
            }}
          />
        </label>
        {pattern.value && (
          <button type="button" class="icon" aria-label={t("whatIf.pattern.remove")} onClick={() => (pattern.value = null)}>
            ✕
          </button>
        )}
      </div>
    </>
  );
}

/** What the fields ask for. */
async function supposition(): Promise<Supposition> {
  const share = typed(outliers.value);
  return {
    sigma_deg: typed(sigma.value),
    outlier_probability: share === null ? null : share / 100,
    offset_to_nose_deg: typed(mounting.value),
    pattern: pattern.value && { filename: pattern.value.name, text: await pattern.value.text() },
    ...(planner.value && PLANNERS[planner.value]),
    ...furtherWishes(),
  };
}

export function WhatIfPanel() {
  const [asking, setAsking] = useState(false);
  const [problem, setProblem] = useState<Problem | null>(null);
  const { missionId, spec, emitterId } = mission.value;
  const counted = flownBearings.value.length;
  const shown = supposedHere.value;
  if (!missionId || !spec) return null;
  const ask = async () => {
    setAsking(true);
    setProblem(null);
    try {
      const asked = { missionId, counted: countedThen.value };
      const until = momentSeq.value;
      const answer = await api.whatIf(missionId, { ...(await supposition()), emitter_id: emitterId, bearings: counted, until });
      supposed.value = { ...asked, answer, frame: decodeBeliefFrame(bytesOf(answer.frame_base64)) };
    } catch (error) {
      setProblem(asProblem(error));
    } finally {
      setAsking(false);
    }
  };
  const unreadable = isBudgetUnread() || [sigma, outliers, mounting].some((field) => Number.isNaN(typed(field.value)));
  return (
    <details class="more what-if" data-testid="what-if" open={shown !== null}>
      <summary>{t("whatIf.title")}</summary>
      {shown && <Steps answer={shown.answer} />}
      {shown?.answer.antenna && (
        <p class="muted" data-testid="what-if-antenna">
          {t("whatIf.antenna", { name: shown.answer.antenna.name, offset: formatNumber(shown.answer.antenna.offset_to_nose_deg, 0) })}
        </p>
      )}
      {shown && shown.answer.legs_left_out > 0 && (
        <p class="muted" data-testid="what-if-legs">
          {t("whatIf.legsLeftOut", { count: shown.answer.legs_left_out })}
        </p>
      )}
      {shown?.answer.no_plan && <p class="muted">{t("whatIf.noPlan", { reason: reasonText(shown.answer.no_plan) })}</p>}
      <div class="what-if-fields">
        <Typed part="sigma" label="whatIf.sigma" flown={spec.sensor.sigma_deg} typed={sigma} />
        <Typed part="outliers" label="whatIf.outliers" flown={100 * spec.sensor.outlier_probability} typed={outliers} />
        <Antenna />
        {emitterId && <Review missionId={missionId} emitterId={emitterId} key={missionId + emitterId} />}
        <Choice
          part="planner"
          label="whatIf.planner"
          chosen={planner}
          options={Object.keys(PLANNERS) as PlannerName[]}
          words={(one) => `whatIf.planner.${one}`}
        />
        <FurtherWishes />
      </div>
      <div class="decision">
        <button type="button" class="primary" data-testid="what-if-ask" disabled={asking || unreadable} onClick={() => void ask()}>
          {t(asking ? "whatIf.asking" : "whatIf.ask", { count: counted })}
        </button>
        {shown && (
          <button type="button" data-testid="what-if-back" onClick={() => (supposed.value = null)}>
            {t("whatIf.back")}
          </button>
        )}
      </div>
      {problem && <ProblemBox problem={problem} />}
      <KeepVariant missionId={missionId} asked={supposition} />
    </details>
  );
}
