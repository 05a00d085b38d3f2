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

export function unreachable(detail: string): RequestFailed {
  return new RequestFailed({
    type: "about:blank",
    title: "The server does not answer",
    status: 0,
    detail,
    remedy: "Check that the server runs and that this device is in its network; nothing you typed is lost.",
    errors: [],
    incident: null,
  });
}
