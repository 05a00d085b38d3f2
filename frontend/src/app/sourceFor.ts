// Which source shows a mission: the server, or the built-in example when the address asks for it.
import { LiveSource } from "../sources/live";
import { replays } from "../sources/replay";
import type { Source } from "../sources/source";
import { settings } from "./settings";

export const isFixture = new URLSearchParams(location.search).has("fixture");

let makeFixture: ((missionId: string | null) => Source) | null = null;

export async function prepareFixture(): Promise<void> {
  const { FixtureSource } = await import("../sources/fixture");
  makeFixture = (missionId) => new FixtureSource(missionId);
}

export function sourceFor(missionId: string | null): Source {
  if (makeFixture) return makeFixture(missionId);
  const recording = missionId === null ? undefined : replays.get(missionId);
  return recording ?? new LiveSource(missionId, settings.peek().lite);
}
