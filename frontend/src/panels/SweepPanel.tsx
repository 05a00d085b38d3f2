// The newest sweep, or the one picked: plot, bearing, quality, why it was refused, leave it out.
import { useState } from "preact/hooks";
import { reasonText, t } from "../i18n";
import { sourceKey } from "../state/emitter";
import { sweep as sweepHeard } from "../state/heard";
import { cursor } from "../state/moment";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { supposedHere } from "../state/supposed";
import type { MissionView } from "../state/view";
import { sourceName } from "../state/words";
import { formatBearing, formatLength, formatNumber } from "../units/quantities";
import type { BearingMeasured, BearingSource, SweepProgress, SweepRejected } from "../wire";
import { CountButton, OrderButton } from "./CountButton";
import { OnTheWay } from "./OnTheWay";
import { type PolarData, PolarPlot } from "./PolarPlot";
import { ProblemNote } from "./ProblemNote";

type Sweep = { seq: number; fact: BearingMeasured | SweepRejected; leftOut: boolean; excluded: boolean };

function sweepsOf(mission: Pick<MissionView, "bearings" | "rejected">): Sweep[] {
  return [
    ...mission.bearings.map(({ seq, fact, leftOut, excluded }) => ({ seq, fact, leftOut, excluded })),
    ...mission.rejected.map(({ seq, fact, excluded }) => ({ seq, fact, leftOut: excluded, excluded })),
  ].toSorted((a, b) => b.seq - a.seq);
}

type Turn = NonNullable<BearingMeasured["turn"]>;

const sectorOf = (turn: Turn | null): PolarData["sector"] =>
  turn && turn.turned_deg < 355 ? { beginDeg: turn.begin_deg, turnedDeg: turn.turned_deg, goalDeg: turn.turned_deg } : null;

/** How far the craft turned for this sweep; opened, why: one line a decision. */
function TurnWords({ turn }: { turn: Turn }) {
  const whys = [turn.planned_because, ...turn.went_on_because, turn.stopped_because];
  return (
    <details class="sweep-turn" data-testid="sweep-turn">
      <summary>{t("sweep.turnedSector", { turned: Math.round(turn.turned_deg), begin: formatBearing(turn.begin_deg) })}</summary>
      <ol>
        {whys.map((why, i) => (
          <li key={`${i} ${why.code}`}>{reasonText(why)}</li>
        ))}
      </ol>
    </details>
  );
}

function polarOf({ fact, excluded }: Sweep): PolarData {
  const measured = fact.kind === "bearing_measured" ? fact : null;
  return {
    binnedDb: fact.binned_db,
    fittedDb: fact.fitted_db,
    samples: [],
    bearing: measured && { deg: measured.bearing_deg, sigmaDeg: measured.sigma_deg },
    peaks: measured?.peaks.map((p) => ({ deg: p.bearing_deg, weight: p.weight })) ?? [],
    rejected: excluded || !measured,
    sector: sectorOf(fact.turn),
  };
}

function progressPolar(running: SweepProgress): PolarData {
  const samples = running.heading_deg.map((headingDeg, i) => ({ headingDeg, db: running.power_db[i] ?? NaN }));
  const sector = running.sector && {
    beginDeg: running.sector.begin_deg,
    turnedDeg: running.turned_deg,
    goalDeg: running.sector.goal_deg,
  };
  return { binnedDb: [], fittedDb: [], samples, bearing: null, peaks: [], rejected: false, sector };
}

function Running({ running, attempt }: { running: SweepProgress; attempt: number }) {
  const turned = Math.round(running.turned_deg);
  const goal = running.sector?.goal_deg ?? 360;
  return (
    <div class="sweep-body">
      <PolarPlot data={progressPolar(running)} />
      <div class="sweep-facts" data-testid="sweep-running">
        <strong>{t("sweep.place", { number: running.place_number })}</strong>
        {attempt > 1 && <div>{t("sweep.attempt", { attempt })}</div>}
        <div>
          {running.sector
            ? t("sweep.runningSector", { turned, goal: Math.round(goal) })
            : t("sweep.running", { turned: Math.min(360, turned) })}
        </div>
        <progress max={goal} value={running.turned_deg} aria-label={t("sweep.title")} />
        {running.sector?.because && <div class="muted">{reasonText(running.sector.because)}</div>}
      </div>
    </div>
  );
}

/** Places are counted for craft only. */
const whereOf = ({ source, place_number: number }: BearingMeasured | SweepRejected): string =>
  source.kind === "person" ? source.name : t("sweep.place", { number });

/** A craft is not muted: it would go on measuring for nothing. */
function mutableOf(source: BearingSource): { of: "person" | "import"; name: string } | null {
  switch (source.kind) {
    case "craft":
      return null;
    case "import":
      return { of: "import", name: source.recording_id };
    case "person":
      return { of: "person", name: source.name };
  }
}

/** A person's bearings can be left out all at once. */
function MuteButton({ id, source }: { id: string; source: BearingSource }) {
  const mutable = mutableOf(source);
  if (!mutable) return null;
  const muted = mission.value.muted.has(sourceKey(source));
  return (
    <OrderButton
      id={id}
      about={sourceKey(source)}
      leftOut={muted}
      order={{ ...mutable, kind: "mute_source", muted: !muted, reason: "" }}
      testId="mute-source"
      isPressed={muted}
      words={t(muted ? "sweep.unmute" : "sweep.mute", { source: sourceName(source) })}
    />
  );
}

function Facts({ sweep }: { sweep: Sweep }) {
  const { fact, leftOut, excluded } = sweep;
  const id = cursor.value === null && !mission.value.ended ? mission.value.missionId : null;
  if (fact.kind === "sweep_rejected") {
    return (
      <>
        <strong>{t("sweep.place", { number: fact.place_number })}</strong>
        <div>{t("sweep.attempt", { attempt: fact.attempt })}</div>
        <div>{t("sweep.quality", { quality: formatNumber(fact.quality, 2) })}</div>
        <div class="refused">{t("sweep.rejected", { reason: reasonText(fact.reason) })}</div>
        {fact.silence && <div data-testid="sweep-silence">{t(excluded ? "sweep.silence.excluded" : "sweep.silence")}</div>}
        {fact.silence && id && (
          <CountButton id={id} of={fact.sweep_id} leftOut={excluded} words={excluded ? "sweep.silence.include" : "sweep.silence.exclude"} />
        )}
        {fact.turn && <TurnWords turn={fact.turn} />}
      </>
    );
  }
  return (
    <>
      <div class="sweep-head">
        <div>
          <strong>
            {whereOf(fact)}
            {excluded && ` (${t(leftOut ? "sweep.excluded" : "sweep.muted")})`}
          </strong>
          <div class="sweep-bearing" data-testid="sweep-bearing" data-value={fact.bearing_deg}>
            {t("sweep.bearing", { bearing: formatBearing(fact.bearing_deg), sigma: formatNumber(fact.sigma_deg, 1) })}
          </div>
        </div>
        {id && <CountButton id={id} of={fact.bearing_id} leftOut={leftOut} words={leftOut ? "sweep.include" : "sweep.exclude"} />}
      </div>
      <div class="sweep-values">
        {fact.sweep_id && <span>{t("sweep.quality", { quality: formatNumber(fact.quality, 2) })}</span>}
        {fact.snr_db !== null && <span>{t("sweep.snr", { snr: formatNumber(fact.snr_db, 0) })}</span>}
        {fact.sweep_id && <span>{t("sweep.drift", { length: formatLength(fact.drift_m, settings.value.units) })}</span>}
      </div>
      {fact.peaks.length > 0 && (
        <div>
          {t("sweep.peaks", {
            peaks: fact.peaks
              .map((p) => t("sweep.peak", { bearing: formatBearing(p.bearing_deg), weight: formatNumber(p.weight, 2) }))
              .join(", "),
          })}
        </div>
      )}
      {fact.turn && <TurnWords turn={fact.turn} />}
      {fact.remarks.map((remark) => (
        <div class="refused" data-testid="sweep-remark" key={remark.code}>
          {reasonText(remark)}
        </div>
      ))}
      {id && <MuteButton id={id} source={fact.source} />}
    </>
  );
}

export function SweepPanel() {
  const [picked, setPicked] = useState<number | null>(null);
  const state = mission.value;
  const sweeps = sweepsOf(state);
  const running = cursor.value === null && state.phase === "measuring" ? sweepHeard.value : null;
  const chosen = sweeps.find((s) => s.seq === picked);
  const sweep = chosen ?? sweeps[0];
  const showRunning = running?.mission_id === state.missionId && !chosen;
  const ways = <OnTheWay ways={state.ways} />;
  const beside = sweep && !(running && showRunning);
  return (
    <section class="panel sweep" data-testid="sweep" data-tour="4" aria-label={t("sweep.title")}>
      <h2>
        {t("sweep.title")}
        {supposedHere.value && <span class="supposed">{t("whatIf.mark")}</span>}
        {sweeps.length > 0 && (
          <select
            aria-label={t("sweep.choose")}
            value={chosen?.seq ?? ""}
            onChange={(e) => setPicked(e.currentTarget.value === "" ? null : Number(e.currentTarget.value))}
          >
            <option value="">{t("sweep.latest")}</option>
            {sweeps.map((s) => (
              <option value={s.seq} key={s.seq}>
                {whereOf(s.fact)}
                {s.fact.kind === "bearing_measured"
                  ? `, ${formatBearing(s.fact.bearing_deg)}`
                  : `, ${t("sweep.attempt", { attempt: s.fact.attempt })} ✕`}
              </option>
            ))}
          </select>
        )}
        <span class="legend" aria-hidden="true">
          <i class="line line-power" /> {t("sweep.power")} <i class="line line-fit" /> {t("sweep.fit")}
        </span>
      </h2>
      <ProblemNote desk="sweep" />
      {running && showRunning ? (
        <Running running={running} attempt={state.attempt} />
      ) : sweep ? (
        <div class="sweep-body">
          <PolarPlot data={polarOf(sweep)} />
          <div class="sweep-facts">
            <Facts sweep={sweep} />
            {ways}
          </div>
        </div>
      ) : (
        <p class="muted">{t("sweep.none")}</p>
      )}
      {!beside && ways}
    </section>
  );
}
