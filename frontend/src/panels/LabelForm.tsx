// Name, tags and notes of a mission in the list; deleting it, and bringing it back.
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { label, remove, restore } from "../sources/libraryApi";
import type { MissionSummary, Problem } from "../wire";
import { ProblemBox } from "./ProblemNote";

/** What was typed and is not saved yet, by mission: the form closes when another row's is opened. */
const unsaved = new Map<string, { name?: string; tags?: string; notes?: string }>();

export function LabelForm({ mission, onDone }: { mission: MissionSummary; onDone: () => void }) {
  const { mission_id: id, deleted_at_utc: deleted } = mission;
  const [typed, setTyped] = useState(unsaved.get(id) ?? {});
  const [problem, setProblem] = useState<Problem | null>(null);
  const [sending, setSending] = useState(false);
  const { name, tags, notes } = { name: mission.name, tags: mission.tags.join(", "), notes: mission.notes, ...typed };
  const type = (changes: Partial<typeof typed>) => {
    const next = { ...typed, ...changes };
    unsaved.set(id, next);
    setTyped(next);
  };
  const after = (done: Promise<unknown>) => {
    setSending(true); // what is typed meanwhile would not be sent
    done.then(onDone, (error: unknown) => {
      setProblem(asProblem(error));
      setSending(false);
    });
  };
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
      inert={sending}
      onSubmit={(e) => {
        e.preventDefault();
        after(label(id, labels()).then(() => unsaved.delete(id)));
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
          data-testid={deleted ? "restore-mission" : "delete-mission"}
          onClick={() => after(deleted ? restore(id) : remove(id))}
        >
          {t(deleted ? "missions.restore" : "missions.delete")}
        </button>
        <button type="submit" class="primary" data-testid="label-save" disabled={name.trim() === ""}>
          {t("missions.save")}
        </button>
      </div>
      {!deleted && <p class="muted">{t("missions.deleteHint")}</p>}
    </form>
  );
}
