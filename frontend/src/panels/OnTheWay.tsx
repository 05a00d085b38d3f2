// What was heard between places: one line a leg, and why the rest of its readings say nothing.
import { t } from "../i18n";
import type { Way } from "../state/emitter";
import { cursor } from "../state/moment";
import { mission } from "../state/shown";
import { noseWords, wayWords, whyLeftOut } from "../state/wayWords";
import { CountButton } from "./CountButton";

export function OnTheWay({ ways }: { ways: readonly Way[] }) {
  if (ways.length === 0) return null;
  const { missionId: id, ended } = mission.value;
  return (
    <ul class="on-the-way" data-testid="on-the-way">
      {ways.toReversed().map(({ fact, seq, leftOut, excluded }) => (
        <li key={seq}>
          <span class={excluded ? "muted" : ""}>{wayWords(fact)}</span>
          {excluded && ` (${t(leftOut ? "sweep.excluded" : "sweep.muted")})`}
          {noseWords(fact).map((words) => (
            <div class="muted" key={words}>
              {words}
            </div>
          ))}
          {fact.left_out.length > 0 && (
            <details>
              <summary>{t("way.leftOut")}</summary>
              {whyLeftOut(fact).map((why) => (
                <div class="muted" key={why}>
                  {why}
                </div>
              ))}
            </details>
          )}
          {fact.readings !== null && cursor.value === null && !ended && id && (
            <CountButton id={id} of={fact.leg_id} leftOut={leftOut} words={leftOut ? "way.include" : "way.exclude"} />
          )}
        </li>
      ))}
    </ul>
  );
}
