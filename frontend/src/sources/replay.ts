// A recording: a mission's journal as exported (JSON), shown through the same interface as a live one. The safety bar
// above it stays the server's: what flies meanwhile is seen, and stopped, from here too.
import { t } from "../i18n";
import type { Command, CommandReply, ExpectedTime, PreflightReply, Recorded, Track } from "../wire";
import * as api from "./api";
import { LiveSource } from "./live";
import { localProblem, RequestFailed } from "./problem";
import type { Source, SourceMessage } from "./source";

/** Recordings opened in this tab, by mission id. */
export const replays = new Map<string, ReplaySource>();

export class NotARecording extends Error {}

interface Exported {
  mission_id?: unknown;
  events?: unknown;
  track?: unknown;
}

const isRecorded = (value: unknown): value is Recorded => {
  const candidate = value as Partial<Recorded> | null;
  return typeof candidate?.seq === "number" && typeof candidate.at_utc === "string" && typeof candidate.event === "object";
};

/** Reads the exported journal; says what is missing when it is something else. */
export function readRecording(text: string, server?: Server): ReplaySource {
  let parsed: Exported;
  try {
    parsed = JSON.parse(text) as Exported;
  } catch {
    throw new NotARecording("it is not JSON");
  }
  const events = Array.isArray(parsed) ? (parsed as unknown[]) : parsed.events;
  if (!Array.isArray(events) || events.length === 0) throw new NotARecording("it holds no events");
  const bad = events.findIndex((event) => !isRecorded(event));
  if (bad >= 0) throw new NotARecording(`entry ${bad + 1} is not a recorded event`);
  const recorded = (events as Recorded[]).toSorted((a, b) => a.seq - b.seq);
  const points = Array.isArray(parsed.track) ? (parsed.track as Track["points"]) : ((parsed.track as Track | undefined)?.points ?? []);
  return new ReplaySource(recorded, points, server);
}

function refuse(): never {
  throw new RequestFailed(localProblem(t("problem.refused"), t("problem.recording"), 409));
}

/** What the server tells besides missions: its link, the vehicle, what flies. */
type Server = Pick<Source, "start" | "stop">;

export class ReplaySource implements Source {
  readonly kind = "replay";
  readonly missionId: string;

  constructor(
    private readonly recorded: readonly Recorded[],
    private readonly points: Track["points"],
    private readonly server: Server = new LiveSource(null, false),
  ) {
    this.missionId = recorded[0]!.mission_id;
  }

  start(listener: (message: SourceMessage) => void): void {
    const last = this.recorded.at(-1)!.seq;
    listener({ type: "hello", server_version: "", mission_id: this.missionId, last_seq: last, time_factor: 1 });
    for (const recorded of this.recorded) listener({ type: "event", recorded });
    this.server.start((message) => {
      if (message.type === "link" || message.type === "telemetry" || message.type === "status") listener(message);
    });
  }

  stop(): void {
    this.server.stop();
  }

  /** The server rebuilds beliefs of missions it knows; for others the picture stays empty. */
  belief = api.belief;
  async track(): Promise<Track> {
    return { mission_id: this.missionId, points: this.points };
  }
  /** The recorded mission takes no commands; one that flies meanwhile does, and abort, hold and return always go out. */
  async send(missionId: string, command: Command, commandId?: string): Promise<CommandReply> {
    const urgent = command.kind === "abort" || command.kind === "hold" || command.kind === "return";
    return urgent || missionId !== this.missionId ? api.sendCommand(missionId, command, commandId) : refuse();
  }
  async preflight(): Promise<PreflightReply> {
    return refuse();
  }
  async expectedTime(): Promise<ExpectedTime> {
    return refuse();
  }
  importArea = api.importArea;
}
