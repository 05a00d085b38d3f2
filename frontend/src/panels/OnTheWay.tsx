// What was heard between places: a line for the newest leg; opened, each leg and why the rest of its readings say nothing.
import { signal } from "@preact/signals";
import { t } from "../i18n";
import type { Way } from "../state/emitter";
import { cursor } from "../state/moment";
import { mission } from "../state/shown";
import { noseWords, wayWords, whyLeftOut } from "../state/wayWords";
import { CountButton } from "./CountButton";

/** Over places: the panel moves the list while the craft turns. */
const open = signal(false);

const Told = ({ way: { fact, leftOut, excluded } }: { way: Way }) => (
  <span class={excluded ? "muted" : ""}>
    {wayWords(fact)}
    {excluded && ` (${t(leftOut ? "sweep.excluded" : "sweep.muted")})`}
  </span>
);

export function OnTheWay({ ways }: { ways: readonly Way[] }) {
  const newest = ways.at(-1);
  if (!newest) return null;
  const { missionId: id, ended } = mission.value;
  return (
    <details class="on-the-way" data-testid="on-the-way" open={open.value} onToggle={(e) => (open.value = e.currentTarget.open)}>
      <summary>
        <Told way={newest} />
      </summary>
      <ul>
        {ways.toReversed().map((way) => (
          <li key={way.seq}>
            <Told way={way} />
            {[...noseWords(way.fact), ...whyLeftOut(way.fact)].map((words) => (
              <div class="muted" key={words}>
                {words}
              </div>
            ))}
            {way.fact.readings !== null && cursor.value === null && !ended && id && (
              <CountButton id={id} of={way.fact.leg_id} leftOut={way.leftOut} words={way.leftOut ? "way.include" : "way.exclude"} />
            )}
          </li>
        ))}
      </ul>
    </details>
  );
}
