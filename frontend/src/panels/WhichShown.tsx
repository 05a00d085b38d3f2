// Which craft and which emitter the panels and the map show. With one of each there is nothing to choose.
import { type MessageKey, t } from "../i18n";
import { craftIds } from "../state/moment";
import { selectedCraft } from "../state/selection";
import { mission } from "../state/shown";
import { EmitterList } from "./EmitterList";

interface Choice {
  label: MessageKey;
  testId: string;
  ids: readonly string[];
  shown: string | null;
  nameOf: (id: string) => string;
  onChoose: (id: string) => void;
}

function Choose({ label, testId, ids, shown, nameOf, onChoose }: Choice) {
  if (ids.length < 2) return null;
  return (
    <label>
      {t(label)}
      <select data-testid={testId} value={shown ?? ""} onChange={(e) => onChoose(e.currentTarget.value)}>
        {ids.map((id) => (
          <option value={id} key={id}>
            {nameOf(id)}
          </option>
        ))}
      </select>
    </label>
  );
}

export function WhichShown() {
  const { spec, craftId } = mission.value;
  const emitters = spec?.emitters ?? [];
  if (emitters.length < 2 && craftIds.value.length < 2) return null;
  return (
    <div class="which-shown" data-testid="which-shown">
      <EmitterList />
      <Choose
        label="which.craft"
        testId="which-craft"
        ids={craftIds.value}
        shown={craftId}
        nameOf={(id) => id}
        onChoose={(id) => (selectedCraft.value = id)}
      />
    </div>
  );
}
