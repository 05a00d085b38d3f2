// How the emitters sound: all of a list alike, since one list is of one kind of tag.
import { t } from "../i18n";
import type { EmitterSpec } from "../wire";
import { draft, update } from "./draft";
import { firstEmitter } from "./emitter";

const KINDS = ["carrier", "pulsed"] as const satisfies readonly EmitterSpec["kind"][];

export function KindField() {
  const { spec } = draft.value!;
  const choose = (kind: EmitterSpec["kind"]) => {
    const now = draft.peek()!;
    update({ ...now, spec: { ...now.spec, emitters: now.spec.emitters.map((emitter) => ({ ...emitter, kind })) } });
  };
  return (
    <div class="field">
      <label for="field-emitters-0-kind">{t("edit.kind")}</label>
      <select
        id="field-emitters-0-kind"
        data-testid="field-emitters-0-kind"
        value={firstEmitter(spec).kind}
        onChange={(e) => choose(e.currentTarget.value as EmitterSpec["kind"])}
      >
        {KINDS.map((kind) => (
          <option value={kind} key={kind}>
            {t(`edit.kind.${kind}`)}
          </option>
        ))}
      </select>
    </div>
  );
}
