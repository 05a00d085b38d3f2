// How what is looked for moves: all of a list alike. Only what moves can be followed.
import { t } from "../i18n";
import type { RequestFailed } from "../sources/problem";
import type { EmitterSpec } from "../wire";
import { change, draft, type } from "./draft";
import { firstEmitter } from "./emitter";
import { FormField } from "./FormField";

type Movement = EmitterSpec["movement"];

const KINDS = ["still", "animal", "walking", "drifting"] as const satisfies readonly Movement["kind"][];
/** What is usual, m/s. */
const PACE: Record<Movement["kind"], number> = { still: 0.2, animal: 0.2, walking: 1.2, drifting: 0.3 };

const PACE_FIELD = "emitters.0.movement.speed_m_s";

export function MovementField({ failed }: { failed: RequestFailed | null }) {
  const { spec } = draft.value!;
  const { kind } = firstEmitter(spec).movement;
  const choose = (chosen: Movement["kind"]) => {
    change("emitters.all.movement", { kind: chosen, speed_m_s: PACE[chosen] } satisfies Movement);
    type(PACE_FIELD, null);
    if (chosen === "still") change("localization.follow", false);
  };
  return (
    <>
      <div class="field">
        <label for="field-emitters-0-movement">{t("edit.movement")}</label>
        <select
          id="field-emitters-0-movement"
          data-testid="field-emitters-0-movement"
          value={kind}
          onChange={(e) => choose(e.currentTarget.value as Movement["kind"])}
        >
          {KINDS.map((one) => (
            <option value={one} key={one}>
              {t(`edit.movement.${one}`)}
            </option>
          ))}
        </select>
      </div>
      {kind !== "still" && (
        <>
          {spec.emitters.length === 1 && (
            <FormField field={{ kind: "number", path: PACE_FIELD, label: "edit.pace", unit: "m/s", min: 0.01, max: 5 }} failed={failed} />
          )}
          <FormField field={{ kind: "switch", path: "localization.follow", label: "edit.follow" }} failed={failed} />
        </>
      )}
    </>
  );
}
