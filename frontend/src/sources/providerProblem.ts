// What the way back from the sign-in provider says in the page's address. Only faults that the server has: an address
// that somebody else made up puts no words of theirs on the page.
import type { Problem, Reason } from "../wire";
import { refusal } from "./problem";

type ProviderRefused = Extract<Reason, { code: "provider_refused" }>;
export type Fault = ProviderRefused["fault"];

const FAULTS: Readonly<Record<Fault, true>> = {
  return: true,
  refused: true,
  away: true,
  answer: true,
  clock: true,
  email: true,
  role: true,
  shut_out: true,
};

export const faultOf = (word: string): Fault | null => (Object.hasOwn(FAULTS, word) ? (word as Fault) : null);

export const providerProblem = (fault: Fault): Problem => refusal({ code: "provider_refused", fault });
