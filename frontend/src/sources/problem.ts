import type { Problem } from "../wire";

/** The server said no, or could not be reached: a sentence, what to do, and where in the request it belongs. */
export class RequestFailed extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail || problem.title);
  }
  /** The message that belongs to one field, by its path ("spec.sensor.sigma_deg" or its tail). */
  fieldMessage(path: string): string | null {
    const found = this.problem.errors.find((e) => e.field === path || e.field.endsWith(`.${path}`));
    return found?.message ?? null;
  }
}

/** Found by the page itself, before it asks the server. */
export const localProblem = (title: string, detail: string, status = 0): Problem => ({
  type: "about:blank",
  title,
  status,
  detail,
  remedy: "",
  errors: [],
  incident: null,
});

export function unreachable(detail: string): RequestFailed {
  const remedy = "Check that the server runs and that this device is in its network; nothing you typed is lost.";
  return new RequestFailed({ ...localProblem("The server does not answer", detail), remedy });
}
