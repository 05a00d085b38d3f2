// What else may be otherwise in a what-if: bearings left out, model of errors, estimate, rollouts; and keeping it by name.
import { type Signal, signal } from "@preact/signals";
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
type Evidence = NonNullable<Supposition["sweep_evidence"]>;

const without = signal<readonly string[]>([]);
const estimator = signal<Estimator | "">("");
const errors = signal<Errors | "">("");
const evidence = signal<Evidence | "">("");
const budget = signal("");

const ESTIMATORS = ["map", "expected_value", "geometric_median"] as const satisfies Estimator[];
const ERRORS = ["independent", "joint"] as const satisfies Errors[];
const EVIDENCE = ["peak", "whole"] as const satisfies Evidence[];

export const isBudgetUnread = (): boolean => !/^\s*\d*\s*$/.test(budget.value);

/** The fields below, in the words of the question; a bearing of another moment or mission is not named. */
export function furtherWishes(): Pick<Supposition, "without" | "estimator" | "bearing_errors" | "sweep_evidence" | "budget"> {
  const known = new Set(flownBearings.value.map((b) => b.bearing_id));
  const rollouts = Number.parseInt(budget.value, 10);
  return {
    without: without.value.filter((id) => known.has(id)),
    estimator: estimator.value || null,
    bearing_errors: errors.value || null,
    sweep_evidence: evidence.value || null,
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

interface Choosing<Value extends string> {
  part: string;
  label: MessageKey;
  chosen: Signal<Value | "">;
  options: readonly Value[];
  words: (option: Value) => MessageKey;
}

/** As it was flown, or one of these. */
export function Choice<Value extends string>({ part, label, chosen, options, words }: Choosing<Value>) {
  return (
    <label>
      {t(label)}
      <select data-testid={`what-if-${part}`} value={chosen.value} onChange={(e) => (chosen.value = e.currentTarget.value as Value | "")}>
        <option value="">{t("whatIf.planner.flown")}</option>
        {options.map((option) => (
          <option value={option} key={option}>
            {t(words(option))}
          </option>
        ))}
      </select>
    </label>
  );
}

interface Typing {
  part: string;
  label: MessageKey;
  flown: string | number | undefined;
  typed: Signal<string>;
  unread?: boolean;
}

/** A number; empty: as it was flown. */
export function Typed({ part, label, flown, typed, unread }: Typing) {
  return (
    <label>
      {t(label)}
      <input
        data-testid={`what-if-${part}`}
        inputMode="decimal"
        placeholder={`${flown ?? ""}`}
        value={typed.value}
        aria-invalid={unread}
        onInput={(e) => (typed.value = e.currentTarget.value)}
      />
    </label>
  );
}

export function FurtherWishes() {
  return (
    <>
      <Choice part="errors" label="whatIf.errors" chosen={errors} options={ERRORS} words={(one) => `edit.bearingErrors.${one}`} />
      <Choice
        part="evidence"
        label="edit.sweepEvidence"
        chosen={evidence}
        options={EVIDENCE}
        words={(one) => `edit.sweepEvidence.${one}`}
      />
      <Choice part="estimator" label="edit.estimator" chosen={estimator} options={ESTIMATORS} words={(one) => `edit.estimator.${one}`} />
      <Typed part="budget" label="edit.budget" flown={mission.value.spec?.planner.budget} typed={budget} unread={isBudgetUnread()} />
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
