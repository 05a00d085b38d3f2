// The search area of a mission in flight: drawn again while it holds, judged by the planner, changed by a slide.
import { useEffect, useRef, useState } from "preact/hooks";
import { SlideToConfirm } from "../commands/SlideToConfirm";
import { asProblem, send } from "../commands/send";
import { AreaSection } from "../edit/AreaSection";
import { watchCoverage } from "../edit/coverage";
import { begin, draft, isStored, isUnread, storedDraft, update } from "../edit/draft";
import { discard, replaces, settledDraft, tool } from "../edit/drawing";
import { NotStored } from "../edit/NotStored";
import { OutlookCard } from "../edit/OutlookCard";
import { askOutlook, clearOutlook, forgetOutlookOfOthers, outlook } from "../edit/outlook";
import { Told } from "../edit/Told";
import { t } from "../i18n";
import { ProblemBox, ProblemNote } from "../panels/ProblemNote";
import * as api from "../sources/api";
import { go, missionAddress, type Route, route } from "../state/route";
import { mission } from "../state/shown";
import type { MissionSpec, Problem } from "../wire";
import { EditMapArea } from "./EditMapArea";

type AreaRoute = Extract<Route, { page: "area" }>;

export const AreaPage = ({ route: { missionId: id } }: { route: AreaRoute }) => <Changed id={id} key={id} />;

function Changed({ id }: { id: string }) {
  const key = `area:${id}`;
  const [problem, setProblem] = useState<Problem | null>(null);
  const [told, setTold] = useState<readonly string[]>([]);

  const isLeft = useRef(false);

  const read = () => {
    setProblem(null);
    api.mission(id).then(
      ({ spec }) => {
        if (!isLeft.current) begin({ key, spec: spec as MissionSpec, hasArea: true, suggested: false, text: {} });
      },
      // nothing has been typed that the remedy could say is not lost
      (error: unknown) => setProblem({ ...asProblem(error), remedy: "" }),
    );
  };

  useEffect(() => {
    replaces.value = false;
    draft.value = null;
    const kept = storedDraft(key);
    if (kept) update(kept);
    else read();
    const leave = () => {
      isLeft.current = true;
      tool.value = "none"; // corners that were moved are kept
      draft.value = null;
    };
    const stops = [leave, watchCoverage(), forgetOutlookOfOthers(), clearOutlook];
    return () => {
      for (const stop of stops) stop();
    };
  }, []);

  const leave = () => {
    discard(key);
    const now = route.peek();
    if (now.page === "area" && now.missionId === id) go(missionAddress(id));
  };
  const ask = () => {
    setProblem(null);
    settledDraft().then(
      (settled) => settled && askOutlook(id, settled.spec),
      (error: unknown) => setProblem(asProblem(error)),
    );
  };
  const judged = outlook.value;
  const isAsking = judged !== null && !judged.found && !judged.problem;
  const isHere = draft.value?.key === key;
  const isReadable = draft.value?.hasArea && !isUnread(draft.value);
  const { phase, ended } = mission.value;
  const held = phase === "hold" && ended === null;
  const isDraft = phase === "draft" || phase === "ready";
  return (
    <div class="edit" data-testid="area-page">
      <EditMapArea onTold={setTold} />
      <div class="side">
        <div class="panel edit-head">
          <h1>{t("area.change")}</h1>
        </div>
        <div class="edit-scroll">
          {isHere && (
            <>
              {!ended && (
                <p class="panel" data-testid="area-what">
                  {t(isDraft ? "area.notStarted" : "area.what")}
                </p>
              )}
              <AreaSection failed={judged?.failed ?? null} told={told} onTold={setTold} />
            </>
          )}
        </div>
        <Told news={problem ?? judged}>
          {isHere && !isStored.value && <NotStored />}
          {problem && <ProblemBox problem={problem} testId="area-problem" />}
          {judged && <OutlookCard judged={judged} />}
          {isHere && !isDraft && !held && (
            <p role="status" data-testid="area-not-held">
              <strong>{t(ended ? "area.over" : "area.notHeld")}</strong>
            </p>
          )}
          <ProblemNote desk="area" />
        </Told>
        <div class="panel edit-foot">
          {judged?.found?.allowed && held ? (
            <SlideToConfirm
              label={t("area.slide")}
              testId="area-slider"
              expiresS={60}
              onCancel={clearOutlook}
              onConfirm={() => send("area", id, { kind: "change_area", search: judged.search }).then((accepted) => accepted && leave())}
            />
          ) : (
            <div class="start-row">
              <button type="button" data-testid="area-cancel" onClick={leave}>
                {t("area.keep")}
              </button>
              {problem && !isHere && (
                <button type="button" class="primary" data-testid="area-again" onClick={read}>
                  {t("app.reload")}
                </button>
              )}
              {isHere && !judged?.found && (
                <button type="button" class="primary" data-testid="outlook-ask" disabled={isAsking || !isReadable} onClick={ask}>
                  {t(isAsking ? "area.asking" : "area.ask")}
                </button>
              )}
            </div>
          )}
        </div>
      </div>
    </div>
  );
}
