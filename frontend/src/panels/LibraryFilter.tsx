// What the list of missions is asked for besides words: place, date, emitter, vehicle, result, what was deleted.
import type { JSX } from "preact";
import { type MessageKey, t } from "../i18n";
import { boundsOf } from "../state/geometry";
import { ANY, type Filter } from "../state/library";
import type { MissionSummary } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { PlaceFilter } from "./PlaceFilter";

const OUTCOMES = ["localized", "not_localized", "aborted", "failed"] as const;

/** The year of a day has four digits while it is typed, too. */
const DAY = { type: "date", max: "9999-12-31" };

interface Properties {
  filter: Filter;
  missions: readonly MissionSummary[];
  onChange: (filter: Filter) => void;
}

export function LibraryFilter({ filter, missions, onChange }: Properties) {
  const set = (changes: Partial<Filter>) => {
    const next = { ...filter, ...changes };
    const same = (Object.keys(ANY) as (keyof Filter)[]).every((key) => next[key] === ANY[key]);
    onChange(same ? ANY : next);
  };
  const field = (
    label: MessageKey,
    key: "emitter" | "vehicle" | "since" | "until",
    more: JSX.HTMLAttributes<HTMLInputElement> & { type?: string },
  ) => (
    <label>
      {t(label)}
      <input {...more} data-testid={`filter-${key}`} value={filter[key]} onInput={(e) => set({ [key]: e.currentTarget.value })} />
    </label>
  );
  const around = boundsOf(missions.flatMap((m) => m.sketch.outline.flat() as LonLat[]));
  return (
    <details class="library-filter" data-testid="library-filter">
      <summary>{t("missions.filter")}</summary>
      <div class="filter-fields">
        {field("missions.filter.emitter", "emitter", {})}
        {field("missions.filter.vehicle", "vehicle", {})}
        {field("missions.filter.since", "since", DAY)}
        {field("missions.filter.until", "until", DAY)}
        <label>
          {t("missions.filter.outcome")}
          <select data-testid="filter-outcome" value={filter.outcome} onChange={(e) => set({ outcome: e.currentTarget.value })}>
            <option value="">{t("calibration.any")}</option>
            {OUTCOMES.map((one) => (
              <option value={one} key={one}>
                {t(`outcome.${one}`)}
              </option>
            ))}
          </select>
        </label>
        <label class="check">
          <input
            type="checkbox"
            data-testid="filter-deleted"
            checked={filter.deleted}
            onChange={(e) => set({ deleted: e.currentTarget.checked })}
          />
          {t("missions.filter.deleted")}
        </label>
        {filter !== ANY && (
          <button type="button" data-testid="filter-clear" onClick={() => onChange(ANY)}>
            {t("missions.filter.clear")}
          </button>
        )}
      </div>
      <PlaceFilter around={around} missions={missions} box={filter.box} onBox={(box) => set({ box })} />
    </details>
  );
}
