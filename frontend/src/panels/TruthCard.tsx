// "Found here", "not found": the truth about the emitter looked at, and how right the estimate was.
import { useState } from "preact/hooks";
import { tapping, tell, tellHere } from "../commands/truth";
import { t } from "../i18n";
import { chosenCard } from "../state/card";
import { source } from "../state/connection";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { judge } from "../state/truth";
import { formatPlace } from "../units/coordinates";
import { parsePlace } from "../units/parsePlace";
import { formatLength } from "../units/quantities";
import { ProblemNote } from "./ProblemNote";

function Told() {
  const { truth, belief } = mission.value;
  if (!truth) return null;
  const { place, accuracy_m: accuracy } = truth.fact;
  if (place === null) return <p data-testid="truth-told">{t("truth.notFound")}</p>;
  const units = settings.value.units;
  const estimate = belief && belief.fact.bearings > 0 ? belief.fact.estimate : null;
  const judged = estimate ? judge(estimate, place) : null;
  return (
    <>
      <p data-testid="truth-told">
        {t("truth.at", { place: formatPlace(place, settings.value.coordinates) })}
        {accuracy !== null && <span class="muted"> ±{formatLength(accuracy, units)}</span>}
      </p>
      {judged && estimate && (
        <p data-testid="truth-error" data-error={judged.errorM} data-inside={judged.inside}>
          <strong>{t("truth.error", { error: formatLength(judged.errorM, units) })}</strong>{" "}
          <span class="muted">
            {t(judged.inside ? "truth.inside" : "truth.outside", { stated: formatLength(estimate.expected_rmse_m, units) })}
          </span>
        </p>
      )}
    </>
  );
}

function Written({ onDone }: { onDone: () => void }) {
  const [text, setText] = useState("");
  const place = parsePlace(text);
  return (
    <div class="area-row">
      <input
        data-testid="truth-place"
        aria-label={t("truth.place")}
        placeholder="50.73400 N 7.09800 E"
        value={text}
        onInput={(e) => setText(e.currentTarget.value)}
      />
      <button
        type="button"
        data-testid="truth-set"
        disabled={!place}
        onClick={() => void tell(place, "typed").then((taken) => taken && onDone())}
      >
        {t("truth.set")}
      </button>
    </div>
  );
}

export function TruthCard() {
  const [writing, setWriting] = useState(false);
  const [refused, setRefused] = useState(false);
  const { startedAt, bearings, truth, missionId } = mission.value;
  if (!source.value?.keptByServer || missionId === null || (startedAt === null && bearings.length === 0)) return null;
  return (
    <section class="panel truth" data-testid="truth" aria-label={t("truth.title")}>
      <details open={truth !== null || tapping.value || chosenCard.value === "truth"}>
        <summary>{t("truth.title")}</summary>
        <Told />
        <ProblemNote desk="truth" />
        <div class="truth-ways">
          <button type="button" data-testid="truth-tap" aria-pressed={tapping.value} onClick={() => (tapping.value = !tapping.value)}>
            {t(tapping.value ? "truth.tapping" : "truth.tap")}
          </button>
          <button type="button" data-testid="truth-here" onClick={() => void tellHere().then((told) => setRefused(!told))}>
            {t("truth.here")}
          </button>
          <button type="button" data-testid="truth-write" aria-expanded={writing} onClick={() => setWriting(!writing)}>
            {t("truth.write")}
          </button>
          <button type="button" data-testid="truth-not-found" onClick={() => void tell(null, "map")}>
            {t("truth.nowhere")}
          </button>
        </div>
        {refused && <p class="refused">{t("truth.noPosition")}</p>}
        {writing && <Written onDone={() => setWriting(false)} />}
      </details>
    </section>
  );
}
