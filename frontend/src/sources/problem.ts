import { reasonText, t } from "../i18n";
import type { Problem, Reason } from "../wire";

/** The server said no, or could not be reached: why, what to do, and where in the request it belongs. */
export class RequestFailed extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail || problem.title);
  }
  /** The message that belongs to one field, by its path ("spec.sensor.sigma_deg" or its tail). */
  fieldMessage(path: string): string | null {
    const asked = path.replace(".all.", ".0.");
    const found = this.problem.errors.find((e) => e.field === asked || e.field.endsWith(`.${asked}`));
    return found ? reasonText(found.reason) : null;
  }
}

/** The server's own no; anything else is a link, or a session, that may come back. */
export const isRefusal = (error: unknown): error is RequestFailed =>
  error instanceof RequestFailed && /^4(?!01|08|29)/.test(`${error.problem.status}`);

/** Found by the page itself, before it asks the server. */
export const localProblem = (title: string, detail: string, status = 0): Problem => ({
  type: "about:blank",
  title,
  status,
  detail,
  remedy: "",
  reason: null,
  errors: [],
});

/** A wish that the server took in and said no to. */
export const refusal = (reason: Reason | null): Problem => ({ ...localProblem(t("problem.refused"), "", 200), reason });

export function unreachable(detail: string): RequestFailed {
  return new RequestFailed({ ...localProblem(t("problem.unreachable"), detail), remedy: t("problem.unreachable.remedy") });
}
