// For somebody with an antenna in their hand: where you stand, where it points, how loud; one thumb, with or without a link.
import type { TargetedEvent } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { backspace, countAgain, keepSending, queue, report, reporting, unreached } from "../commands/reportBearings";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { AdviceCard } from "../panels/AdviceCard";
import { AimMap } from "../panels/AimMap";
import { ProblemBox } from "../panels/ProblemNote";
import { WaysCard } from "../panels/WaysCard";
import { muteReporter } from "../sources/reportsApi";
import { advised, advisedWay } from "../state/advice";
import { isOwn, lastOf, pending, type Stage } from "../state/bearingQueue";
import { sourceKey } from "../state/emitter";
import { emitterName } from "../state/emitterName";
import { keep, kept } from "../state/kept";
import { emittersThen, look } from "../state/moment";
import { compassState, magneticDeg, startCompass, stopCompass } from "../state/phoneCompass";
import { missionAddress } from "../state/route";
import { me } from "../state/session";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { drawnWays } from "../state/ways";
import { formatBearing, formatLength } from "../units/quantities";
import type { Problem } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { useGps } from "./useGps";
import "../style/report.css";

/** Standard deviations of what a hand antenna tells, its compass included. */
const SHARPNESS = { sharp: 8, usual: 12, vague: 25 } as const;
/** dB above the noise. */
const LOUDNESS = { faint: 4, clear: 12, loud: 25 } as const;
type Sharpness = keyof typeof SHARPNESS;
type Loudness = keyof typeof LOUDNESS;

const KEPT = "crossfix.reporter";

interface Reporter {
  name: string;
  /** East of north is positive. */
  declination: number;
}

function readReporter(): Reporter {
  try {
    const { name = "", declination = 0 } = JSON.parse(kept(KEPT) ?? "{}") as Partial<Reporter>;
    return { name: String(name), declination: Number(declination) || 0 };
  } catch {
    return { name: "", declination: 0 };
  }
}

const keepReporter = (reporter: Reporter) => keep(KEPT, reporter);

const turned = (degrees: number) => ((degrees % 360) + 360) % 360;

/** silent: the server has it, and it does not count: left out there, or its reporter is muted. */
const stageWords = (stage: Stage, problem: string | null, silent: boolean): string =>
  stage === "sent" && silent
    ? t("report.stage.silent")
    : stage === "refused"
      ? t("report.stage.refused", { problem: problem ?? "" })
      : [t(`report.stage.${stage}`), problem].filter(Boolean).join(": ");

/** Of a field: what is typed stands, whatever is drawn meanwhile, until the field is left or its value comes from elsewhere. */
function useFieldText<T>(value: T, words: string, read: (text: string) => T, onRead: (value: T) => void) {
  const [typed, setTyped] = useState<{ text: string; value: T } | null>(null);
  return {
    value: typed?.value === value ? typed.text : words,
    onInput: ({ currentTarget: { value: text } }: TargetedEvent<HTMLInputElement>) => {
      setTyped({ text, value: read(text) });
      onRead(read(text));
    },
    onBlur: () => setTyped(null),
  };
}

const bearingIn = (text: string): number | null => {
  const degrees = Number(text.replace(",", "."));
  return text.trim() === "" || !Number.isFinite(degrees) ? null : turned(degrees);
};

function Pick<T extends string>({
  name,
  values,
  value,
  label,
  onPick,
}: {
  name: string;
  values: readonly T[];
  value: T;
  label: (one: T) => string;
  onPick: (one: T) => void;
}) {
  return (
    <fieldset class="report-row">
      <legend>{name}</legend>
      {values.map((one) => (
        <button type="button" key={one} data-testid={`report-${one}`} aria-pressed={one === value} onClick={() => onPick(one)}>
          {label(one)}
        </button>
      ))}
    </fieldset>
  );
}

function Sent({ missionId }: { missionId: string }) {
  const own = queue.value.filter((one) => one.missionId === missionId && isOwn(one, reporting.value)).toReversed();
  if (own.length === 0) return null;
  const silent = new Set(
    [...emittersThen.value.values()].flatMap(({ bearings }) => bearings.filter((b) => b.excluded).map((b) => b.fact.bearing_id)),
  );
  return (
    <ul class="report-sent" data-testid="report-sent">
      {own.slice(0, 6).map(({ report: one, stage, problem }) => (
        <li key={one.bearing_id} data-stage={stage}>
          <span>{formatBearing(one.bearing_deg)}</span> <span class="muted">{one.taken_at_utc?.slice(11, 19)}</span>{" "}
          <span>{stageWords(stage, problem, silent.has(one.bearing_id))}</span>
          {stage === "back" && (
            <button type="button" class="small" data-testid="report-again" onClick={() => countAgain(one.bearing_id)}>
              {t("report.again")}
            </button>
          )}
        </li>
      ))}
    </ul>
  );
}

/** by: null where one is signed in. */
function OwnMute({ missionId, name, by }: { missionId: string; name: string; by: string | null }) {
  const [problem, setProblem] = useState<Problem | null>(null);
  const source = { kind: "person" as const, name };
  const muted = mission.value.muted.has(sourceKey(source));
  const told = [...emittersThen.value.values()].some(({ bearings }) =>
    bearings.some((b) => sourceKey(b.fact.source) === sourceKey(source)),
  );
  if (!told) return null;
  const change = async () => {
    setProblem(null);
    try {
      await muteReporter(missionId, by, !muted);
    } catch (error) {
      setProblem(asProblem(error));
    }
  };
  return (
    <div class="report-mute">
      {muted && <p role="status">{t("report.muted")}</p>}
      <button type="button" data-testid="report-mute" aria-pressed={muted} onClick={() => void change()}>
        {t(muted ? "report.unmute" : "report.mute")}
      </button>
      {problem && <ProblemBox problem={problem} />}
    </div>
  );
}

export function BearingsPage({ route }: { route: { missionId: string } }) {
  const { missionId } = route;
  const { spec, bearings, ended } = mission.value;
  const [reporter, setReporter] = useState(readReporter);
  const [unnamed] = useState(reporter.name === "");
  const [here, setHere] = useState<LonLat | null>(null);
  const [bearing, setBearing] = useState<number | null>(null);
  const [mode, setMode] = useState<"here" | "direction">("here");
  const [sharpness, setSharpness] = useState<Sharpness>("usual");
  const [loudness, setLoudness] = useState<Loudness>("clear");
  const [emitter, setEmitter] = useState<string | null>(null);
  const who = useRef<HTMLDetailsElement>(null);
  const gps = useGps(setHere);
  useEffect(() => void (gps.state === "denied" && setMode("here")), [gps.state]);
  useEffect(() => look(null), []);
  useEffect(() => keepSending(), []);
  useEffect(() => stopCompass, []);
  const emitters = spec?.emitters ?? [];
  const heard = emitter ?? emitters[0]?.emitter_id ?? null;
  const pointing = compassState.value === "on" && magneticDeg.value !== null ? turned(magneticDeg.value + reporter.declination) : null;
  const direction = pointing ?? bearing;
  const change = (changes: Partial<Reporter>) => {
    const next = { ...reporter, ...changes };
    setReporter(next);
    keepReporter(next);
  };
  const typedDirection = useFieldText(
    direction,
    direction === null ? "" : String(Math.round(direction) % 360).padStart(3, "0"),
    bearingIn,
    (degrees) => {
      stopCompass();
      setBearing(degrees);
    },
  );
  const typedDeclination = useFieldText(
    reporter.declination,
    String(reporter.declination),
    (text) => Number(text.replace(",", ".")) || 0,
    (declination) => change({ declination }),
  );
  const signedIn = me.value?.name ?? null;
  const named = signedIn !== null || reporter.name.trim() !== "";
  const ready = here !== null && direction !== null && named && heard !== null && ended === null;
  const unsaid = !named ? "name" : here === null ? "place" : direction === null ? "direction" : null;
  const missing = ended !== null ? "ended" : (unsaid ?? (heard === null ? "search" : null));
  const send = () => {
    if (!ready) return;
    report(missionId, {
      by: signedIn === null ? reporter.name.trim() : null,
      emitter_id: heard,
      place: { lon: here[0], lat: here[1] },
      bearing_deg: turned(direction),
      sigma_deg: SHARPNESS[sharpness],
      snr_db: LOUDNESS[loudness],
    });
  };
  const askName = () => {
    who.current!.open = true;
    who.current!.querySelector("input")!.focus();
  };
  const waiting = pending(queue.value, reporting.value);
  return (
    <div class="report" data-testid="report-page">
      <header class="report-head">
        <h1>{spec?.name ?? t("app.loading")}</h1>
        <a href={missionAddress(missionId)}>{t("report.console")}</a>
        {waiting > 0 && (
          <p role="status" data-testid="report-waiting">
            {t(unreached.value ? "report.offline" : "report.sending", { count: waiting })}
          </p>
        )}
      </header>
      <AimMap
        area={spec?.area ?? null}
        others={bearings}
        advised={advised.value}
        way={advisedWay.value}
        ways={drawnWays.value}
        here={here}
        bearing={direction}
        sigma={SHARPNESS[sharpness]}
        mode={mode}
        onHere={(place) => {
          gps.stop();
          setHere([place.lon, place.lat]);
          setMode("direction");
        }}
        onDirection={(degrees) => {
          stopCompass();
          setBearing(degrees);
        }}
      />
      <fieldset class="report-row">
        <legend>{t("report.here")}</legend>
        <button type="button" data-testid="report-mode-here" aria-pressed={mode === "here"} onClick={() => setMode("here")}>
          {t("truth.tap")}
        </button>
        <button
          type="button"
          data-testid="report-gps"
          aria-pressed={gps.state === "on"}
          onClick={() => {
            if (gps.state === "on") return gps.stop();
            setMode("direction");
            gps.start();
          }}
        >
          {gps.state === "on" && gps.accuracy !== null
            ? t("report.gpsOn", { length: formatLength(Math.round(gps.accuracy), settings.value.units) })
            : t("report.gps")}
        </button>
      </fieldset>
      {(gps.state === "denied" || gps.state === "silent") && <p role="alert">{t("report.gpsDenied")}</p>}
      <AdviceCard missionId={missionId} here={here} />
      <fieldset class="report-row">
        <legend>{t("report.hear")}</legend>
        <button type="button" data-testid="report-mode-direction" aria-pressed={mode === "direction"} onClick={() => setMode("direction")}>
          {t("truth.tap")}
        </button>
        <button
          type="button"
          data-testid="report-compass"
          aria-pressed={compassState.value === "on"}
          onClick={() => (compassState.value === "on" ? stopCompass() : void startCompass())}
        >
          {t("report.compass")}
        </button>
      </fieldset>
      {(compassState.value === "none" || compassState.value === "insecure" || compassState.value === "denied") && (
        <p role="alert" data-testid="report-compass-problem">
          {t(`report.compass.${compassState.value}`)}
        </p>
      )}
      <div class="report-direction">
        <button
          type="button"
          aria-label={t("report.left")}
          disabled={direction === null}
          onClick={() => setBearing(turned((direction ?? 0) - 5))}
        >
          −5°
        </button>
        <label>
          <span class="visually-hidden">{t("report.direction")}</span>
          <input inputMode="numeric" data-testid="report-direction" placeholder="000" {...typedDirection} />
          <span>° {t("report.trueNorth")}</span>
        </label>
        <button
          type="button"
          aria-label={t("report.right")}
          disabled={direction === null}
          onClick={() => setBearing(turned((direction ?? 0) + 5))}
        >
          +5°
        </button>
      </div>
      <Pick
        name={t("report.sharpness")}
        values={["sharp", "usual", "vague"]}
        value={sharpness}
        label={(one) => t(`report.sharpness.${one}`, { sigma: SHARPNESS[one] })}
        onPick={setSharpness}
      />
      <Pick
        name={t("report.loudness")}
        values={["faint", "clear", "loud"]}
        value={loudness}
        label={(one) => t(`report.loudness.${one}`)}
        onPick={setLoudness}
      />
      {emitters.length > 1 && (
        <label class="report-emitter">
          {t("report.emitter")}
          <select data-testid="report-emitter" value={heard ?? ""} onChange={(e) => setEmitter(e.currentTarget.value)}>
            {emitters.map(({ emitter_id: id }) => (
              <option value={id} key={id}>
                {emitterName(emitters, id)}
              </option>
            ))}
          </select>
        </label>
      )}
      <details class="report-who" ref={who} open={unnamed && signedIn === null}>
        <summary>{signedIn ?? (reporter.name || t("report.who"))}</summary>
        {signedIn === null && (
          <label>
            {t("report.name")}
            <input
              data-testid="report-name"
              maxLength={40}
              value={reporter.name}
              onInput={(e) => change({ name: e.currentTarget.value })}
            />
          </label>
        )}
        <label>
          {t("report.declination")}
          <input inputMode="decimal" {...typedDeclination} />
        </label>
      </details>
      <WaysCard missionId={missionId} />
      <Sent missionId={missionId} />
      {named && !ended && (
        <OwnMute missionId={missionId} name={signedIn ?? reporter.name.trim()} by={signedIn === null ? reporter.name.trim() : null} />
      )}
      <footer class="report-foot">
        <button
          type="button"
          data-testid="report-back"
          disabled={ended !== null || !lastOf(queue.value, missionId, reporting.value)}
          onClick={(e) => backspace(missionId, e.timeStamp)}
        >
          ⌫ {t("report.back")}
        </button>
        <button
          type="button"
          class="primary"
          data-testid="report-send"
          disabled={!ready && missing !== "name"}
          onClick={missing === "name" ? askName : send}
        >
          {missing === null && direction !== null
            ? t("report.send", { bearing: formatBearing(direction) })
            : t(`report.missing.${missing ?? "direction"}`)}
        </button>
      </footer>
    </div>
  );
}
