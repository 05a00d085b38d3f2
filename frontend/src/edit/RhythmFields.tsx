// A tag's pulses: of all tags of a list alike, since one list is of one kind of tag. The periods of several are in the list.
import { type MessageKey, t } from "../i18n";
import type { RequestFailed } from "../sources/problem";
import { change, draft } from "./draft";
import { EMITTER, firstEmitter } from "./emitter";
import { Message } from "./FormField";
import { shownValue, typedNumber } from "./fields";
import { useTyped } from "./typed";

type Name = "pulse_period_s" | "pulse_width_s" | "pulse_jitter_s";

function PulseNumber({ name, label, failed }: { name: Name; label: MessageKey; failed: RequestFailed | null }) {
  const path = `${EMITTER}.${name}`;
  const id = `field-${path.replaceAll(".", "-")}`;
  const { input, isWrong } = useTyped(path, shownValue(firstEmitter(draft.value!.spec)[name], 1), typedNumber, (value) =>
    change(`emitters.all.${name}`, value),
  );
  const message = isWrong ? t("edit.notNumber") : (failed?.fieldMessage(path) ?? null);
  return (
    <div class="field">
      <label for={id}>{t(label)}</label>
      <span class="field-input">
        <input
          id={id}
          data-testid={id}
          inputMode="decimal"
          aria-invalid={message !== null}
          aria-describedby={message ? `${id}-message` : undefined}
          {...input}
        />
        <span class="unit">s</span>
      </span>
      <Message id={id} text={message} />
    </div>
  );
}

export function RhythmFields({ failed }: { failed: RequestFailed | null }) {
  const { emitters } = draft.value!.spec;
  if (emitters[0]!.kind !== "pulsed") return null;
  return (
    <>
      {emitters.length === 1 && <PulseNumber name="pulse_period_s" label="edit.pulsePeriod" failed={failed} />}
      <PulseNumber name="pulse_width_s" label="edit.pulseWidth" failed={failed} />
      <PulseNumber name="pulse_jitter_s" label="edit.pulseJitter" failed={failed} />
    </>
  );
}
