// A button that sends a file as the body of a request, with its progress.
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { upload } from "../sources/upload";
import { me } from "../state/session";
import type { Problem } from "../wire";

/** By person and path: who says what is wrong on the page that is open now, and what was refused after it was left. */
const tellers = new Map<string, (p: Problem) => void>();
const unsaid = new Map<string, Problem>();

/** Says what is wrong with uploads to a path, wherever it is open by then or when it is opened next: to the same person. */
export function useTeller(path: string, onProblem: (p: Problem | null) => void): (p: Problem) => void {
  const key = `${me.value?.person_id} ${path}`;
  useEffect(() => {
    const before = unsaid.get(key);
    if (before) onProblem(before);
    unsaid.delete(key);
    tellers.set(key, onProblem);
    return () => void tellers.delete(key);
  }, [key]);
  return (problem) => (tellers.get(key) ?? ((unheard) => unsaid.set(key, unheard)))(problem);
}

export function Upload({
  path,
  testId,
  accept,
  label,
  primary = true,
  onDone,
  onProblem,
}: {
  /** Of the endpoint; the file's name is added. */
  path: string;
  testId: string;
  accept: string;
  label: string;
  primary?: boolean;
  onDone: () => void;
  onProblem: (p: Problem | null) => void;
}) {
  const [progress, setProgress] = useState<{ name: string; percent: number } | null>(null);
  const tell = useTeller(path, onProblem);
  return (
    <>
      <label class={primary ? "button primary" : "button"}>
        {label}
        <input
          class="visually-hidden"
          type="file"
          accept={accept}
          data-testid={testId}
          onChange={(e) => {
            const file = e.currentTarget.files?.[0];
            e.currentTarget.value = "";
            if (!file) return;
            onProblem(null);
            setProgress({ name: file.name, percent: 0 });
            upload(`${path}?filename=${encodeURIComponent(file.name)}`, file, (share) =>
              setProgress({ name: file.name, percent: Math.round(100 * share) }),
            )
              .then(onDone, (error: unknown) => tell(asProblem(error)))
              .finally(() => setProgress(null));
          }}
        />
      </label>
      {progress && (
        <span role="status">
          {t("maps.uploading", progress)} <progress max={100} value={progress.percent} aria-label={progress.name} />
        </span>
      )}
    </>
  );
}
