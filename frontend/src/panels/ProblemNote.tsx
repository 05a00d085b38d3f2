// The server's no, in its words: what is wrong, what to do.
import { t, told } from "../i18n";
import { problems, report, type Desk } from "../commands/send";
import type { Problem } from "../wire";

export function ProblemText({ problem }: { problem: Problem }) {
  return (
    <>
      <strong>{told(problem.title)}.</strong> {told(problem.detail)}
      {problem.errors.map((e) => (
        <div class="problem-field" key={e.field}>
          {e.field}: {told(e.message)}
        </div>
      ))}
      {problem.remedy && <div class="problem-remedy">{t("problem.remedy", { remedy: told(problem.remedy) })}</div>}
      {problem.incident && <div class="muted">{t("problem.incident", { id: problem.incident })}</div>}
    </>
  );
}

interface Boxed {
  problem: Problem;
  testId?: string;
  onDismiss?: () => void;
}

export function ProblemBox({ problem, testId, onDismiss }: Boxed) {
  return (
    <div class="problem" role="alert" data-testid={testId}>
      <div>
        <ProblemText problem={problem} />
      </div>
      {onDismiss && (
        <button class="icon" aria-label={t("problem.dismiss")} onClick={onDismiss}>
          ✕
        </button>
      )}
    </div>
  );
}

export function ProblemNote({ desk }: { desk: Desk }) {
  const problem = problems.value[desk];
  return problem ? <ProblemBox problem={problem} testId={`problem-${desk}`} onDismiss={() => report(desk, null)} /> : null;
}
