// All emitters of a search that has several: number and colour as on the map, how far each one is, and their order of importance.
import { signal } from "@preact/signals";
import { useState } from "preact/hooks";
import { send } from "../commands/send";
import { t } from "../i18n";
import { source } from "../state/connection";
import type { EmitterState } from "../state/emitter";
import { emitterColour } from "../state/emitterColours";
import { emitterName } from "../state/emitterName";
import { groupsOf, inOrder, type Priorities } from "../state/importance";
import { cursor, emittersThen, events } from "../state/moment";
import { selectedEmitter } from "../state/selection";
import { settings } from "../state/settings";
import { mission, shownTimeMs } from "../state/shown";
import { remainingTimes } from "../state/timeLeft";
import { formatExact } from "../units/exact";
import { formatDuration, formatLength } from "../units/quantities";
import type { EmitterSpec } from "../wire";
import { OrderButtons } from "./OrderButtons";
import { PlaceInOrder } from "./PlaceInOrder";
import { ProblemNote } from "./ProblemNote";

const ordering = signal(false);

function stateWords(emitter: EmitterState | undefined): string {
  const fact = emitter?.belief?.fact;
  if (!fact) return t("emitters.unheard");
  const length = fact.estimate ? `±${formatLength(fact.estimate.expected_rmse_m, settings.value.units)}` : "";
  if (fact.localized) return t("emitters.found", { length });
  return length ? t("emitters.looking", { length }) : t("emitters.unclear");
}

/** Its frequency, and its period where that alone tells it from another tag. */
function signalWords(emitters: readonly EmitterSpec[], index: number): string {
  const { frequency_hz, pulse_period_s } = emitters[index]!;
  const mhz = formatExact(frequency_hz / 1e6);
  const isShared = emitters.some((other, i) => i !== index && other.frequency_hz === frequency_hz);
  return isShared ? t("emitters.mhzEvery", { mhz, period: formatExact(pulse_period_s) }) : t("emitters.mhz", { mhz });
}

/** after: the last event when it was sent. */
interface Sent {
  priorities: Priorities;
  after: number;
}

function isTold(told: readonly EmitterSpec[], { priorities, after }: Sent): boolean {
  const groups = (of: Priorities) => JSON.stringify(groupsOf(inOrder(told, of)));
  return events.value.some(
    ({ seq, event }) => seq > after && event.kind === "priorities_changed" && groups(event.priorities) === groups(priorities),
  );
}

export function EmitterList() {
  const { spec, emitterId, missionId, plan, startedAt, ended } = mission.value;
  const told = spec?.emitters ?? [];
  const [sent, setSent] = useState<Sent | null>(null);
  // the next press builds on what was sent until the journal has it; what comes after that is another's order
  const emitters = sent && !isTold(told, sent) ? inOrder(told, sent.priorities) : told;
  const order = async (id: string, priorities: Priorities) => {
    const now = { priorities, after: events.peek().at(-1)?.seq ?? 0 };
    setSent(now);
    const accepted = await send("order", id, { kind: "set_priorities", priorities });
    if (!accepted) setSent((last) => (last === now ? null : last));
  };
  if (emitters.length < 2) return null;
  const states = emittersThen.value;
  const found = emitters.filter((e) => states.get(e.emitter_id)?.belief?.fact.localized).length;
  const steers = missionId !== null && startedAt !== null && !ended && cursor.value === null && (source.value?.takesCommands ?? false);
  const back = new Set(ended ? [] : plan?.fact.set_back?.map((one) => one.emitter_id));
  const open = steers && ordering.value;
  // what is pressed stays under the thumb
  const rows = open ? emitters.map((e) => e.emitter_id) : groupsOf(emitters).flat();
  const times = remainingTimes(mission.value, shownTimeMs.value);
  return (
    <div class="emitters" data-testid="emitters" data-found={found}>
      <p class="emitters-head">
        <span>{t("emitters.count", { found, all: emitters.length })}</span>
        {steers && (
          <button type="button" data-testid="order" aria-expanded={open} onClick={() => (ordering.value = !open)}>
            {t(open ? "order.done" : "order.change")}
          </button>
        )}
      </p>
      {open && <p class="muted order-hint">{t("order.hint")}</p>}
      <ProblemNote desk="order" />
      <ol class={open ? "whole" : ""}>
        {rows.map((id) => {
          const index = emitters.findIndex((e) => e.emitter_id === id);
          const { fill, ink } = emitterColour(index);
          const localized = states.get(id)?.belief?.fact.localized ?? false;
          const left = localized ? undefined : times.get(id);
          return (
            <li key={id} class={open ? "in-order" : ""}>
              <button
                type="button"
                class="emitter-row"
                data-testid={`emitter-${id}`}
                data-localized={localized}
                aria-pressed={id === emitterId}
                onClick={() => (selectedEmitter.value = id)}
              >
                <span class="emitter-chip" style={{ background: fill, color: ink }}>
                  {index + 1}
                </span>
                <span class="emitter-name">
                  <span>
                    {emitterName(emitters, id)}
                    <PlaceInOrder emitters={emitters} id={id} standsBack={back.has(id)} />
                  </span>
                  <small>{signalWords(emitters, index)}</small>
                </span>
                <span class="emitter-state">
                  {stateWords(states.get(id))}
                  {left !== undefined && <small data-testid={`left-${id}`}>{t("emitters.left", { time: formatDuration(left) })}</small>}
                </span>
              </button>
              {open && <OrderButtons emitters={emitters} id={id} onOrder={(priorities) => void order(missionId, priorities)} />}
            </li>
          );
        })}
      </ol>
    </div>
  );
}
