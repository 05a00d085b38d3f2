// Apart from what reads and plays them, which the safety bar does not wait for.
import { t } from "../i18n";
import { localProblem, RequestFailed } from "./problem";
import type { ReplaySource } from "./replay";

/** Recordings opened in this tab, by mission id. */
export const replays = new Map<string, ReplaySource>();

/** A recording takes no commands and answers no questions about what might be. */
export function refuse(): never {
  throw new RequestFailed(localProblem(t("problem.refused"), t("problem.recording"), 409));
}
