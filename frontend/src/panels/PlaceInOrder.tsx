// "first", "no. 2": where an emitter stands in the order of importance; nothing where all are alike, or it comes last.
import { t } from "../i18n";
import { placeOf } from "../state/importance";
import type { EmitterSpec } from "../wire";

export function PlaceInOrder({ emitters, id, standsBack = false }: { emitters: readonly EmitterSpec[]; id: string; standsBack?: boolean }) {
  const place = placeOf(emitters, id);
  if (standsBack) return <span class="emitter-place">{t("order.isBack")}</span>;
  if (place === null) return null;
  return (
    <span class="emitter-place" data-testid={`place-${id}`}>
      {place === 1 ? t("order.isFirst") : t("order.isNumber", { number: place })}
    </span>
  );
}
