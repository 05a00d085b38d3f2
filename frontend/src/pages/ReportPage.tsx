// One printable page about one or several missions, in a searcher's words: where it is, how sure that is, what was not certain.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { locale, reasonText, t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import { ReportMap } from "../panels/ReportMap";
import * as api from "../sources/api";
import { polygonsOf } from "../state/areas";
import { claimedAfterS } from "../state/claimedAfter";
import { emitterName } from "../state/emitterName";
import { eventWords } from "../state/eventWords";
import { extent } from "../state/geometry";
import { placeOf } from "../state/importance";
import { type MissionState, missionAt } from "../state/mission";
import { notYet } from "../state/notYet";
import type { Route } from "../state/route";
import { settings } from "../state/settings";
import { isTold } from "../state/told";
import { judge } from "../state/truth";
import { viewOf } from "../state/view";
import { formatPlace } from "../units/coordinates";
import { formatArea, formatBearing, formatClock, formatDuration, formatLength, formatNumber } from "../units/quantities";
import type { Area, Problem, Recorded } from "../wire";
import "../style/review.css";

interface Told {
  id: string;
  events: readonly Recorded[];
  mission: MissionState;
}

function EmitterReport({ told, emitterId }: { told: Told; emitterId: string }) {
  const units = settings.value.units;
  const { coordinates } = settings.value;
  const view = viewOf(told.mission, null, emitterId);
  const { belief, truth, bearings, spec } = view;
  const fact = belief?.fact;
  const estimate = fact && fact.bearings > 0 ? fact.estimate : null;
  const place = truth?.fact.place ?? null;
  const judged = estimate && place ? judge(estimate, place) : null;
  const left = bearings.filter((b) => b.excluded).length;
  const parts = estimate ? polygonsOf(estimate.c95 as Area) : [];
  const number = placeOf(spec?.emitters ?? [], emitterId);
  const after = told.mission.emitters.size > 1 ? claimedAfterS(told.events, emitterId) : null;
  const reach = extent(parts.flatMap(([outline]) => outline ?? []));
  return (
    <section data-testid="report-emitter">
      <h2>{emitterName(spec?.emitters ?? [], emitterId)}</h2>
      <p class="lead" data-testid="report-lead">
        {estimate
          ? t(fact?.localized ? "report.found" : "report.perhaps", {
              place: formatPlace(estimate, coordinates),
              error: formatLength(estimate.expected_rmse_m, units),
            })
          : t("report.nothing")}
      </p>
      {(number !== null || after !== null) && (
        <p data-testid="report-order">
          {number !== null && t("report.priority", { number: number })}{" "}
          {after !== null && t("report.after", { time: formatDuration(after) })}
        </p>
      )}
      {estimate && (
        <p>
          {t("report.region", {
            area: formatArea(estimate.c95_area_m2, units),
            reach: formatLength(reach.metres, units),
            from: formatBearing(reach.bearing),
            to: formatBearing(reach.bearing + 180),
          })}
        </p>
      )}
      {(bearings.length > 0 || place || told.mission.emitters.size === 1) && <ReportMap view={view} />}
      {truth && (
        <p data-testid="report-truth">
          <strong>{place ? t("truth.at", { place: formatPlace(place, coordinates) }) : t("truth.notFound")}</strong>
          {judged && estimate && (
            <>
              {" "}
              {t("truth.error", { error: formatLength(judged.errorM, units) })}{" "}
              {t(judged.inside ? "truth.inside" : "truth.outside", { stated: formatLength(estimate.expected_rmse_m, units) })}
            </>
          )}
        </p>
      )}
      <h3>{t("report.uncertain")}</h3>
      <ul data-testid="report-uncertain">
        {notYet(view).map((reason, i) => (
          <li key={i}>{reasonText(reason)}</li>
        ))}
        {fact && fact.contradicting.length > 0 && (
          <li>{t("estimate.against", { against: fact.contradicting.length, bearings: fact.bearings })}</li>
        )}
        {parts.length > 1 && <li>{t("report.parts", { count: parts.length })}</li>}
        {view.rejected.length > 0 && <li>{t("report.rejected", { count: view.rejected.length })}</li>}
        {left > 0 && <li>{t("report.leftOut", { count: left })}</li>}
        {fact?.localized && fact.contradicting.length === 0 && view.rejected.length === 0 && left === 0 && (
          <li>{t("report.nothingUncertain")}</li>
        )}
        {!truth && <li>{t("report.unchecked")}</li>}
      </ul>
      {bearings.length > 0 && (
        <>
          <h3>{t("report.bearings")}</h3>
          <table class="stacked" data-testid="report-bearings">
            <thead>
              <tr>
                <th scope="col">{t("plan.place")}</th>
                <th scope="col">{t("report.time")}</th>
                <th scope="col">{t("report.where")}</th>
                <th scope="col">{t("sweep.title")}</th>
                <th scope="col">{t("report.quality")}</th>
              </tr>
            </thead>
            <tbody>
              {bearings.map(({ fact: b, at, excluded }) => (
                <tr key={b.bearing_id}>
                  {b.source.kind === "person" ? <td>{b.source.name}</td> : <td data-label={t("plan.place")}>{b.place_number}</td>}
                  <td>{formatClock(at)}</td>
                  <td class="below">{formatPlace(b.place, coordinates)}</td>
                  <td>
                    {t("sweep.bearing", { bearing: formatBearing(b.bearing_deg), sigma: formatNumber(b.sigma_deg, 1) })}
                    {excluded && ` (${t("sweep.excluded")})`}
                  </td>
                  <td data-label={t("report.quality")}>{b.sweep_id ? formatNumber(b.quality, 2) : "–"}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </>
      )}
    </section>
  );
}

function MissionReport({ told }: { told: Told }) {
  const { mission, events } = told;
  const { spec, startedAt, ended } = mission;
  const units = settings.value.units;
  const date = (at: string) =>
    new Date(at).toLocaleString(locale.value, { dateStyle: "long", timeStyle: "short", timeZone: "UTC", hourCycle: "h23" });
  const began = startedAt ?? events[0]?.at_utc ?? "";
  return (
    <article data-testid="report-mission">
      <h1>{spec?.name}</h1>
      <p class="muted">
        {began && t("report.when", { date: date(began) })}
        {ended && ` · ${t("report.took", { time: formatDuration(ended.fact.mission_time_s) })} · ${reasonText(ended.fact.reason)}`}
      </p>
      {[...mission.emitters.keys()].map((id) => (
        <EmitterReport told={told} emitterId={id} key={id} />
      ))}
      <h2>{t("report.timeline")}</h2>
      <table>
        <tbody>
          {events
            .filter((e) => isTold(e.event))
            .map((e) => (
              <tr key={e.seq}>
                <td>{e.at_utc.slice(0, 10) === began.slice(0, 10) ? formatClock(e.at_utc) : date(e.at_utc)}</td>
                <td>{eventWords(e, units, spec?.emitters ?? [])}</td>
              </tr>
            ))}
        </tbody>
      </table>
    </article>
  );
}

/** Of a sequence: every emitter of every mission in one line each. */
function Overview({ all }: { all: readonly Told[] }) {
  const { coordinates, units } = settings.value;
  const lines = all.flatMap((told) => [...told.mission.emitters.keys()].map((id) => ({ told, id, view: viewOf(told.mission, null, id) })));
  if (lines.length < 2) return null;
  return (
    <section data-testid="report-overview">
      <h1>{t("report.overview", { count: lines.length })}</h1>
      <table class="stacked">
        <thead>
          <tr>
            <th scope="col">{t("missions.name")}</th>
            <th scope="col">{t("report.emitter")}</th>
            <th scope="col">{t("report.place")}</th>
            <th scope="col">{t("report.giveOrTake")}</th>
            <th scope="col">{t("truth.title")}</th>
          </tr>
        </thead>
        <tbody>
          {lines.map(({ told, id, view: { belief, truth, spec } }) => {
            const estimate = belief && belief.fact.bearings > 0 ? belief.fact.estimate : null;
            return (
              <tr key={`${told.id} ${id}`}>
                <td>{spec?.name}</td>
                <td>{emitterName(spec?.emitters ?? [], id)}</td>
                <td class="below">{estimate ? formatPlace(estimate, coordinates) : t("report.notKnown")}</td>
                <td class={estimate ? "below" : "none"} data-label={t("report.giveOrTake")}>
                  {estimate ? formatLength(estimate.expected_rmse_m, units) : "–"}
                  {estimate && !belief?.fact.localized && ` (${t("report.notCertain")})`}
                </td>
                <td class={truth ? "below" : "none"} data-label={t("truth.title")}>
                  {truth ? (truth.fact.place ? formatPlace(truth.fact.place, coordinates) : t("truth.notFound")) : "–"}
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </section>
  );
}

export function ReportPage({ route }: { route: Extract<Route, { page: "report" }> }) {
  const [told, setTold] = useState<readonly Told[] | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const ids = route.missionIds.join("/");
  useEffect(() => {
    let current = true;
    setProblem(null);
    setTold(null);
    const read = async (id: string): Promise<Told> => {
      const events = await api.events(id);
      return { id, events, mission: missionAt(events, Number.POSITIVE_INFINITY) };
    };
    Promise.all(route.missionIds.map(read)).then(
      (all) => current && setTold(all),
      (error: unknown) => current && setProblem(asProblem(error)),
    );
    return () => {
      current = false;
    };
  }, [ids]);
  return (
    <div class="mission-report" data-testid="report" data-ready={told !== null}>
      <div class="no-print page-head">
        <span class="grow muted">{t("report.print")}</span>
        <button type="button" class="primary" data-testid="print" onClick={() => print()}>
          {t("report.printNow")}
        </button>
      </div>
      {problem && <ProblemBox problem={problem} />}
      {!told && !problem && <p class="muted">{t("missions.loading")}</p>}
      {told && <Overview all={told} />}
      {told?.map((one) => (
        <MissionReport told={one} key={one.id} />
      ))}
    </div>
  );
}
