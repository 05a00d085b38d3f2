// A button that sends a file as the body of a request, with its progress.
import { useEffect, useRef, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { t } from "../i18n";
import { upload } from "../sources/upload";
import type { Problem } from "../wire";

/** What was refused after its page was left, by path: said when that is opened again. */
const unsaid = new Map<string, Problem>();

/** Says what is wrong with uploads to a path, to whoever is on their page, now or next time. */
export function useTeller(path: string, onProblem: (p: Problem | null) => void): (p: Problem) => void {
  const isLeft = useRef(false);
  useEffect(() => {
    const before = unsaid.get(path);
    if (before) onProblem(before);
    unsaid.delete(path);
    return () => {
      isLeft.current = true;
    };
  }, []);
  return (problem) => void (isLeft.current ? unsaid.set(path, problem) : onProblem(problem));
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
