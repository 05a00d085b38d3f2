// Recorded sweeps into a mission that does not fly: files, where and when when they do not tell, and what came of it.
import { signal } from "@preact/signals";
import { mission, source } from "../app/store";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import * as api from "../sources/api";
import { inFlight } from "../state/mission";
import { parsePlace } from "../units/coordinates";
import { formatBearing, formatNumber } from "../units/quantities";
import type { Problem, RecordingImport } from "../wire";
import { ProblemText } from "./ProblemNote";

type Outcome = { missionId: string } & ({ found: RecordingImport } | { problem: Problem } | { busy: true });

const outcome = signal<Outcome | null>(null);

/** The form's fields as the server wants them; a sentence when one cannot be read. */
export function recordingForm(files: readonly File[], place: string, at: string): FormData | string {
  if (files.length === 0) return t("recording.noFile");
  const form = new FormData();
  for (const file of files) form.append("files", file, file.name);
  if (place.trim()) {
    const read = parsePlace(place);
    if (!read) return t("recording.badPlace");
    form.append("lat", String(read.lat));
    form.append("lon", String(read.lon));
  }
  // the input has no time zone: UTC is what its label says
  if (at) form.append("at_utc", `${at}Z`);
  return form;
}

async function submit(missionId: string, element: HTMLFormElement): Promise<void> {
  const given = new FormData(element);
  const files = given.getAll("files").filter((entry): entry is File => entry instanceof File && entry.size > 0);
  const form = recordingForm(files, String(given.get("place") ?? ""), String(given.get("at") ?? ""));
  if (typeof form === "string") {
    outcome.value = { missionId, problem: { type: "about:blank", title: t("recording.title"), status: 0, detail: form, remedy: "", errors: [], incident: null } };
    return;
  }
  outcome.value = { missionId, busy: true };
  try {
    outcome.value = { missionId, found: await api.importRecording(missionId, form) };
    element.reset();
  } catch (error) {
    outcome.value = { missionId, problem: asProblem(error) };
  }
}

function Found({ found }: { found: RecordingImport }) {
  return (
    <div role="status" data-testid="recording-found">
      {found.already && <p>{t("recording.already")}</p>}
      <ul class="remarks">
        {found.sweeps.map((sweep) => (
          <li key={sweep.sweep_id}>
            <strong>{t("sweep.place", { number: sweep.place_number })}</strong>{" "}
            {sweep.bearing_deg !== null && sweep.sigma_deg !== null
              ? t("sweep.bearing", { bearing: formatBearing(sweep.bearing_deg), sigma: formatNumber(sweep.sigma_deg, 1) })
              : t("sweep.rejected", { reason: sweep.reason })}
            , {t("sweep.quality", { quality: formatNumber(sweep.quality, 2) })}
          </li>
        ))}
      </ul>
      {found.remarks.length > 0 && (
        <>
          <p>{t("recording.remarks", { count: found.remarks.length })}</p>
          <ul class="remarks" data-testid="recording-remarks">
            {found.remarks.map((remark) => (
              <li key={remark}>{remark}</li>
            ))}
          </ul>
        </>
      )}
    </div>
  );
}

export function ImportRecording() {
  const { missionId, phase } = mission.value;
  if (!missionId || inFlight(phase) || source.value?.kind !== "live") return null;
  const now = outcome.value?.missionId === missionId ? outcome.value : null;
  const busy = now !== null && "busy" in now;
  return (
    <section class="panel" data-testid="recording" aria-label={t("recording.title")}>
      <details open={now !== null}>
        <summary class="button">{t("recording.title")}</summary>
        <form
          class="recording"
          onSubmit={(e) => {
            e.preventDefault();
            void submit(missionId, e.currentTarget);
          }}
        >
          <p class="muted">{t("recording.explain")}</p>
          <label>
            {t("recording.files")}
            <input type="file" name="files" multiple data-testid="recording-files" />
          </label>
          <label>
            {t("recording.place")}
            <input name="place" placeholder="50.6123, 7.2046" data-testid="recording-place" />
          </label>
          <label>
            {t("recording.at")}
            <input type="datetime-local" name="at" step={1} data-testid="recording-at" />
          </label>
          <button class="primary" disabled={busy} data-testid="recording-send">
            {t(busy ? "recording.busy" : "recording.send")}
          </button>
        </form>
        {now && "found" in now && <Found found={now.found} />}
        {now && "problem" in now && (
          <div class="problem" role="alert" data-testid="recording-problem">
            <div>
              <ProblemText problem={now.problem} />
            </div>
          </div>
        )}
      </details>
    </section>
  );
}
