// Before the start: the antenna turned by hand before a known emitter. The result stands in the checklist.
import { signal } from "@preact/signals";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import * as api from "../sources/api";
import { localProblem } from "../sources/problem";
import { source } from "../state/connection";
import { parsePlace } from "../units/parsePlace";
import type { Place, Problem } from "../wire";
import { runPreflight } from "./PreflightPanel";
import { ProblemBox } from "./ProblemNote";

const listening = signal(false);
const problem = signal<Problem | null>(null);

/** A bearing in degrees or a place; null when it is neither. */
export function knownEmitter(text: string): { place: Place } | { bearing_deg: number } | null {
  if (/^\s*\d{1,3}([.,]\d+)?\s*°?\s*$/.test(text)) {
    const bearing = Number.parseFloat(text.replace(",", "."));
    return bearing <= 360 ? { bearing_deg: bearing % 360 } : null;
  }
  const place = parsePlace(text);
  return place && { place };
}

async function listen(missionId: string, text: string): Promise<void> {
  const emitter = knownEmitter(text);
  if (!emitter) {
    problem.value = localProblem(t("antenna.title"), t("antenna.bad"));
    return;
  }
  problem.value = null;
  listening.value = true;
  try {
    await api.checkAntenna(missionId, emitter);
    await runPreflight(missionId);
  } catch (error) {
    problem.value = asProblem(error);
  } finally {
    listening.value = false;
  }
}

export function AntennaCheck({ missionId }: { missionId: string }) {
  if (!source.value?.keptByServer) return null;
  return (
    <section class="panel" data-testid="antenna" aria-label={t("antenna.title")}>
      <details>
        <summary class="button">{t("antenna.title")}</summary>
        <form
          class="recording"
          onSubmit={(e) => {
            e.preventDefault();
            void listen(missionId, String(new FormData(e.currentTarget).get("emitter") ?? ""));
          }}
        >
          <p class="muted">{t("antenna.explain")}</p>
          <label>
            {t("antenna.emitter")}
            <input name="emitter" placeholder="120" data-testid="antenna-emitter" />
          </label>
          <button type="submit" class="primary" disabled={listening.value} data-testid="antenna-listen">
            {t(listening.value ? "antenna.listening" : "antenna.listen")}
          </button>
        </form>
        {problem.value && <ProblemBox problem={problem.value} testId="antenna-problem" />}
      </details>
    </section>
  );
}
