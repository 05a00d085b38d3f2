// The one screen: map, estimate, bearing, next place, timeline; live and review alike.
import { signal } from "@preact/signals";
import type { ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";
import { proposal } from "../commands/proposal";
import { t } from "../i18n";
import { AlertBanner, bannerPx } from "../panels/AlertBanner";
import { AntennaCheck } from "../panels/AntennaCheck";
import { EstimatePanel } from "../panels/EstimatePanel";
import { ImportRecording } from "../panels/ImportRecording";
import { PlanPanel } from "../panels/PlanPanel";
import { PreflightPanel } from "../panels/PreflightPanel";
import { Scene } from "../panels/Scene";
import { SweepPanel } from "../panels/SweepPanel";
import { Timeline } from "../panels/Timeline";
import { TruthCard } from "../panels/TruthCard";
import { WaysCard } from "../panels/WaysCard";
import { type Card, chosenCard, drawersCard } from "../state/card";
import { live, source } from "../state/connection";
import { cursor, liveMission } from "../state/moment";
import { mission } from "../state/shown";
import "../style/review.css";
import "../style/sweep.css";
import "../style/what-if.css";

const GAP_PX = 8;

/** The 3D scene instead of the map. */
const scene = signal(false);

/** While the flight's facts can be stored nowhere they are not shown either: what the page says stands still. */
function NotStored() {
  const status = live.value.status?.value;
  if (status?.database !== "unstored" || status.mission_id !== mission.value.missionId) return null;
  return (
    <div class="banner caution unstored" role="alert" data-testid="unstored">
      <span>
        <strong>{t("fly.unstored")}</strong> {t("fly.unstoredMeanwhile")}
      </span>
      <a class="button" href="#/health">
        {t("health.title")}
      </a>
    </div>
  );
}

function MapArea() {
  const [state, setState] = useState<"loading" | "none" | { Map: ComponentType }>("loading");
  useEffect(() => {
    void import("../map/createMap").then(
      async ({ hasWebgl }) => {
        if (!hasWebgl()) setState("none");
        else {
          const { FlyMap } = await import("../map/FlyMap");
          setState({ Map: FlyMap });
        }
      },
      () => setState("none"),
    );
  }, []);
  return (
    <div class="map-area" data-tour="2" style={{ "--banner": bannerPx.value === 0 ? "0px" : `${bannerPx.value + GAP_PX}px` }}>
      {state === "loading" && <p class="center muted">{t("map.loading")}</p>}
      {state === "none" && <p class="center">{t("map.noWebgl")}</p>}
      {typeof state === "object" && (scene.value ? <Scene /> : <state.Map />)}
      {typeof state === "object" && source.value?.keptByServer && (
        <button
          type="button"
          class="scene-switch"
          data-testid="scene-switch"
          aria-pressed={scene.value}
          onClick={() => (scene.value = !scene.value)}
        >
          {t(scene.value ? "scene.map" : "scene.show")}
        </button>
      )}
      <AlertBanner />
      <NotStored />
    </div>
  );
}

/** For a phone, which has room for one card: which one. */
function Cards({ cards, shown }: { cards: readonly Card[]; shown: Card }) {
  return (
    <nav class="card-tabs" aria-label={t("cards.label")}>
      {cards.map((card) => (
        <button
          type="button"
          key={card}
          data-testid={`card-${card}`}
          aria-pressed={card === shown}
          onClick={() => (chosenCard.value = card)}
        >
          {t(`cards.${card}`)}
        </button>
      ))}
    </nav>
  );
}

const RESULTS: readonly Card[] = ["estimate", "sweep", "truth"];

export function FlyPage() {
  const { missionId, bearings, rejected } = mission.value;
  const planned = drawersCard(liveMission.value.phase) === "checks";
  const before = planned && cursor.value === null && source.value?.takesCommands;
  const heard = bearings.length + rejected.length > 0;
  const flown: Card[] = before ? [] : ["plan"];
  const cards: Card[] = [...(before ? (["checks"] as const) : []), ...(heard || !before ? RESULTS : []), ...flown, "events"];
  const isProposed = proposal.value !== null;
  useEffect(() => {
    if (isProposed) chosenCard.value = "plan";
  }, [isProposed]);
  const shown = cards.includes(chosenCard.value) ? chosenCard.value : cards[0]!;
  return (
    <div class="fly" data-testid="fly" data-card={shown}>
      <MapArea />
      <Cards cards={cards} shown={shown} />
      <aside class="side" key={missionId}>
        {before && missionId && <PreflightPanel missionId={missionId} />}
        {(!before || heard) && (
          <>
            <EstimatePanel />
            <SweepPanel />
          </>
        )}
        {!before && <PlanPanel />}
        <TruthCard />
        <div class="drawers">
          {planned && missionId && <AntennaCheck missionId={missionId} />}
          <ImportRecording />
          {planned && missionId && <WaysCard missionId={missionId} />}
        </div>
      </aside>
      <Timeline key={missionId} />
    </div>
  );
}
