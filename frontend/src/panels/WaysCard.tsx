// Roads, paths and barriers of a mission: shown, replaced by an upload, taken away.
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { reasonText, t } from "../i18n";
import { forgetWays, waysPath } from "../sources/waysApi";
import { settings } from "../state/settings";
import { ways, waysChanged } from "../state/ways";
import { formatLength } from "../units/quantities";
import type { Problem } from "../wire";
import { ProblemBox } from "./ProblemNote";
import { Upload } from "./Upload";

export function WaysCard({ missionId }: { missionId: string }) {
  const [problem, setProblem] = useState<Problem | null>(null);
  const known = ways.value;
  if (!known) return null;
  const { units } = settings.value;
  const change = () => void waysChanged(missionId);
  return (
    <section class="panel ways" data-testid="ways" data-known={known.features.length > 0} aria-label={t("ways.title")}>
      <details>
        <summary class="button">{t("ways.title")}</summary>
        <p class="muted lines">{t("ways.explain")}</p>
        <p data-testid="ways-known">
          {known.features.length > 0
            ? t("ways.known", {
                roads: formatLength(known.roads_m, units),
                paths: formatLength(known.paths_m, units),
                barriers: known.barriers,
                name: known.name ?? "",
              })
            : t("ways.none")}
        </p>
        {known.notes.length > 0 && (
          <ul class="remarks" data-testid="ways-notes">
            {known.notes.map((note, i) => (
              <li key={i}>{reasonText(note)}</li>
            ))}
          </ul>
        )}
        <div class="ways-do">
          <Upload
            path={waysPath(missionId)}
            testId="ways-upload"
            accept=".geojson,.json,.kml,.kmz"
            label={t("ways.upload")}
            primary={false}
            onDone={change}
            onProblem={setProblem}
          />
          {known.features.length > 0 && (
            <button
              type="button"
              data-testid="ways-remove"
              onClick={() => forgetWays(missionId).then(change, (error: unknown) => setProblem(asProblem(error)))}
            >
              {t("maps.remove")}
            </button>
          )}
        </div>
      </details>
      {problem && <ProblemBox problem={problem} testId="ways-problem" />}
    </section>
  );
}
