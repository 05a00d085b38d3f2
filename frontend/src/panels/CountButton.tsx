// Leaves something out of the belief, or counts it again.
import { send } from "../commands/send";
import { type MessageKey, t } from "../i18n";

/** of: the bearing, the sweep of a turn that heard nothing, or the leg. */
export function CountButton({ id, of, leftOut, words }: { id: string; of: string; leftOut: boolean; words: MessageKey }) {
  const order = leftOut
    ? ({ kind: "include_bearing", bearing_id: of } as const)
    : ({ kind: "exclude_bearing", bearing_id: of, reason: "" } as const);
  return (
    <button type="button" class="small" data-testid={leftOut ? "include" : "exclude"} onClick={() => void send("sweep", id, order)}>
      {t(words)}
    </button>
  );
}
