// German for every reason, by room; a missing one does not compile.
import { access } from "./german/access";
import { datagrams } from "./german/datagrams";
import { flight } from "./german/flight";
import { maps } from "./german/maps";
import { payload } from "./german/payload";
import { planner } from "./german/planner";
import { preflight } from "./german/preflight";
import { receiver } from "./german/receiver";
import { recording } from "./german/recording";
import { safety } from "./german/safety";
import { server } from "./german/server";
import { sweep } from "./german/sweep";
import { terrain } from "./german/terrain";
import { turning } from "./german/turning";
import { vehicle } from "./german/vehicle";
import { ways } from "./german/ways";
import type { ReasonTable } from "./reasons";

export const reasonsDe: ReasonTable = {
  ...planner,
  ...receiver,
  ...payload,
  ...sweep,
  ...turning,
  ...recording,
  ...vehicle,
  ...preflight,
  ...datagrams,
  ...flight,
  ...safety,
  ...maps,
  ...terrain,
  ...server,
  ...access,
  ...ways,
};
