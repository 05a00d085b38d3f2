// Which source shows a mission: the recorded example, a recording opened in this tab, else the server.
import { EXAMPLE_ID, ExampleSource } from "../sources/example";
import { LiveSource } from "../sources/live";
import { replays } from "../sources/replays";
import type { Source } from "../sources/source";
import { settings } from "../state/settings";

export function sourceFor(missionId: string | null): Source {
  if (missionId === EXAMPLE_ID) return new ExampleSource();
  const recording = missionId === null ? undefined : replays.get(missionId);
  return recording ?? new LiveSource(missionId, settings.peek().lite);
}
