// Several emitters as a list to paste into. What is wrong is said line by line, and nothing is taken until all is right.
import { useEffect, useState } from "preact/hooks";
import { type MessageKey, t } from "../i18n";
import { OrderButtons } from "../panels/OrderButtons";
import { PlaceInOrder } from "../panels/PlaceInOrder";
import { emitterName } from "../state/emitterName";
import { importanceWords, inOrder, type Priorities, prioritiesOf } from "../state/importance";
import type { EmitterSpec, MissionSpec } from "../wire";
import { draft, shownFields, textBeside, type, update } from "./draft";
import { EMITTER } from "./emitter";
import { badLineWords, LIST, listOf, readList } from "./emitterList";

/** What the list replaces: its raw text, and that of its first emitter's own fields. */
const OWN = [LIST, `${EMITTER}.frequency_hz`, `${EMITTER}.label`];

/** The list as it is typed, of the draft that is on the page. */
function take(text: string | undefined): void {
  const now = draft.peek();
  if (!now || text === undefined) return;
  const { emitters, bad } = readList(text, now.spec.emitters);
  const kept = textBeside(now.text, (path) => OWN.includes(path));
  if (bad.length > 0 || emitters.length === 0) update({ ...now, text: { ...kept, [LIST]: text } });
  else update({ ...now, spec: { ...now.spec, emitters }, text: kept });
}

function order(priorities: Priorities): void {
  const now = draft.peek()!;
  update({ ...now, spec: { ...now.spec, emitters: inOrder(now.spec.emitters, priorities) } });
}

/** Nothing to put in order while the list is not understood. */
function Order({ emitters }: { emitters: readonly EmitterSpec[] }) {
  return (
    <details class="more" data-testid="emitter-order">
      <summary>
        {t("order.change")}: {importanceWords(emitters, prioritiesOf(emitters))}
      </summary>
      <ol class="order-rows">
        {emitters.map(({ emitter_id: id }) => (
          <li key={id}>
            <span>
              {emitterName(emitters, id)}
              <PlaceInOrder emitters={emitters} id={id} />
            </span>
            <OrderButtons emitters={emitters} id={id} onOrder={order} />
          </li>
        ))}
      </ol>
    </details>
  );
}

function countWords({ emitters, sensor }: MissionSpec): MessageKey {
  if (emitters.length === 1) return "edit.list.one";
  return sensor.receiver_band_hz ? "edit.list.inTurn" : "edit.list.count";
}

export function EmitterListField() {
  const { spec, text } = draft.value!;
  const [isTyped, setTyped] = useState(false);
  const raw = text[LIST];
  const bad = raw === undefined || isTyped ? [] : readList(raw, spec.emitters).bad;
  const empty = !isTyped && raw?.trim() === "";
  useEffect(() => {
    shownFields.add(LIST);
    take(draft.peek()?.text[LIST]); // what was typed before a reload
    return () => {
      shownFields.delete(LIST);
    };
  }, []);
  const words = empty ? [t("edit.list.empty" satisfies MessageKey)] : bad.map(badLineWords);
  return (
    <div class="field emitter-list">
      <label for="emitter-list">{t("edit.list")}</label>
      <textarea
        id="emitter-list"
        data-testid="emitter-list"
        rows={Math.min(10, Math.max(3, (raw ?? listOf(spec.emitters)).split("\n").length + 1))}
        spellcheck={false}
        value={raw ?? listOf(spec.emitters)}
        aria-invalid={words.length > 0}
        aria-describedby="emitter-list-message"
        onInput={(e) => {
          setTyped(true);
          type(LIST, e.currentTarget.value);
        }}
        onBlur={() => {
          setTyped(false);
          take(draft.peek()?.text[LIST]);
        }}
      />
      <div id="emitter-list-message" class="emitter-list-said">
        {words.length === 0 && (
          <span class="muted" data-testid="emitter-count">
            {t(countWords(spec), { count: spec.emitters.length })}
          </span>
        )}
        {words.map((word) => (
          <div class="field-message" role="alert" data-testid="emitter-list-bad" key={word}>
            {word}
          </div>
        ))}
      </div>
      {raw === undefined && spec.emitters.length > 1 && <Order emitters={spec.emitters} />}
    </div>
  );
}
