// Where to go next, what else was considered, why this one; accept, veto, or another place by slide.
import { useEffect, useRef, useState } from "preact/hooks";
import { cancelProposal, confirmProposal, type Proposal, proposal, propose } from "../commands/proposal";
import { SlideToConfirm } from "../commands/SlideToConfirm";
import { send } from "../commands/send";
import { locale, reasonText, t } from "../i18n";
import { rankCandidates, roundShade } from "../state/candidates";
import { source } from "../state/connection";
import { emitterName } from "../state/emitterName";
import { bearingDeg, distanceM, lonLat } from "../state/geometry";
import { highlighted } from "../state/highlight";
import { isHomeward } from "../state/mission";
import { cursor, liveMission } from "../state/moment";
import { areaAddress } from "../state/route";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { supposedHere } from "../state/supposed";
import { vehicle } from "../state/vehicle";
import { formatPlace } from "../units/coordinates";
import { formatBearing, formatDuration, formatLength, formatNumber } from "../units/quantities";
import type { CandidateFact, Place, PlanChosen } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { ProblemBox, ProblemNote } from "./ProblemNote";
import { ProfileCard } from "./ProfileCard";
import { WhatIfPanel } from "./WhatIfPanel";

const SHOWN = 12;

/** Nearer than this the bearing is noise. */
const HERE_M = 2;

function wayWords(here: LonLat, place: Place): string {
  const length = distanceM(here, lonLat(place));
  if (length < HERE_M) return t("plan.here");
  return t("plan.distance", {
    length: formatLength(length, settings.value.units),
    bearing: formatBearing(bearingDeg(here, lonLat(place))),
  });
}

function roundWords(candidate: CandidateFact): string {
  return candidate.dropped_in_round === null ? t("plan.kept") : t("plan.roundNumber", { round: candidate.dropped_in_round });
}

/** Within the table alone, and for a pointer over the map: a row that is pointed at itself stays where it is. */
function showRow(box: HTMLElement | null, row: HTMLElement | null): void {
  if (!box || !row || row.matches(":hover")) return;
  const [within, own] = [box.getBoundingClientRect(), row.getBoundingClientRect()];
  if (own.top < within.top) box.scrollTop -= within.top - own.top;
  else if (own.bottom > within.bottom) box.scrollTop += own.bottom - within.bottom;
}

function CandidateTable({ plan }: { plan: PlanChosen }) {
  const ranked = rankCandidates(plan);
  const shown = ranked.filter(({ index }, place) => place < SHOWN || index === highlighted.value);
  const lit = useRef<HTMLTableRowElement>(null);
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => showRow(box.current, lit.current), [highlighted.value]);
  useEffect(() => {
    if (box.current) box.current.scrollTop = 0; // another decision is read from its chosen place on
  }, [plan]);
  useEffect(
    () => () => {
      highlighted.value = null; // a number of this decision means another place in the next
    },
    [plan],
  );
  const canPropose = cursor.value === null && !isHomeward(mission.value);
  return (
    // it scrolls, and in a review none of its rows takes the keyboard
    <div class="candidate-box" ref={box} tabIndex={canPropose ? undefined : 0}>
      <table class="candidates" data-testid="candidates">
        <caption class="visually-hidden">{t("plan.candidates")}</caption>
        <thead>
          <tr>
            <th scope="col">{t("plan.candidate")}</th>
            <th scope="col">{t("plan.value")}</th>
            <th scope="col">{t("plan.error")}</th>
            <th scope="col">{t("plan.rollouts")}</th>
            <th scope="col">{t("plan.round")}</th>
          </tr>
        </thead>
        <tbody>
          {shown.map(({ candidate, index, chosen }) => (
            <tr
              key={index}
              ref={highlighted.value === index ? lit : null}
              data-testid="candidate"
              data-chosen={chosen}
              class={`${chosen ? "chosen" : ""} ${highlighted.value === index ? "lit" : ""}`}
              onMouseEnter={() => (highlighted.value = index)}
              onMouseLeave={() => (highlighted.value = null)}
            >
              <td>
                <button
                  type="button"
                  class="candidate-name"
                  disabled={!canPropose || chosen}
                  title={t("plan.flyHere")}
                  onFocus={() => (highlighted.value = index)}
                  onBlur={() => (highlighted.value = null)}
                  onClick={() => propose({ lat: candidate.lat, lon: candidate.lon })}
                >
                  <i class="swatch" style={{ background: `var(--round-${roundShade(candidate, plan, chosen)})` }} />
                  {index + 1}
                </button>
              </td>
              <td>{formatDuration(candidate.value_s)}</td>
              <td>{candidate.std_error_s === null ? "–" : formatNumber(candidate.std_error_s, candidate.std_error_s < 100 ? 1 : 0)}</td>
              <td>{candidate.rollouts}</td>
              <td>{chosen ? t("plan.survived") : roundWords(candidate)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

function costWords({ result, withPlanner }: Proposal): string | null {
  if (result === null) return null;
  if (result.expected_time_s === null) return t("proposal.unknownCost");
  if (result.compared === null) return null;
  const { difference_s: difference, std_error_s: error, quicker } = result.compared;
  const than = t(withPlanner ? "proposal.thanPlanner" : "proposal.thanChosen");
  const chance = !quicker && difference < 2 * error;
  if (chance || Math.abs(difference) < 1) return t("proposal.same", { than });
  return t(difference > 0 ? "proposal.costs" : "proposal.saves", { difference: formatDuration(Math.abs(difference)), than });
}

function ProposalCard({ proposed }: { proposed: Proposal }) {
  const { result, problem } = proposed;
  const here = vehicle.value.at;
  const card = useRef<HTMLDivElement>(null);
  useEffect(() => card.current?.scrollIntoView({ block: "nearest" }), [result, problem]);
  return (
    <div class="proposal" data-testid="proposal" data-allowed={result?.allowed ?? ""} ref={card}>
      <h3>{t("proposal.title")}</h3>
      <div>
        {formatPlace(proposed.place, settings.value.coordinates)}
        {here && (
          <span class="muted">
            {" · "}
            {wayWords(here, proposed.place)}
          </span>
        )}
      </div>
      {!result && !problem && <p class="muted">{t("proposal.asking")}</p>}
      {problem && <ProblemBox problem={problem} />}
      {result?.reason && !result.allowed && (
        <p class="refused" role="alert">
          {t("proposal.notAllowed", { reason: reasonText(result.reason) })}
        </p>
      )}
      {result?.expected_time_s != null && (
        <p data-testid="proposal-cost" data-seconds={result.expected_time_s}>
          {t("proposal.expected", { time: formatDuration(result.expected_time_s) })}
          {result.time_90_s !== null && ` (${t("proposal.in90", { time: formatDuration(result.time_90_s) })})`}
        </p>
      )}
      {result && (
        <p data-testid="proposal-compared" data-difference={result.compared?.difference_s ?? ""}>
          <strong>{costWords(proposed)}</strong>
        </p>
      )}
      {result?.compared?.rules.map((rule) => (
        <p class="muted" data-testid="proposal-rule" key={rule.code}>
          {reasonText(rule)}
        </p>
      ))}
      <ProblemNote desk="proposal" />
      {result?.allowed || problem ? (
        <SlideToConfirm
          key={`${proposed.place.lat},${proposed.place.lon}`}
          label={t("proposal.slide")}
          testId="override-slider"
          onConfirm={confirmProposal}
          onCancel={cancelProposal}
          expiresS={30}
        />
      ) : (
        <button type="button" onClick={cancelProposal}>
          {t("proposal.cancel")}
        </button>
      )}
    </div>
  );
}

function Decision({ id }: { id: string }) {
  const { phase, automatic, craftId: craft_id } = mission.value;
  const waiting = phase === "waiting";
  const [accepting, setAccepting] = useState(false);
  const accept = async () => {
    setAccepting(true);
    await send("plan", id, { kind: "accept", craft_id });
    setAccepting(false);
  };
  return (
    <div class="decision">
      <button
        type="button"
        class={waiting ? "primary" : ""}
        data-testid="accept"
        disabled={!waiting || accepting}
        onClick={() => void accept()}
      >
        {t("plan.accept")}
      </button>
      <button
        type="button"
        data-testid="veto"
        disabled={!waiting && phase !== "flying"}
        onClick={() => void send("plan", id, { kind: "veto", craft_id })}
      >
        {t("plan.veto")}
      </button>
      <button
        type="button"
        class="switch"
        role="switch"
        aria-checked={automatic}
        data-testid="automatic"
        title={t("plan.auto")}
        onClick={() => void send("plan", id, { kind: "set_automatic", craft_id, automatic: !automatic })}
      >
        <span class="switch-knob" aria-hidden="true" />
        <span>
          {t("plan.auto")}
          <small>{t(automatic ? "plan.autoOn" : "plan.autoOff")}</small>
        </span>
      </button>
    </div>
  );
}

/** An open proposal is priced again when another place is chosen, and falls when it was the one, on the way home and with the page. */
function useProposal() {
  const { missionId, plan } = liveMission.value;
  const isHome = isHomeward(liveMission.value);
  useEffect(() => {
    const place = proposal.peek()?.place;
    if (!place) return;
    const next = plan?.fact.place;
    if (isHome || (next?.lat === place.lat && next.lon === place.lon)) cancelProposal();
    else propose(place);
  }, [plan?.fact, isHome]);
  useEffect(() => cancelProposal, [missionId]);
}

export function PlanPanel() {
  useProposal();
  const { plan, missionId, phase, startedAt, spec } = mission.value;
  const proposed = proposal.value;
  const isLive = cursor.value === null && !isHomeward(mission.value);
  const fact = plan?.fact;
  const here = vehicle.value.at;
  return (
    <section class="panel plan" data-testid="plan" data-tour="5" aria-label={t("plan.title")}>
      <h2>
        {t("plan.title")}
        {supposedHere.value && (
          <span class="supposed" data-testid="supposed">
            {t("whatIf.mark")}
          </span>
        )}
        {fact && here && !isHomeward(mission.value) && <span class="muted">{wayWords(here, fact.place)}</span>}
      </h2>
      <ProblemNote desk="plan" />
      {proposed && isLive && <ProposalCard proposed={proposed} />}
      {missionId && isLive && startedAt && liveMission.value.missionId === missionId && (
        <Decision id={missionId} key={mission.value.craftId} />
      )}
      {missionId && isLive && source.value?.keptByServer && phase === "hold" && (
        <a class="button" data-testid="change-area" href={areaAddress(missionId)}>
          {t("area.change")}
        </a>
      )}
      {cursor.value !== null && source.value?.keptByServer && <WhatIfPanel />}
      {fact && fact.candidates.length > 0 && <CandidateTable plan={fact} />}
      {fact ? (
        <p class="why" data-testid="why">
          <span class="muted">{t("plan.why")}</span> {reasonText(fact.reason)}
        </p>
      ) : (
        <p class="muted">{t("plan.none")}</p>
      )}
      {fact?.set_back?.map(({ emitter_id: id, reason }) => (
        <p class="muted" data-testid="set-back" key={id}>
          {t("order.back", { name: emitterName(spec?.emitters ?? [], id), reason: reasonText(reason) })}
        </p>
      ))}
      {missionId && isLive && source.value?.keptByServer && (proposed || fact) && (
        <ProfileCard missionId={missionId} place={(proposed ?? fact!).place} />
      )}
      {fact?.source === "planner" && (
        <p class="muted">
          {t("plan.effort", {
            rollouts: fact.rollouts.toLocaleString(locale.value),
            candidates: fact.candidates.length,
            time: formatNumber(fact.plan_ms, 0),
          })}
        </p>
      )}
      {fact && isLive && !proposed && <p class="muted">{t("plan.dragHint")}</p>}
    </section>
  );
}
