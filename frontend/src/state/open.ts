// Showing another source: it speaks from now on, and the page looks at the present, at its first craft and emitter.
import { batch } from "@preact/signals";
import type { Source } from "../sources/source";
import { connect } from "./connection";
import { cursor } from "./moment";
import { selectedCraft, selectedEmitter } from "./selection";
import { supposed } from "./supposed";

export function open(next: Source): void {
  batch(() => {
    cursor.value = null;
    supposed.value = null;
    selectedCraft.value = null;
    selectedEmitter.value = null;
    connect(next);
  });
}
