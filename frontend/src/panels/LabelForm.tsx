// Name, tags and notes of a mission in the list; deleting it, and bringing it back.
import { useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { label, remove, restore } from "../sources/libraryApi";
import type { MissionSummary, Problem } from "../wire";
import { ProblemBox } from "./ProblemNote";

export function LabelForm({ mission, onDone }: { mission: MissionSummary; onDone: () => void }) {
  const { mission_id: id, deleted_at_utc: deleted } = mission;
  const [name, setName] = useState(mission.name);
  const [tags, setTags] = useState(mission.tags.join(", "));
  const [notes, setNotes] = useState(mission.notes);
  const [problem, setProblem] = useState<Problem | null>(null);
  const after = (done: Promise<unknown>) => void done.then(onDone, (error: unknown) => setProblem(asProblem(error)));
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
      onSubmit={(e) => {
        e.preventDefault();
        after(label(id, labels()));
      }}
    >
      <label>
        {t("missions.name")}
        <input data-testid="label-name" value={name} onInput={(e) => setName(e.currentTarget.value)} />
      </label>
      <label>
        {t("missions.tags")}
        <input data-testid="label-tags" value={tags} onInput={(e) => setTags(e.currentTarget.value)} />
      </label>
      <label>
        {t("missions.notes")}
        <textarea data-testid="label-notes" rows={3} value={notes} onInput={(e) => setNotes(e.currentTarget.value)} />
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
