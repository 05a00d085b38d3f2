// All missions on a map and as a list, newest first: open, use again, take away; the first one invites.
import type { ComponentChildren, ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { draftSuggested } from "../commands/suggested";
import { t } from "../i18n";
import { LabelForm } from "../panels/LabelForm";
import { LibraryFilter } from "../panels/LibraryFilter";
import { MiniMap } from "../panels/MiniMap";
import { ProblemBox, problemWords } from "../panels/ProblemNote";
import { useTeller } from "../panels/Upload";
import * as api from "../sources/api";
import { readRecording } from "../sources/replay";
import { replays } from "../sources/replays";
import { upload } from "../sources/upload";
import { ANY, asQuery, type Filter, type Library, withFirstPage, withNextPage } from "../state/library";
import { isOver } from "../state/mission";
import { go, missionAddress, route } from "../state/route";
import { me } from "../state/session";
import { change, settings } from "../state/settings";
import { toneOfMission } from "../state/tone";
import { phaseName } from "../state/words";
import { formatDuration, formatNumber } from "../units/quantities";
import type { MissionBrought, MissionSummary, Problem } from "../wire";
import "../style/library.css";
import "../style/review.css";

const REFRESH_MS = 5000;
/** Until a name that is being typed is asked for. */
const TYPING_MS = 250;

/** What each is called where it is opened; null: everything in one file. */
const FORMATS: readonly [api.ExportFormat, string | null][] = [
  ["bundle", null],
  ["geojson", "GeoJSON"],
  ["kml", "KML"],
  ["csv", "CSV"],
  ["mcap", "MCAP"],
  ["cot", "TAK"],
  ["json", "JSON"],
];

function Export({ mission: { mission_id: id, iq_bytes } }: { mission: MissionSummary }) {
  return (
    <details class="export">
      <summary class="button">{t("missions.export")}</summary>
      <div class="export-list">
        {FORMATS.map(([format, name]) => (
          <a class="button" href={api.exportAddress(id, format)} download data-testid={`export-${format}`} key={format}>
            {name ?? t("missions.exportAll")}
          </a>
        ))}
        {iq_bytes > 0 ? (
          <a class="button" href={api.exportAddress(id, "sigmf")} download data-testid="export-sigmf">
            {t("missions.exportIq", { size: formatNumber(iq_bytes / 1e6, 1) })}
          </a>
        ) : (
          <span class="muted">{t("missions.noIq")}</span>
        )}
      </div>
    </details>
  );
}

interface RowProperties {
  mission: MissionSummary;
  editing: boolean;
  onEdit: (id: string | null) => void;
  onChanged: () => void;
}

function Row({ mission, editing, onEdit, onChanged }: RowProperties) {
  const changed = () => {
    onEdit(null);
    onChanged();
  };
  return (
    <tr data-testid="mission-row" data-mission={mission.mission_id} data-phase={mission.phase}>
      <td>
        <MiniMap sketch={mission.sketch} />
      </td>
      <td>
        <a href={missionAddress(mission.mission_id)}>
          <strong>{mission.name}</strong>
        </a>
        {mission.tags.map((tag) => (
          <span class="label" key={tag}>
            {tag}
          </span>
        ))}
        {mission.notes && <p class="muted notes">{mission.notes}</p>}
        {mission.gone_at_utc && (
          <p class="muted" data-testid="gone-at">
            {t("missions.goneAt", { date: mission.gone_at_utc.slice(0, 10) })}
          </p>
        )}
        {editing && <LabelForm mission={mission} onDone={changed} />}
      </td>
      <td>
        <span class={`tag tone-${toneOfMission(mission.phase, mission.outcome)}`}>
          {mission.outcome ? t(`outcome.${mission.outcome}`) : phaseName(mission.phase)}
        </span>
      </td>
      <td class="number">{mission.drafted_at_utc.slice(0, 16).replace("T", " ")}</td>
      <td class="number" data-label={mission.mission_time_s === null ? undefined : t("missions.time")}>
        {mission.mission_time_s !== null && formatDuration(mission.mission_time_s)}
      </td>
      <td class="number" data-label={t("missions.bearings")}>
        {mission.bearings}
        {mission.rejected_sweeps > 0 && <span class="muted"> ({t("missions.rejected", { count: mission.rejected_sweeps })})</span>}
      </td>
      <td>
        <div class="row-actions">
          <a class="button" href={missionAddress(mission.mission_id)} data-testid="open-mission">
            {t("missions.open")}
          </a>
          <a class="button" href={`#/new/${encodeURIComponent(mission.mission_id)}`}>
            {t("missions.copy")}
          </a>
          {(isOver(mission.phase) || mission.iq_bytes > 0) && <Export mission={mission} />}
          {isOver(mission.phase) && (
            <a class="button" href={`#/report/${encodeURIComponent(mission.mission_id)}`} data-testid="open-report">
              {t("missions.report")}
            </a>
          )}
          {mission.bearings > 0 && (
            <a class="button" href={`#/compare/${encodeURIComponent(mission.mission_id)}`} data-testid="compare-mission">
              {t("missions.compare")}
            </a>
          )}
          <button type="button" data-testid="label-mission" onClick={() => onEdit(editing ? null : mission.mission_id)}>
            {t("missions.label")}
          </button>
        </div>
      </td>
    </tr>
  );
}

const isHere = () => route.peek().page === "missions";

/** Nobody is led away from a page that they went to meanwhile. */
function goIfHere(address: string): void {
  if (isHere()) go(address);
}

/** What the server has, no recording hides any more. */
const forgetRecordings = (of: readonly Pick<MissionSummary, "mission_id">[]) => {
  for (const { mission_id } of of) replays.delete(mission_id);
};

const BUNDLES = "/bundles";

/** The bundle of another installation, as a mission of this one. */
function BringIn({ onProblem }: { onProblem: (problem: Problem | null) => void }) {
  const [share, setShare] = useState<number | null>(null);
  const tell = useTeller(BUNDLES, onProblem);
  const bring = async (file: File) => {
    onProblem(null);
    setShare(0);
    try {
      const brought = await upload<MissionBrought>(BUNDLES, file, setShare, "application/zip");
      forgetRecordings([brought]);
      goIfHere(missionAddress(brought.mission_id));
    } catch (error) {
      tell(asProblem(error));
      setShare(null);
    }
  };
  return (
    <label class="button">
      {share === null ? t("missions.bringIn") : t("missions.bringingIn", { percent: Math.round(100 * share) })}
      <input
        class="visually-hidden"
        type="file"
        accept=".zip,application/zip"
        data-testid="bring-in"
        disabled={share !== null}
        onChange={(e) => {
          const file = e.currentTarget.files?.[0];
          if (file) void bring(file);
          e.currentTarget.value = "";
        }}
      />
    </label>
  );
}

function OpenRecording({ onProblem }: { onProblem: (text: string) => void }) {
  return (
    <label class="button">
      {t("missions.openFile")}
      <input
        class="visually-hidden"
        type="file"
        accept=".json,application/json"
        onChange={(e) => {
          const file = e.currentTarget.files?.[0];
          e.currentTarget.value = ""; // a file that was mended can be chosen again
          if (!file) return;
          const opened = file.text().then((text) => readRecording(text));
          opened.then(
            (recording) => {
              if (!isHere()) return;
              replays.set(recording.missionId, recording);
              go(missionAddress(recording.missionId));
            },
            (error: unknown) => onProblem(t("missions.recordingBroken", { name: file.name, reason: problemWords(asProblem(error)) })),
          );
        }}
      />
    </label>
  );
}

/** The list of missions with this part in their name, kept current, at once after each of `changes`; `more` reads the page that follows. */
function useLibrary(filter: Filter, changes: number) {
  const asked = asQuery(filter);
  const named = JSON.stringify(asked);
  const [library, setLibrary] = useState<Library | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    let current = true;
    const read = () =>
      api.missions(asked, null).then(
        (page) => {
          if (!current) return;
          forgetRecordings(page.missions);
          setLibrary((before) => withFirstPage(before, named, page));
          setProblem(null);
        },
        (error: unknown) => current && setProblem(asProblem(error)),
      );
    const first = setTimeout(() => void read(), filter === ANY ? 0 : TYPING_MS);
    const timer = setInterval(() => void read(), REFRESH_MS);
    return () => {
      current = false;
      clearTimeout(first);
      clearInterval(timer);
    };
  }, [named, changes]);
  const more = (from: Library) =>
    api.missions(JSON.parse(from.named) as Record<string, string>, from.next).then(
      (page) => {
        forgetRecordings(page.missions);
        setLibrary((now) => (now?.named === from.named ? withNextPage(now, page) : now));
      },
      (error: unknown) => setProblem(asProblem(error)),
    );
  return { library, problem, more };
}

/** The missions on a map, loaded when the list is there; nothing where maps cannot be drawn. */
function Place({ missions }: { missions: readonly MissionSummary[] }) {
  const [Drawn, setDrawn] = useState<ComponentType<{ missions: readonly MissionSummary[] }> | null>(null);
  useEffect(() => {
    void import("../map/createMap").then(
      async ({ hasWebgl }) => {
        if (!hasWebgl()) return;
        const { LibraryMap } = await import("../map/LibraryMap");
        setDrawn(() => LibraryMap);
      },
      () => undefined,
    );
  }, []);
  return <div class="library-place">{Drawn && <Drawn missions={missions} />}</div>;
}

/** What a first visitor may do, each with what it is good for. */
function Welcome({ children, onProblem }: { children: ComponentChildren; onProblem: (problem: Problem) => void }) {
  const [drafting, setDrafting] = useState(false);
  const draftOne = async () => {
    setDrafting(true);
    await draftSuggested().then(goIfHere, (error: unknown) => onProblem(asProblem(error)));
    setDrafting(false);
  };
  return (
    <div class="welcome" data-testid="welcome">
      <h2>{t("missions.welcome")}</h2>
      <a class="welcome-way" href="?tour#/mission/example" data-testid="tour-take">
        <strong>{t("missions.welcome.example")}</strong>
        <span>{t("tour.offer")}</span>
      </a>
      <a class="welcome-way" href="#/new" data-testid="welcome-new">
        <strong>{t("missions.welcome.plan")}</strong>
        <span>{t("missions.welcome.planHint")}</span>
      </a>
      {me.value?.role !== "viewer" && (
        <button type="button" class="welcome-way" data-testid="welcome-suggested" disabled={drafting} onClick={draftOne}>
          <strong>{t("missions.welcome.suggested")}</strong>
          <span>{t("missions.welcome.suggestedHint")}</span>
        </button>
      )}
      <div class="welcome-way">
        <span>{t("missions.welcome.bring")}</span>
        <div class="row-actions">{children}</div>
      </div>
    </div>
  );
}

export function MissionsPage() {
  const [broken, setBroken] = useState<string | null>(null);
  const [filter, setFilter] = useState<Filter>(ANY);
  const [editing, setEditing] = useState<string | null>(null);
  const [refused, setRefused] = useState<Problem | null>(null);
  const [changes, setChanges] = useState(0);
  const { library, problem, more } = useLibrary(filter, changes);
  const shown = library?.missions;
  const isEmpty = shown?.length === 0 && filter === ANY;
  const bringing = (
    <>
      <OpenRecording onProblem={setBroken} />
      <BringIn onProblem={setRefused} />
    </>
  );
  return (
    <div class="library" data-testid="missions">
      <section class="library-list">
        <div class="page-head">
          <h1>{t("missions.title")}</h1>
          <a class="button primary" href="#/new" data-testid="new-mission">
            {t("menu.new")}
          </a>
        </div>
        {!isEmpty && (
          <>
            <div class="library-tools">
              <input
                type="search"
                placeholder={t("missions.search")}
                aria-label={t("missions.search")}
                value={filter.named}
                onInput={(e) => setFilter({ ...filter, named: e.currentTarget.value })}
              />
              {bringing}
            </div>
            <LibraryFilter filter={filter} missions={shown ?? []} onChange={setFilter} />
          </>
        )}
        {!isEmpty && !settings.value.tourSeen && (
          <div class="tour-offer" data-testid="tour-offer">
            <span class="grow">{t("tour.offer")}</span>
            <button type="button" onClick={() => change("tourSeen", true)}>
              {t("tour.later")}
            </button>
            <a class="button primary" href="?tour#/mission/example" data-testid="tour-take">
              {t("tour.take")}
            </a>
          </div>
        )}
        {broken && (
          <p class="refused" role="alert">
            {broken}
          </p>
        )}
        {refused && <ProblemBox problem={refused} />}
        {problem && <ProblemBox problem={problem} />}
        {!library && !problem && <p class="muted">{t("missions.loading")}</p>}
        {isEmpty && <Welcome onProblem={setRefused}>{bringing}</Welcome>}
        {shown?.length === 0 && !isEmpty && <p>{t("missions.noneNamed")}</p>}
        {shown && shown.length > 0 && (
          <table class="table library-table">
            <thead class="visually-hidden">
              <tr>
                <th scope="col">{t("missions.map")}</th>
                <th scope="col">{t("missions.name")}</th>
                <th scope="col">{t("missions.state")}</th>
                <th scope="col">{t("missions.drafted")}</th>
                <th scope="col">{t("missions.time")}</th>
                <th scope="col">{t("missions.bearings")}</th>
                <th scope="col">{t("missions.open")}</th>
              </tr>
            </thead>
            <tbody>
              {shown.map((mission) => (
                <Row
                  mission={mission}
                  editing={editing === mission.mission_id}
                  onEdit={setEditing}
                  onChanged={() => setChanges((before) => before + 1)}
                  key={mission.mission_id}
                />
              ))}
            </tbody>
          </table>
        )}
        {library?.next && (
          <button type="button" data-testid="more-missions" onClick={() => void more(library)}>
            {t("missions.more")}
          </button>
        )}
      </section>
      {shown && <Place missions={shown} />}
    </div>
  );
}
