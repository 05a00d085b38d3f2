// Who steers the search shown, as seen by whoever is signed in here. Without accounts there is nothing to say.
import { computed } from "@preact/signals";
import { live, source } from "./connection";
import type { Control } from "./mission";
import { me } from "./session";

/** An operator may take what was asked for and not answered (backend/mission/control.py says the same). */
export const UNANSWERED_S = 30;

export interface ControlView {
  control: Control;
  missionId: string;
  mine: boolean;
  /** Somebody waits for the answer of whoever is signed in here. */
  asksMe: boolean;
  askedByMe: boolean;
}

export const controlView = computed<ControlView | null>(() => {
  const person = me.value;
  const { control, missionId, ended } = live.value.mission;
  if (person === null || missionId === null || ended !== null || !source.value?.takesCommands) return null;
  const mine = control.holder?.person === person.person_id;
  return {
    control,
    missionId,
    mine,
    asksMe: mine && control.asked !== null,
    askedByMe: control.asked?.person === person.person_id,
  };
});

/** The number that an order to this mission is given under. */
export const fenceOf = (missionId: string): number | null => {
  const view = controlView.peek();
  return view?.missionId === missionId && view.mine ? view.control.fence : null;
};
