// All emitters of a search that has several: number and colour as on the map, and how far each one is. One is looked at.
import { t } from "../i18n";
import type { EmitterState } from "../state/emitter";
import { emitterColour } from "../state/emitterColours";
import { emitterName } from "../state/emitterName";
import { emittersThen } from "../state/moment";
import { selectedEmitter } from "../state/selection";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { formatLength } from "../units/quantities";

function stateWords(emitter: EmitterState | undefined): string {
  const fact = emitter?.belief?.fact;
  if (!fact) return t("emitters.unheard");
  const length = fact.estimate ? `±${formatLength(fact.estimate.expected_rmse_m, settings.value.units)}` : "";
  if (fact.localized) return t("emitters.found", { length });
  return length ? t("emitters.looking", { length }) : t("emitters.unclear");
}

export function EmitterList() {
  const { spec, emitterId } = mission.value;
  const emitters = spec?.emitters ?? [];
  if (emitters.length < 2) return null;
  const states = emittersThen.value;
  const found = emitters.filter((e) => states.get(e.emitter_id)?.belief?.fact.localized).length;
  return (
    <div class="emitters" data-testid="emitters" data-found={found}>
      <p class="emitters-head">{t("emitters.count", { found, all: emitters.length })}</p>
      <ol>
        {emitters.map(({ emitter_id: id, frequency_hz }, index) => {
          const { fill, ink } = emitterColour(index);
          const localized = states.get(id)?.belief?.fact.localized ?? false;
          return (
            <li key={id}>
              <button
                type="button"
                data-testid={`emitter-${id}`}
                data-localized={localized}
                aria-pressed={id === emitterId}
                onClick={() => (selectedEmitter.value = id)}
              >
                <span class="emitter-chip" style={{ background: fill, color: ink }}>
                  {index + 1}
                </span>
                <span class="emitter-name">
                  {emitterName(emitters, id)} <small>{t("emitters.mhz", { mhz: Number((frequency_hz / 1e6).toFixed(4)) })}</small>
                </span>
                <span class="emitter-state">{stateWords(states.get(id))}</span>
              </button>
            </li>
          );
        })}
      </ol>
    </div>
  );
}
