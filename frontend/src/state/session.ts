// Who is signed in here. Unknown until the server has said so; when it cannot be reached the page goes on as it was.
import { computed, signal } from "@preact/signals";
import { session as ask, type SessionState, type SignedIn } from "../sources/accessApi";

/** null: not known yet. "unreachable": the server has never answered. */
export const session = signal<SessionState | "unreachable" | null>(null);

/** null: nobody is signed in, or nobody has to be. */
export const me = computed<SignedIn | null>(() => (typeof session.value === "string" ? null : (session.value?.person ?? null)));

/** Nothing of this server is shown before somebody has signed in. */
export const entered = computed<"unknown" | "in" | "out">(() => {
  const now = session.value;
  if (now === null) return "unknown";
  return now === "unreachable" || now.mode === "alone" || now.person !== null ? "in" : "out";
});

let asking: Promise<void> | null = null;

export function refreshSession(): Promise<void> {
  asking ??= ask()
    .then(
      (found) => {
        session.value = found;
      },
      () => {
        session.value ??= "unreachable";
      },
    )
    .finally(() => {
      asking = null;
    });
  return asking;
}
