// The newest sweep, or the one picked: plot, bearing, quality, why it was refused, leave it out.
import { useState } from "preact/hooks";
import { send } from "../commands/send";
import { reasonText, t } from "../i18n";
import { sweep as sweepHeard } from "../state/heard";
import { cursor } from "../state/moment";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { supposedHere } from "../state/supposed";
import type { MissionView } from "../state/view";
import { formatBearing, formatLength, formatNumber } from "../units/quantities";
import type { BearingMeasured, SweepProgress, SweepRejected } from "../wire";
import { type PolarData, PolarPlot } from "./PolarPlot";
import { ProblemNote } from "./ProblemNote";

type Sweep = { seq: number; fact: BearingMeasured | SweepRejected; excluded: boolean };

function sweepsOf(mission: Pick<MissionView, "bearings" | "rejected">): Sweep[] {
  return [
    ...mission.bearings.map(({ seq, fact, excluded }) => ({ seq, fact, excluded })),
    ...mission.rejected.map(({ seq, fact, excluded }) => ({ seq, fact, excluded })),
  ].toSorted((a, b) => b.seq - a.seq);
}

function polarOf({ fact, excluded }: Sweep): PolarData {
  const measured = fact.kind === "bearing_measured" ? fact : null;
  return {
    binnedDb: fact.binned_db,
    fittedDb: fact.fitted_db,
    samples: [],
    bearing: measured && { deg: measured.bearing_deg, sigmaDeg: measured.sigma_deg, quality: measured.quality },
    peaks: measured?.peaks.map((p) => ({ deg: p.bearing_deg, weight: p.weight })) ?? [],
    rejected: excluded || !measured,
  };
}

function progressPolar(running: SweepProgress): PolarData {
  const samples = running.heading_deg.map((headingDeg, i) => ({ headingDeg, db: running.power_db[i] ?? NaN }));
  return { binnedDb: [], fittedDb: [], samples, bearing: null, peaks: [], rejected: false };
}

function Running({ running, attempt }: { running: SweepProgress; attempt: number }) {
  return (
    <div class="sweep-body">
      <PolarPlot data={progressPolar(running)} />
      <div class="sweep-facts" data-testid="sweep-running">
        <strong>{t("sweep.place", { number: running.place_number })}</strong>
        {attempt > 1 && <div>{t("sweep.attempt", { attempt })}</div>}
        <div>{t("sweep.running", { turned: Math.min(360, Math.round(running.turned_deg)) })}</div>
        <progress max={360} value={running.turned_deg} aria-label={t("sweep.title")} />
      </div>
    </div>
  );
}

function LeaveOut({ evidenceId, label }: { evidenceId: string; label: string }) {
  const id = mission.value.missionId;
  if (cursor.value !== null || mission.value.ended || !id) return null;
  return (
    <button
      type="button"
      class="small"
      data-testid="exclude"
      onClick={() => void send("sweep", id, { kind: "exclude_bearing", bearing_id: evidenceId, reason: "" })}
    >
      {label}
    </button>
  );
}

function Facts({ sweep }: { sweep: Sweep }) {
  const { fact, excluded } = sweep;
  if (fact.kind === "sweep_rejected") {
    return (
      <div class="sweep-facts">
        <strong>{t("sweep.place", { number: fact.place_number })}</strong>
        <div>{t("sweep.attempt", { attempt: fact.attempt })}</div>
        <div>{t("sweep.quality", { quality: formatNumber(fact.quality, 2) })}</div>
        <div class="refused">{t("sweep.rejected", { reason: reasonText(fact.reason) })}</div>
        {fact.silence && <div data-testid="sweep-silence">{t(excluded ? "sweep.silence.excluded" : "sweep.silence")}</div>}
        {fact.silence && !excluded && <LeaveOut evidenceId={fact.sweep_id} label={t("sweep.silence.exclude")} />}
      </div>
    );
  }
  return (
    <div class="sweep-facts">
      <strong>
        {t("sweep.place", { number: fact.place_number })}
        {excluded && ` (${t("sweep.excluded")})`}
      </strong>
      <div class="sweep-bearing" data-testid="sweep-bearing" data-value={fact.bearing_deg}>
        {t("sweep.bearing", { bearing: formatBearing(fact.bearing_deg), sigma: formatNumber(fact.sigma_deg, 1) })}
      </div>
      <div>{t("sweep.quality", { quality: formatNumber(fact.quality, 2) })}</div>
      {fact.snr_db !== null && <div>{t("sweep.snr", { snr: formatNumber(fact.snr_db, 0) })}</div>}
      <div>{t("sweep.drift", { length: formatLength(fact.drift_m, settings.value.units) })}</div>
      {fact.peaks.length > 0 && (
        <div>
          {t("sweep.peaks", {
            peaks: fact.peaks
              .map((p) => t("sweep.peak", { bearing: formatBearing(p.bearing_deg), weight: formatNumber(p.weight, 2) }))
              .join(", "),
          })}
        </div>
      )}
      {fact.remarks.map((remark) => (
        <div class="refused" data-testid="sweep-remark" key={remark.code}>
          {reasonText(remark)}
        </div>
      ))}
      {!excluded && <LeaveOut evidenceId={fact.bearing_id} label={t("sweep.exclude")} />}
    </div>
  );
}

export function SweepPanel() {
  const [picked, setPicked] = useState<number | null>(null);
  const state = mission.value;
  const sweeps = sweepsOf(state);
  const running = cursor.value === null && state.phase === "measuring" ? sweepHeard.value : null;
  const sweep = sweeps.find((s) => s.seq === picked) ?? sweeps[0];
  const showRunning = running?.mission_id === state.missionId && picked === null;
  return (
    <section class="panel sweep" data-testid="sweep" data-tour="4" aria-label={t("sweep.title")}>
      <h2>
        {t("sweep.title")}
        {supposedHere.value && <span class="supposed">{t("whatIf.mark")}</span>}
        {sweeps.length > 0 && (
          <select
            aria-label={t("sweep.choose")}
            value={picked ?? ""}
            onChange={(e) => setPicked(e.currentTarget.value === "" ? null : Number(e.currentTarget.value))}
          >
            <option value="">{t("sweep.latest")}</option>
            {sweeps.map((s) => (
              <option value={s.seq} key={s.seq}>
                {t("sweep.place", { number: s.fact.place_number })}
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
          <Facts sweep={sweep} />
        </div>
      ) : (
        <p class="muted">{t("sweep.none")}</p>
      )}
    </section>
  );
}
