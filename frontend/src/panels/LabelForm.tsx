// Name, tags and notes of a mission in the list; deleting it, and bringing it back.
import { useRef, useState } from "preact/hooks";
import { asProblem, report } from "../commands/send";
import { type MessageKey, t } from "../i18n";
import { label, remove, restore } from "../sources/libraryApi";
import { localProblem } from "../sources/problem";
import type { MissionSummary, Problem } from "../wire";
import { ProblemBox, problemWords } from "./ProblemNote";

/** What was typed and is not saved yet, by mission: the form closes when another row's is opened. */
const unsaved = new Map<string, { name?: string; tags?: string; notes?: string }>();

export function LabelForm({ mission, onDone }: { mission: MissionSummary; onDone: () => void }) {
  const { mission_id: id, deleted_at_utc: deleted } = mission;
  const [typed, setTyped] = useState(unsaved.get(id) ?? {});
  const [problem, setProblem] = useState<Problem | null>(null);
  const [sending, setSending] = useState<MessageKey | null>(null);
  const { name, tags, notes } = { name: mission.name, tags: mission.tags.join(", "), notes: mission.notes, ...typed };
  const type = (changes: Partial<typeof typed>) => {
    const next = { ...typed, ...changes };
    unsaved.set(id, next);
    setTyped(next);
  };
  const form = useRef<HTMLFormElement>(null);
  const after = (what: MessageKey, done: Promise<unknown>) => {
    setSending(what); // what is typed meanwhile would not be sent
    done.then(
      () => {
        if (unsaved.get(id) === typed) unsaved.delete(id);
        if (form.current) onDone();
      },
      (error: unknown) => {
        const failed = asProblem(error);
        if (!form.current) report("bar", localProblem(`${t(what)}: ${name}`, problemWords(failed)));
        setProblem(failed);
        setSending(null);
      },
    );
  };
  const ending = deleted ? "missions.restore" : "missions.delete";
  const labels = () => ({
    name,
    notes,
    tags: tags
      .split(",")
      .map((tag) => tag.trim())
      .filter(Boolean),
  });
  return (
    <form
      class="label-form"
      data-testid="label-form"
      ref={form}
      inert={sending !== null}
      onSubmit={(e) => {
        e.preventDefault();
        after("missions.save", label(id, labels()));
      }}
    >
      <label>
        {t("missions.name")}
        <input data-testid="label-name" value={name} onInput={(e) => type({ name: e.currentTarget.value })} />
      </label>
      <label>
        {t("missions.tags")}
        <input data-testid="label-tags" value={tags} onInput={(e) => type({ tags: e.currentTarget.value })} />
      </label>
      <label>
        {t("missions.notes")}
        <textarea data-testid="label-notes" rows={3} value={notes} onInput={(e) => type({ notes: e.currentTarget.value })} />
      </label>
      {problem && <ProblemBox problem={problem} />}
      <div class="row-actions">
        <button
          type="button"
          class={deleted ? "" : "remove"}
          disabled={sending !== null}
          data-testid={deleted ? "restore-mission" : "delete-mission"}
          onClick={() => after(ending, deleted ? restore(id) : remove(id))}
        >
          {t(ending)}
        </button>
        <button
          type="button"
          data-testid="label-discard"
          disabled={sending !== null}
          onClick={() => {
            unsaved.delete(id);
            onDone();
          }}
        >
          {t("slide.cancel")}
        </button>
        <button type="submit" class="primary" data-testid="label-save" disabled={sending !== null || name.trim() === ""}>
          {t(sending === "missions.save" ? "edit.saving" : "missions.save")}
        </button>
      </div>
      {!deleted && <p class="muted">{t("missions.deleteHint")}</p>}
    </form>
  );
}
