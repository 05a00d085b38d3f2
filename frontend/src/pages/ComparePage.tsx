// Missions, and a mission with its variants, on one axis of time: how sure each was, when, and how right.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { reasonText, t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import * as api from "../sources/api";
import { courses, dropVariant, type MissionCourses } from "../sources/coursesApi";
import { errorTicks, type Line, lastSecond, linesOf, minuteStep, stepPath } from "../state/courses";
import { emitterName } from "../state/emitterName";
import { missionAddress, type Route } from "../state/route";
import { settings } from "../state/settings";
import { formatArea, formatDuration, formatLength } from "../units/quantities";
import type { MissionSummary, Problem } from "../wire";
import "../style/compare.css";

const WIDTH = 1000;
const HEIGHT = 320;
const COLOURS = 6;
const DASHES = ["", "10 5", "3 5", "12 4 3 4"];
const lineClass = (index: number) => `compare-line compare-line-${index % COLOURS}`;

function called(line: Line, alone: boolean): string {
  const name = line.variant ?? (alone ? t("compare.flown") : line.mission);
  return line.emitter === null ? name : `${name} · ${line.emitter}`;
}

/** Which emitter of a mission the courses are about; of one with a single emitter there is nothing to choose. */
function EmitterChoice({ one, alone, onChoose }: { one: MissionCourses; alone: boolean; onChoose: (emitter: string) => void }) {
  if (one.emitters.length < 2) return null;
  return (
    <label class="field-inline">
      {alone ? t("compare.emitter") : t("compare.emitterOf", { mission: one.name })}
      <select data-testid="compare-emitter" value={one.emitter_id} onChange={(e) => onChoose(e.currentTarget.value)}>
        {one.emitters.map(({ emitter_id: id }) => (
          <option value={id} key={id}>
            {emitterName(one.emitters, id)}
          </option>
        ))}
      </select>
    </label>
  );
}

function Axes({ missions, lines }: { missions: readonly MissionCourses[]; lines: readonly Line[] }) {
  const { units } = settings.value;
  const until = lastSecond(missions);
  const heights = errorTicks(lines);
  const [low, high] = [Math.log(heights[0]!), Math.log(heights.at(-1)!)];
  const x = (s: number) => (WIDTH * s) / until;
  const y = (m: number) => HEIGHT * (1 - (Math.log(m) - low) / Math.max(high - low, 1e-9));
  const step = 60 * minuteStep(until);
  const minutes = Array.from({ length: Math.floor(until / step) + 1 }, (_, i) => i * step);
  return (
    <figure class="compare-chart" data-testid="compare-chart">
      <figcaption>{t("compare.error")}</figcaption>
      <div class="compare-box">
        <svg viewBox={`0 0 ${WIDTH} ${HEIGHT}`} preserveAspectRatio="none" role="img" aria-label={t("compare.error")}>
          <path
            class="compare-grid"
            d={heights.map((m) => `M0 ${y(m)}H${WIDTH}`).join("") + minutes.map((s) => `M${x(s)} 0V${HEIGHT}`).join("")}
          />
          {lines.map((line, i) => (
            <path
              key={line.key}
              class={lineClass(i)}
              data-testid="compare-line"
              stroke-dasharray={DASHES[i % DASHES.length]}
              d={stepPath(line.points, x, y, missions.find((m) => m.mission_id === line.missionId)?.ended_s ?? until)}
            />
          ))}
        </svg>
        {heights.map((m) => (
          <span class="compare-height" style={{ top: `${(100 * y(m)) / HEIGHT}%` }} key={m}>
            {formatLength(m, units)}
          </span>
        ))}
        {minutes.map((s) => (
          <span class="compare-minute" style={{ left: `${(100 * s) / until}%` }} key={s}>
            {s / 60}
          </span>
        ))}
      </div>
      <p class="muted compare-axis">{t("compare.minutes")}</p>
      <ul class="compare-legend">
        {lines.map((line, i) => (
          <li key={line.key}>
            <svg viewBox="0 0 40 8" aria-hidden="true">
              <path class={lineClass(i)} d="M0 4H40" stroke-dasharray={DASHES[i % DASHES.length]} />
            </svg>
            {called(line, missions.length === 1)}
            {missions.length > 1 && line.variant && <span class="muted"> ({line.mission})</span>}
          </li>
        ))}
      </ul>
    </figure>
  );
}

function Row({ line, alone, ended, onDrop }: { line: Line; alone: boolean; ended: number | null; onDrop: () => void }) {
  const { units } = settings.value;
  const last = line.points.at(-1);
  const claimed = line.points.find((p) => p.localized);
  return (
    <tr data-testid="compare-row" data-variant={line.variant ?? ""}>
      <th scope="row">
        {line.variant === null ? <a href={missionAddress(line.missionId)}>{called(line, alone)}</a> : called(line, alone)}
      </th>
      <td class="number">{last?.bearings ?? "–"}</td>
      <td class="number">{claimed ? formatDuration(claimed.t_s) : t("compare.never")}</td>
      <td class="number">{line.variant === null && ended !== null ? formatDuration(ended) : "–"}</td>
      <td class="number">{last?.expected_rmse_m == null ? "–" : `±${formatLength(last.expected_rmse_m, units)}`}</td>
      <td class="number">{last?.c95_area_m2 == null ? "–" : formatArea(last.c95_area_m2, units)}</td>
      <td class="number">
        {last?.error_m == null ? "–" : `${formatLength(last.error_m, units)} ${t(last.inside ? "compare.inside" : "compare.outside")}`}
      </td>
      <td>
        {line.variant !== null && (
          <button type="button" class="small" data-testid="drop-variant" onClick={onDrop}>
            {t("compare.forget")}
          </button>
        )}
      </td>
    </tr>
  );
}

function Add({ shown }: { shown: readonly string[] }) {
  const [others, setOthers] = useState<readonly MissionSummary[]>([]);
  useEffect(() => {
    api.missions({}, null).then(
      (page) => setOthers(page.missions),
      () => setOthers([]),
    );
  }, []);
  const rest = others.filter((m) => m.bearings > 0 && !shown.includes(m.mission_id));
  if (rest.length === 0) return null;
  return (
    <label class="field-inline">
      {t("compare.add")}
      <select
        data-testid="compare-add"
        value=""
        onChange={(e) => {
          location.hash = `#/compare/${[...shown, e.currentTarget.value].map(encodeURIComponent).join("/")}`;
        }}
      >
        <option value="">{t("compare.choose")}</option>
        {rest.map((m) => (
          <option value={m.mission_id} key={m.mission_id}>
            {m.name} · {m.drafted_at_utc.slice(0, 10)}
          </option>
        ))}
      </select>
    </label>
  );
}

export function ComparePage({ route }: { route: Extract<Route, { page: "compare" }> }) {
  const [found, setFound] = useState<readonly MissionCourses[] | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [again, setAgain] = useState(0);
  const [chosen, setChosen] = useState<Readonly<Record<string, string>>>({});
  const ids = route.missionIds.join("/");
  useEffect(() => {
    let current = true;
    setProblem(null);
    Promise.all(route.missionIds.map((id) => courses(id, chosen[id]))).then(
      (all) => current && setFound(all),
      (error: unknown) => current && setProblem(asProblem(error)),
    );
    return () => {
      current = false;
    };
  }, [ids, again, chosen]);
  const lines = linesOf(found ?? []);
  const alone = route.missionIds.length === 1;
  const forget = (line: Line) =>
    dropVariant(line.missionId, line.variant ?? "").then(
      () => setAgain(again + 1),
      (error: unknown) => setProblem(asProblem(error)),
    );
  return (
    <div class="page" data-testid="compare" data-ready={found !== null}>
      <div class="page-head">
        <h1 class="grow">{t("compare.title")}</h1>
        <Add shown={route.missionIds} />
      </div>
      {problem && <ProblemBox problem={problem} />}
      {!found && !problem && <p class="muted">{t("missions.loading")}</p>}
      {found?.map((one) => (
        <EmitterChoice
          one={one}
          alone={alone}
          onChoose={(emitter) => setChosen({ ...chosen, [one.mission_id]: emitter })}
          key={one.mission_id}
        />
      ))}
      {found && (
        <>
          {lines.some((l) => l.points.length > 0) ? <Axes missions={found} lines={lines} /> : <p class="card">{t("compare.nothing")}</p>}
          {found.flatMap((m) =>
            m.courses
              .filter((c) => c.problem)
              .map((c) => (
                <p class="refused" key={`${m.mission_id}/${c.name}`}>
                  {c.name}: {c.problem && reasonText(c.problem)}
                </p>
              )),
          )}
          <div class="compare-scroll">
            <table class="table">
              <thead>
                <tr>
                  <th scope="col">{t("missions.name")}</th>
                  <th scope="col">{t("missions.bearings")}</th>
                  <th scope="col">{t("compare.localized")}</th>
                  <th scope="col">{t("compare.ended")}</th>
                  <th scope="col">{t("compare.expected")}</th>
                  <th scope="col">{t("compare.region")}</th>
                  <th scope="col">{t("compare.off")}</th>
                  <th scope="col">
                    <span class="visually-hidden">{t("compare.forget")}</span>
                  </th>
                </tr>
              </thead>
              <tbody>
                {lines.map((line) => (
                  <Row
                    line={line}
                    alone={alone}
                    ended={found.find((m) => m.mission_id === line.missionId)?.ended_s ?? null}
                    onDrop={() => void forget(line)}
                    key={line.key}
                  />
                ))}
              </tbody>
            </table>
          </div>
          <p class="muted">{t("compare.explain")}</p>
        </>
      )}
    </div>
  );
}
