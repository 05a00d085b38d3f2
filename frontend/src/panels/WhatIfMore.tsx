// What else may be otherwise in a what-if: bearings left out, model of errors, estimate, rollouts; and keeping it by name.
import { signal } from "@preact/signals";
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { type MessageKey, t } from "../i18n";
import { keepVariant, type Supposition } from "../sources/coursesApi";
import { mission } from "../state/shown";
import { flownBearings } from "../state/supposed";
import { formatBearing } from "../units/quantities";
import type { Problem } from "../wire";
import { ProblemBox } from "./ProblemNote";

type Estimator = NonNullable<Supposition["estimator"]>;
type Errors = NonNullable<Supposition["bearing_errors"]>;

const without = signal<readonly string[]>([]);
const estimator = signal<Estimator | "">("");
const errors = signal<Errors | "">("");
const budget = signal("");

const ESTIMATORS = ["map", "expected_value", "geometric_median"] as const satisfies Estimator[];
const ERRORS = ["independent", "joint"] as const satisfies Errors[];

export const isBudgetUnread = (): boolean => !/^\s*\d*\s*$/.test(budget.value);

/** The fields below, in the words of the question; a bearing of another moment or mission is not named. */
export function furtherWishes(): Pick<Supposition, "without" | "estimator" | "bearing_errors" | "budget"> {
  const known = new Set(flownBearings.value.map((b) => b.bearing_id));
  const rollouts = Number.parseInt(budget.value, 10);
  return {
    without: without.value.filter((id) => known.has(id)),
    estimator: estimator.value || null,
    bearing_errors: errors.value || null,
    budget: Number.isNaN(rollouts) ? null : rollouts,
  };
}

function LeaveOut() {
  const toggled = (id: string) => (without.value.includes(id) ? without.value.filter((one) => one !== id) : [...without.value, id]);
  return (
    <fieldset class="leave-out" data-testid="what-if-without">
      <legend>{t("whatIf.without")}</legend>
      {flownBearings.value.map((fact) => (
        <label class="check" key={fact.bearing_id}>
          <input
            type="checkbox"
            checked={without.value.includes(fact.bearing_id)}
            onChange={() => (without.value = toggled(fact.bearing_id))}
          />
          {fact.source.kind === "person" ? fact.source.name : fact.place_number}: {formatBearing(fact.bearing_deg)}
        </label>
      ))}
    </fieldset>
  );
}

export function FurtherWishes() {
  return (
    <>
      <label>
        {t("whatIf.errors")}
        <select data-testid="what-if-errors" value={errors.value} onChange={(e) => (errors.value = e.currentTarget.value as Errors | "")}>
          <option value="">{t("whatIf.planner.flown")}</option>
          {ERRORS.map((name) => (
            <option value={name} key={name}>
              {t(`edit.bearingErrors.${name}` satisfies MessageKey)}
            </option>
          ))}
        </select>
      </label>
      <label>
        {t("edit.estimator")}
        <select
          data-testid="what-if-estimator"
          value={estimator.value}
          onChange={(e) => (estimator.value = e.currentTarget.value as Estimator | "")}
        >
          <option value="">{t("whatIf.planner.flown")}</option>
          {ESTIMATORS.map((name) => (
            <option value={name} key={name}>
              {t(`edit.estimator.${name}` satisfies MessageKey)}
            </option>
          ))}
        </select>
      </label>
      <label>
        {t("edit.budget")}
        <input
          data-testid="what-if-budget"
          inputMode="numeric"
          placeholder={String(mission.value.spec?.planner.budget ?? "")}
          value={budget.value}
          aria-invalid={isBudgetUnread()}
          onInput={(e) => (budget.value = e.currentTarget.value)}
        />
      </label>
      <LeaveOut />
    </>
  );
}

/** Under a name, beside the mission. asked: the question as it stands. */
export function KeepVariant({ missionId, asked }: { missionId: string; asked: () => Promise<Supposition> }) {
  const [name, setName] = useState("");
  const [kept, setKept] = useState<string | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const keep = async () => {
    setProblem(null);
    try {
      await keepVariant(missionId, name.trim(), await asked());
      setKept(name.trim());
      setName("");
    } catch (error) {
      setProblem(asProblem(error));
    }
  };
  return (
    <form
      class="decision"
      onSubmit={(e) => {
        e.preventDefault();
        void keep();
      }}
    >
      <input
        data-testid="variant-name"
        aria-label={t("whatIf.keepName")}
        placeholder={t("whatIf.keepName")}
        maxLength={60}
        value={name}
        onInput={(e) => setName(e.currentTarget.value.replaceAll("/", "-"))} // its address has the name in it
      />
      <button type="submit" data-testid="keep-variant" disabled={isBudgetUnread() || /^\s*\.*\s*$/.test(name)}>
        {t("whatIf.keep")}
      </button>
      <a class="button" href={`#/compare/${encodeURIComponent(missionId)}`} data-testid="open-compare">
        {t("missions.compare")}
      </a>
      {kept !== null && <p role="status">{t("whatIf.kept", { name: kept })}</p>}
      {problem && <ProblemBox problem={problem} />}
    </form>
  );
}
