// The altitude band, judged while it is typed: in the same words as the server, which refuses a draft outside it.
import { reasonText } from "../i18n";
import type { MissionSpec } from "../wire";

/** What is wrong with the altitude that is flown; null when it lies within the band. */
export function bandMessage({ flight }: MissionSpec): string | null {
  const { altitude_relative_m, minimum_altitude_relative_m: lowest, maximum_altitude_relative_m: highest } = flight;
  if (lowest <= altitude_relative_m && altitude_relative_m <= highest) return null;
  return reasonText({ code: "altitude_outside", altitude_relative_m, lowest_relative_m: lowest, highest_relative_m: highest });
}
