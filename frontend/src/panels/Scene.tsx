// The 3D scene in the place of the map: the server draws it, it follows the live mission and the review.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { showScene } from "../sources/sceneApi";
import { momentSeq } from "../state/moment";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import type { Problem } from "../wire";
import { ProblemBox } from "./ProblemNote";

/** One view a tab. */
const VIEW_ID = Array.from(crypto.getRandomValues(new Uint8Array(12)), (b) => b.toString(16).padStart(2, "0")).join("");

/** Scrubbing asks for every step; a step is only sent when the hand rests this long. */
const REST_MS = 60;

export function Scene() {
  const [shown, setShown] = useState<string | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const id = mission.value.missionId;
  const seq = momentSeq.value;
  const theme = settings.value.theme === "indoor" ? "dark" : "light";
  useEffect(() => {
    const timer = setTimeout(() => {
      showScene(VIEW_ID, { mission_id: id, seq, theme, hidden: [], belief_height_m: null }).then(
        (view) => {
          setShown(view.url);
          setProblem(null);
        },
        (error: unknown) => setProblem(asProblem(error)),
      );
    }, REST_MS);
    return () => clearTimeout(timer);
  }, [id, seq, theme]);
  if (problem) {
    return (
      <div class="center">
        <ProblemBox problem={problem} />
      </div>
    );
  }
  if (!shown) return <p class="center muted">{t("scene.loading")}</p>;
  return <iframe class="scene" src={shown} title={t("scene.title")} data-testid="scene" />;
}
