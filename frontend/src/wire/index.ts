// The wire's words under their own names; everything comes from the generated types.
import type { components } from "./generated";

type Schemas = components["schemas"];

export type MissionSpec = Schemas["MissionSpec"];
export type Place = Schemas["Place"];
export type Polygon = Schemas["Polygon"];
export type MultiPolygon = Schemas["MultiPolygon"];
export type Area = Polygon | MultiPolygon;

export type Reason = Schemas["Reason"];
export type ReasonCode = Reason["code"];

export type Recorded = Schemas["Recorded"];
export type MissionEvent = Recorded["event"];
export type EventKind = MissionEvent["kind"];
export type EventOf<K extends EventKind> = Extract<MissionEvent, { kind: K }>;
/** What a craft does. */
export type Phase = Schemas["PhaseChanged"]["after"];
/** A mission in one word: what its craft does while one flies, else the stage of its search. */
export type MissionPhase = Schemas["MissionSummary"]["phase"];
export type Authority = Schemas["Authority"];
export type EmitterSpec = Schemas["EmitterSpec"];
export type PlanChosen = Schemas["PlanChosen"];
export type CandidateFact = Schemas["CandidateFact"];
export type CheckFact = Schemas["CheckFact"];
export type BearingMeasured = Schemas["BearingMeasured"];
export type BearingSource = BearingMeasured["source"];
export type HeardOnTheWay = Schemas["HeardOnTheWay"];
export type SweepRejected = Schemas["SweepRejected"];
export type BeliefUpdated = Schemas["BeliefUpdated"];
export type EstimateFact = Schemas["EstimateFact"];
export type TruthNoted = Schemas["TruthNoted"];
export type MissionEnded = Schemas["MissionEnded"];
export type SourceErrors = Schemas["SourceErrorsFact"];
export type LinkName = Schemas["LinkLost"]["link"];
export type AlertLevel = Schemas["AlertRaised"]["level"];
export type AlertTopic = Schemas["AlertRaised"]["topic"];

export type Hello = Schemas["Hello"];
export type EventMessage = Schemas["EventMessage"];
export type TelemetryMessage = Schemas["TelemetryMessage"];
export type SweepProgress = Schemas["SweepProgress"];
export type StatusMessage = Schemas["StatusMessage"];
export type CraftStatus = Schemas["CraftStatusMessage"];
export type LiveMessage = Hello | EventMessage | TelemetryMessage | SweepProgress | StatusMessage;

export type CommandRequest = Schemas["CommandRequest"];
export type Command = CommandRequest["command"];
/** To a craft in the air, in a mission or in none. */
export type CraftRequest = Schemas["CraftRequest"];
export type CraftCommand = CraftRequest["command"];
export type Holder = Schemas["Holder"];
export type CommandReply = Schemas["CommandReply"];

/** reason null: found by the page itself, and said in its own words. */
export type Problem = Omit<Schemas["Problem"], "reason"> & { reason: Reason | null };
export type CompassKnown = Schemas["CompassKnown"];
export type Defaults = Schemas["Defaults"];
export type MissionBrought = Schemas["MissionBrought"];
export type MissionSummary = Schemas["MissionSummary"];
export type Mission = Schemas["Mission"];
export type MissionList = Schemas["MissionList"];
export type PreflightReply = Schemas["PreflightReply"];
export type EventPage = Schemas["EventPage"];
export type Track = Schemas["Track"];
export type TrackFact = Schemas["TrackFact"];
export type ExportedMission = Schemas["ExportedMission"];
export type ExpectedTime = Schemas["ExpectedTime"];
export type Preview = Schemas["Preview"];
export type AntennaReview = Schemas["AntennaReview"];
export type WhatIf = Schemas["WhatIf"];
/** What is not named is as it was flown. */
export type WhatIfRequest = Partial<Schemas["WhatIfRequest"]> & Pick<Schemas["WhatIfRequest"], "bearings">;
export type SearchArea = Schemas["SearchArea"];
export type AreaOutlook = Schemas["AreaOutlook"];
export type AreaImport = Schemas["AreaImport"];
export type RecordingImport = Schemas["RecordingImport"];
export type PayloadList = Schemas["PayloadList"];
export type Health = Schemas["Health"];
