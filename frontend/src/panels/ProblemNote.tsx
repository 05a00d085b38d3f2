// A no: what is wrong, in which field, what to do.

import { type Desk, problems, report } from "../commands/send";
import { type MessageKey, reasonRemedy, reasonText, t } from "../i18n";
import type { Problem } from "../wire";

/** The server's title for each status, in the page's language. */
const TITLES: Readonly<Record<number, MessageKey>> = {
  403: "problem.403",
  404: "problem.404",
  405: "problem.405",
  409: "problem.409",
  413: "problem.413",
  421: "problem.421",
  422: "problem.422",
  500: "problem.500",
  503: "problem.503",
  507: "problem.507",
};

/** A problem that the page found by itself has no reason: its words are the page's already. */
const detailOf = ({ reason, detail }: Problem): string => (reason ? reasonText(reason) : detail);
const remedyOf = ({ reason, remedy }: Problem): string => (reason ? reasonRemedy(reason) : remedy);

/** What is wrong and what to do, within a sentence that names what it is about. */
export const problemWords = (problem: Problem): string => `${detailOf(problem)} ${remedyOf(problem)}`.trim();

export function ProblemText({ problem }: { problem: Problem }) {
  const title = problem.reason && TITLES[problem.status];
  const remedy = remedyOf(problem);
  const saysMore = (e: Problem["errors"][number]) => reasonText(e.reason) !== detailOf(problem);
  const isAllInFields = problem.reason?.code === "request_invalid" && problem.errors.length > 0;
  return (
    <>
      <strong>{title ? t(title) : problem.title}.</strong> {!isAllInFields && detailOf(problem)}
      {problem.errors.filter(saysMore).map((e) => (
        <div class="problem-field" key={e.field}>
          {e.field}: {reasonText(e.reason)}
        </div>
      ))}
      {remedy && <div class="problem-remedy">{t("problem.remedy", { remedy })}</div>}
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
        <button type="button" class="icon" aria-label={t("problem.dismiss")} onClick={onDismiss}>
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
