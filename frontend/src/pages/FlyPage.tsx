// The one screen: map, estimate, bearing, next place, timeline; live and review alike.
import { signal } from "@preact/signals";
import type { ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";
import { t } from "../i18n";
import { AlertBanner, bannerPx } from "../panels/AlertsButton";
import { AntennaCheck } from "../panels/AntennaCheck";
import { EstimatePanel } from "../panels/EstimatePanel";
import { ImportRecording } from "../panels/ImportRecording";
import { PlanPanel } from "../panels/PlanPanel";
import { PreflightPanel } from "../panels/PreflightPanel";
import { Scene } from "../panels/Scene";
import { SweepPanel } from "../panels/SweepPanel";
import { Timeline } from "../panels/Timeline";
import { TruthCard } from "../panels/TruthCard";
import { source } from "../state/connection";
import { mission } from "../state/shown";
import "../style/review.css";

const GAP_PX = 8;

/** The 3D scene instead of the map. */
const scene = signal(false);

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
    </div>
  );
}

export function FlyPage() {
  const { phase, missionId, bearings, rejected } = mission.value;
  const before = phase === "draft" || phase === "ready";
  const heard = bearings.length + rejected.length > 0;
  return (
    <div class="fly" data-testid="fly">
      <MapArea />
      <aside class="side">
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
          {before && missionId && <AntennaCheck missionId={missionId} />}
          <ImportRecording />
        </div>
      </aside>
      <Timeline />
    </div>
  );
}
