// The suggested search, drafted: what nobody has to fill in, and what a server without missions begins with.
import { signal } from "@preact/signals";
import { t } from "../i18n";
import * as api from "../sources/api";
import { missionAddress } from "../state/route";
import type { MissionSpec } from "../wire";

/** The mission that shows the slide as soon as its checks have passed; nothing moves before somebody slides. */
export const slideNext = signal<string | null>(null);

/** The server's, named in the page's language. */
export async function suggestedSpec(): Promise<MissionSpec> {
  return { ...((await api.defaults()).spec as MissionSpec), name: t("menu.new") };
}

/** Where it is shown. */
export async function draftSuggested(): Promise<string> {
  const { mission_id: id } = await api.draftMission(await suggestedSpec());
  slideNext.value = id;
  return missionAddress(id);
}

/** Where somebody begins who was let in just now: at the first mission of a server that has none, if they may fly it. */
export async function firstPlace(mayFly: boolean): Promise<string> {
  try {
    return mayFly && (await api.missions({}, null)).missions.length === 0 ? await draftSuggested() : "#/";
  } catch {
    return "#/"; // the list says itself what is wrong
  }
}
