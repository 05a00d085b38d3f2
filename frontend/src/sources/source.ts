// Where the picture comes from. Panels see messages and cannot tell a live mission from a recording.
import type { AreaImport, Command, CommandReply, CraftCommand, ExpectedTime, LiveMessage, Place, PreflightReply, Track } from "../wire";
import type { BeliefFrame } from "../wire/beliefFrame";
import type { Sending } from "./api";

export interface BeliefMessage {
  type: "belief";
  frame: BeliefFrame;
}

export interface LinkMessage {
  type: "link";
  state: "connecting" | "open" | "closed";
  attempt: number;
}

/** Something arrived that could not be read: counted and shown, never dropped silently. */
export interface UnreadableMessage {
  type: "unreadable";
  detail: string;
}

/** The server has no such mission; the source says nothing more. */
export interface GoneMessage {
  type: "gone";
  missionId: string;
}

export type SourceMessage = LiveMessage | BeliefMessage | LinkMessage | UnreadableMessage | GoneMessage;

export interface Source {
  readonly missionId: string | null;
  /** What the vehicle tells belongs to the mission shown. */
  readonly happensNow: boolean;
  /** The mission shown has a vehicle that abort, hold and return reach. */
  readonly takesCommands: boolean;
  /** The server keeps the mission shown: recordings, antenna check, another area, what-if and the 3D scene are to be had. */
  readonly keptByServer: boolean;
  start(listener: (message: SourceMessage) => void): void;
  stop(): void;
  send(missionId: string, command: Command, sending?: Sending): Promise<CommandReply>;
  /** To a craft in the air that flies for no mission. */
  order(craftId: string, command: CraftCommand, sending?: Sending): Promise<CommandReply>;
  /** The belief about an emitter that stood at the event `seq`; null when it is not to be had. */
  belief(missionId: string, emitterId: string, seq: number): Promise<BeliefFrame | null>;
  track(missionId: string, craftId: string): Promise<Track>;
  preflight(missionId: string): Promise<PreflightReply>;
  expectedTime(missionId: string, place: Place, signal?: AbortSignal, insteadOf?: Place | null): Promise<ExpectedTime>;
  importArea(text: string, filename: string): Promise<AreaImport>;
}
