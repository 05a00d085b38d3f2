// Where an emitter stands in the order of importance: first of all, half a step up, half a step down.
import { t } from "../i18n";
import { emitterName } from "../state/emitterName";
import { move, type Priorities, placeOf, putFirst } from "../state/importance";
import type { EmitterSpec } from "../wire";

interface Properties {
  emitters: readonly EmitterSpec[];
  id: string;
  onOrder: (priorities: Priorities) => void;
}

export function OrderButtons({ emitters, id, onOrder }: Properties) {
  const name = emitterName(emitters, id);
  const alone = placeOf(emitters, id) === 1 && move(emitters, id, "sooner") === null;
  return (
    <fieldset class="order-buttons" aria-label={t("order.of", { name })}>
      <button type="button" data-testid={`first-${id}`} aria-pressed={alone} onClick={() => onOrder(putFirst(emitters, id))}>
        {t("order.first")}
      </button>
      {(["sooner", "later"] as const).map((by) => {
        const next = move(emitters, id, by);
        return (
          <button
            type="button"
            class="icon"
            key={by}
            data-testid={`${by}-${id}`}
            aria-label={t(`order.${by}`, { name })}
            title={t(`order.${by}`, { name })}
            aria-disabled={next === null}
            onClick={() => next && onOrder(next)}
          >
            {by === "sooner" ? "▲" : "▼"}
          </button>
        );
      })}
    </fieldset>
  );
}
