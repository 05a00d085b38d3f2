// Recorded sweeps and bearings into a mission that does not fly: files, where and when when they do not tell, and what came of it.
import { signal } from "@preact/signals";
import { asProblem } from "../commands/send";
import { type MessageKey, reasonText, t } from "../i18n";
import * as api from "../sources/api";
import { localProblem } from "../sources/problem";
import { chosenCard, drawersCard } from "../state/card";
import { source } from "../state/connection";
import { emitterName } from "../state/emitterName";
import { inFlight } from "../state/mission";
import { liveMission } from "../state/moment";
import { mission } from "../state/shown";
import { formatExact } from "../units/exact";
import { parsePlace } from "../units/parsePlace";
import { formatBearing, formatNumber } from "../units/quantities";
import type { Problem, RecordingImport } from "../wire";
import { ProblemBox } from "./ProblemNote";

type Outcome = { missionId: string } & ({ found: RecordingImport } | { problem: Problem } | { busy: true });

const outcome = signal<Outcome | null>(null);

/** What the file may not tell: fields of the form, and the factor from what is typed to what the server wants. */
const NUMBERS = [
  { name: "offset_deg", scale: 1, label: "recording.offset" },
  { name: "frequency_hz", scale: 1e6, label: "recording.frequency" },
  { name: "pulse_width_s", scale: 1e-3, label: "recording.pulseWidth" },
  { name: "pulse_period_s", scale: 1, label: "recording.pulsePeriod" },
] as const satisfies { name: string; scale: number; label: MessageKey }[];

/** The form's fields as the server wants them; a sentence when one cannot be read. */
export function recordingForm(given: FormData): FormData | string {
  const files = given.getAll("files").filter((entry): entry is File => entry instanceof File && entry.size > 0);
  if (files.length === 0) return t("recording.noFile");
  const text = (name: string) => String(given.get(name) ?? "").trim();
  const form = new FormData();
  for (const file of files) form.append("files", file, file.name);
  const antenna = given.get("antenna");
  if (antenna instanceof File && antenna.size > 0) form.append("antenna", antenna, antenna.name);
  if (text("place")) {
    const read = parsePlace(text("place"));
    if (!read) return t("recording.badPlace");
    form.append("lat", String(read.lat));
    form.append("lon", String(read.lon));
  }
  // the input has no time zone: UTC is what its label says
  if (text("at")) form.append("at_utc", `${text("at")}Z`);
  for (const name of ["emitter_id", "tag"]) if (text(name)) form.append(name, text(name));
  for (const { name, scale, label } of NUMBERS) {
    if (!text(name)) continue;
    const value = Number(text(name).replace(",", "."));
    if (Number.isNaN(value)) return t("recording.badNumber", { field: t(label) });
    form.append(name, String(value * scale));
  }
  return form;
}

/** On a phone that has chosen no card, what the file brings must not put another over what is said of it. */
export async function submit(missionId: string, element: HTMLFormElement): Promise<void> {
  chosenCard.value = drawersCard(liveMission.value.phase);
  const form = recordingForm(new FormData(element));
  if (typeof form === "string") {
    outcome.value = { missionId, problem: localProblem(t("recording.title"), form) };
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
          <li key={sweep.place_number}>
            <strong>{t("sweep.place", { number: sweep.place_number })}</strong>{" "}
            {sweep.bearing_deg !== null &&
              sweep.sigma_deg !== null &&
              `${t("sweep.bearing", { bearing: formatBearing(sweep.bearing_deg), sigma: formatNumber(sweep.sigma_deg, 1) })}${sweep.sweep_id && ", "}`}
            {sweep.sweep_id && t("sweep.quality", { quality: formatNumber(sweep.quality, 2) })}
            {sweep.reason && `. ${t("sweep.rejected", { reason: reasonText(sweep.reason) })}`}
          </li>
        ))}
      </ul>
      {found.remarks.length > 0 && (
        <>
          <p>{t("recording.remarks", { count: found.remarks.length })}</p>
          <ul class="remarks" data-testid="recording-remarks">
            {found.remarks.map((remark, i) => (
              <li key={i}>{reasonText(remark)}</li>
            ))}
          </ul>
        </>
      )}
    </div>
  );
}

/** Whose bearings they are, where several emitters are sought; first, also when the form is empty again, the one looked at. */
function WhichEmitter() {
  const { spec, emitterId } = mission.value;
  const emitters = spec?.emitters ?? [];
  if (emitters.length < 2) return null;
  const [others, shown] = [emitters.filter((e) => e.emitter_id !== emitterId), emitters.filter((e) => e.emitter_id === emitterId)];
  return (
    <label>
      {t("report.emitter")}
      <select name="emitter_id" data-testid="recording-emitter" key={emitterId}>
        {[...shown, ...others].map(({ emitter_id: id, frequency_hz }) => (
          <option value={id} key={id}>
            {emitterName(emitters, id)} {t("emitters.mhz", { mhz: formatExact(frequency_hz / 1e6) })}
          </option>
        ))}
      </select>
    </label>
  );
}

export function ImportRecording() {
  const { missionId, phase } = liveMission.value;
  if (!missionId || inFlight(phase) || !source.value?.keptByServer) return null;
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
          <p class="muted lines">{t("recording.explain")}</p>
          <label>
            {t("recording.files")}
            <input type="file" name="files" multiple data-testid="recording-files" />
          </label>
          <WhichEmitter />
          <label>
            {t("recording.antenna")}
            <input type="file" name="antenna" accept=".json,.csv,.tsv,.txt" data-testid="recording-antenna" />
          </label>
          <label>
            {t("recording.place")}
            <input name="place" placeholder="50.6123, 7.2046" data-testid="recording-place" />
          </label>
          <label>
            {t("recording.at")}
            <input type="datetime-local" name="at" step={1} data-testid="recording-at" />
          </label>
          <details class="more">
            <summary>{t("recording.more")}</summary>
            <label>
              {t("recording.tag")}
              <input name="tag" maxLength={80} data-testid="recording-tag" />
            </label>
            {NUMBERS.map(({ name, label }) => (
              <label key={name}>
                {t(label)}
                <input name={name} inputMode="decimal" data-testid={`recording-${name}`} />
              </label>
            ))}
          </details>
          <button type="submit" class="primary" disabled={busy} data-testid="recording-send">
            {t(busy ? "recording.busy" : "recording.send")}
          </button>
        </form>
        {now && "found" in now && <Found found={now.found} />}
        {now && "problem" in now && <ProblemBox problem={now.problem} testId="recording-problem" />}
      </details>
    </section>
  );
}
