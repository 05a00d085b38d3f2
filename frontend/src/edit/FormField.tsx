// One row of the form: label, input, unit, and what is wrong with it.

import { t } from "../i18n";
import type { RequestFailed } from "../sources/problem";
import { settings } from "../state/settings";
import { formatPlace } from "../units/coordinates";
import { parsePlace } from "../units/parsePlace";
import type { Place } from "../wire";
import { bandMessage } from "./band";
import { change, draft } from "./draft";
import { type ChoiceField, type Field, type NumberField, shownUnit, shownValue, typedNumber } from "./fields";
import { get } from "./path";
import { useTyped } from "./typed";

interface Properties<F> {
  field: F;
  failed: RequestFailed | null;
}

const idOf = (path: string) => `field-${path.replaceAll(".", "-")}`;

export function Message({ id, text }: { id: string; text: string | null }) {
  return text ? (
    <div class="field-message" id={`${id}-message`} role="alert">
      {text}
    </div>
  ) : null;
}

/** What the server said of the field, else what can be said before it is asked. */
const wrong = (path: string, failed: RequestFailed | null): string | null =>
  failed?.fieldMessage(path) ?? (path === "flight.altitude_relative_m" ? bandMessage(draft.value!.spec) : null);

const unitWords = (unit: string) => (unit === "times" || unit === "places" || unit === "bearings" ? t(`unit.${unit}`) : unit);

function NumberInput({ field, failed }: Properties<NumberField>) {
  const now = draft.value!;
  const { unit, scale } = shownUnit(field, settings.value.units);
  const stored = get(now.spec, field.path);
  const id = idOf(field.path);
  const shown = typeof stored === "number" ? shownValue(stored, scale) : "";
  const { input, isWrong } = useTyped(
    field.path,
    shown,
    (words) => typedNumber(words, field.scale),
    (value) => change(field.path, Number((value * scale).toPrecision(12))),
  );
  const message = isWrong ? t("edit.notNumber") : wrong(field.path, failed);
  return (
    <div class="field">
      <label for={id}>{t(field.label)}</label>
      <span class="field-input">
        <input
          id={id}
          data-testid={id}
          inputMode="decimal"
          aria-invalid={message !== null}
          aria-describedby={message ? `${id}-message` : undefined}
          {...input}
        />
        <span class="unit">{unitWords(unit)}</span>
      </span>
      <Message id={id} text={message} />
    </div>
  );
}

function Choice({ field, failed }: Properties<ChoiceField>) {
  const id = idOf(field.path);
  return (
    <div class="field field-choice">
      <label for={id}>{t(field.label)}</label>
      <select
        id={id}
        data-testid={id}
        value={String(get(draft.value!.spec, field.path))}
        onChange={(e) => change(field.path, e.currentTarget.value)}
      >
        {field.options.map((o) => (
          <option value={o.value} key={o.value}>
            {o.label ? t(o.label) : o.value}
          </option>
        ))}
      </select>
      <Message id={id} text={failed?.fieldMessage(field.path) ?? null} />
    </div>
  );
}

export function FormField({ field, failed }: Properties<Field>) {
  if (field.kind === "number") return <NumberInput field={field} failed={failed} />;
  if (field.kind === "choice") return <Choice field={field} failed={failed} />;
  return (
    <label class="check field-switch">
      <input
        type="checkbox"
        data-testid={idOf(field.path)}
        checked={Boolean(get(draft.value!.spec, field.path))}
        onChange={(e) => change(field.path, e.currentTarget.checked)}
      />
      {t(field.label)}
    </label>
  );
}

export function TextField({ path, label, failed }: { path: string; label: string; failed: RequestFailed | null }) {
  const id = idOf(path);
  const message = failed?.fieldMessage(path) ?? null;
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <input
        id={id}
        data-testid={id}
        maxLength={120}
        value={String(get(draft.value!.spec, path) ?? "")}
        aria-invalid={message !== null}
        onInput={(e) => change(path, e.currentTarget.value)}
      />
      <Message id={id} text={message} />
    </div>
  );
}

/** A place in any notation. */
export function PlaceField({ path, label, failed }: { path: string; label: string; failed: RequestFailed | null }) {
  const id = idOf(path);
  const place = get(draft.value!.spec, path) as Place | undefined;
  const shown = place ? formatPlace(place, settings.value.coordinates) : "";
  const { input, isWrong } = useTyped(path, shown, parsePlace, (found) => change(path, found));
  const message = isWrong ? t("edit.notPlace") : (failed?.fieldMessage(path) ?? null);
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <input id={id} data-testid={id} aria-invalid={message !== null} {...input} />
      <Message id={id} text={message} />
    </div>
  );
}
