// What was heard between places: a line for the newest leg; opened, each leg and why the rest of its readings say nothing.
import { t } from "../i18n";
import type { Way } from "../state/emitter";
import { cursor } from "../state/moment";
import { mission } from "../state/shown";
import { noseWords, wayWords, whyLeftOut } from "../state/wayWords";
import { CountButton } from "./CountButton";

export function OnTheWay({ ways }: { ways: readonly Way[] }) {
  const newest = ways.at(-1);
  if (!newest) return null;
  const { missionId: id, ended } = mission.value;
  return (
    <details class="on-the-way" data-testid="on-the-way">
      <summary>{wayWords(newest.fact)}</summary>
      <ul>
        {ways.toReversed().map(({ fact, seq, leftOut, excluded }) => (
          <li key={seq}>
            <span class={excluded ? "muted" : ""}>{wayWords(fact)}</span>
            {excluded && ` (${t(leftOut ? "sweep.excluded" : "sweep.muted")})`}
            {[...noseWords(fact), ...whyLeftOut(fact)].map((words) => (
              <div class="muted" key={words}>
                {words}
              </div>
            ))}
            {fact.readings !== null && cursor.value === null && !ended && id && (
              <CountButton id={id} of={fact.leg_id} leftOut={leftOut} words={leftOut ? "way.include" : "way.exclude"} />
            )}
          </li>
        ))}
      </ul>
    </details>
  );
}
