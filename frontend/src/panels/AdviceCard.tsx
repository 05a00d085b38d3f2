// "Where next?" for people: asked for, followed or not; it says what it would bring and when it has grown old.
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { askAdvice } from "../sources/adviceApi";
import { advice, adviceFreshness } from "../state/advice";
import { source } from "../state/connection";
import { settings } from "../state/settings";
import { mission, shownTimeMs } from "../state/shown";
import { formatAge, formatBearing, formatDuration, formatLength } from "../units/quantities";
import type { Problem } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { ProblemBox } from "./ProblemNote";

/** m/s */
const SPEED = { walking: 1.3, driving: 9, hopping: 9 } as const;
type Going = keyof typeof SPEED;

function Said() {
  const given = advice.value;
  const state = adviceFreshness.value;
  if (!given || !state) return null;
  if (given.localized) return <p data-testid="advice-done">{t("advice.localized")}</p>;
  const metres = (length: number | null | undefined) => formatLength(Math.round(length ?? 0), settings.value.units);
  const known = given.along ?? "straight";
  const along = known === "around" && metres(given.way_m) === metres(given.away_m) ? "straight" : known;
  const age = formatAge(Math.max(0, (shownTimeMs.value - Date.parse(given.given_at_utc)) / 1000));
  return (
    <div data-testid="advice-said" data-state={state} class={`advice-said ${state === "holds" ? "" : "muted"}`}>
      <p>
        <strong>
          {t(`advice.go.${along}`, {
            length: metres(given.way_m),
            away: metres(given.away_m),
            bearing: formatBearing(given.bearing_deg ?? 0),
            time: formatDuration(given.move_s ?? 0),
          })}
        </strong>
      </p>
      {given.hop && (
        <p data-testid="advice-hop">
          {t("advice.hop", {
            altitude: metres(given.hop.altitude_m),
            time: formatDuration(given.hop.up_s + given.hop.turn_s + given.hop.down_s),
          })}
        </p>
      )}
      <p>
        {t("advice.brings", {
          now: metres(given.error_now_m),
          later: metres(given.error_then_m),
        })}{" "}
        {given.expected_time_s !== null && t("advice.until", { time: formatDuration(given.expected_time_s) })}
      </p>
      {given.unreached > 0 && (
        <p data-testid="advice-unreached">{t("advice.unreached", { unreached: given.unreached, places: given.places })}</p>
      )}
      <small>
        {t(`advice.state.${state}`, { age })} {state === "holds" && known === "straight" && t("advice.straight")}
      </small>
    </div>
  );
}

export function AdviceCard({ missionId, here }: { missionId: string; here: LonLat | null }) {
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<Problem | null>(null);
  if (mission.value.ended) return null;
  const ask = async (going: Going) => {
    if (!here) return;
    setBusy(true);
    setProblem(null);
    try {
      const given = await askAdvice(
        missionId,
        { lon: here[0], lat: here[1] },
        SPEED[going],
        null,
        going === "hopping",
        going !== "walking",
      );
      if (source.peek()?.missionId === missionId) advice.value = given;
    } catch (error) {
      setProblem(asProblem(error));
    } finally {
      setBusy(false);
    }
  };
  return (
    <section data-testid="advice">
      <fieldset class="report-row">
        <legend>{t("advice.ask")}</legend>
        <button type="button" data-testid="advice-walking" disabled={!here || busy} onClick={() => void ask("walking")}>
          {t("advice.walking")}
        </button>
        <button type="button" data-testid="advice-driving" disabled={!here || busy} onClick={() => void ask("driving")}>
          {t("advice.driving")}
        </button>
        <button type="button" data-testid="advice-hopping" disabled={!here || busy} onClick={() => void ask("hopping")}>
          {t("advice.hopping")}
        </button>
      </fieldset>
      {problem && <ProblemBox problem={problem} />}
      <Said />
    </section>
  );
}
