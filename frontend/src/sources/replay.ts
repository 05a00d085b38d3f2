// A recording: a mission's journal as exported (JSON), shown through the same interface as a live one. The safety bar
// above it stays the server's: what flies meanwhile is seen, and stopped, from here too.
import type { Command, CommandReply, ExpectedTime, ExportedMission, PreflightReply, Track } from "../wire";
import * as api from "./api";
import { LiveSource } from "./live";
import { refuse } from "./replays";
import type { Source, SourceMessage } from "./source";

/** Reads an exported journal, of any age: the server knows all its forms. Raises RequestFailed when it is something else. */
export async function readRecording(text: string, server?: Server): Promise<ReplaySource> {
  return new ReplaySource(await api.readExported(text), server);
}

/** What the server tells besides missions: its link, the vehicle, what flies. */
type Server = Pick<Source, "start" | "stop">;

export class ReplaySource implements Source {
  readonly happensNow = false;
  readonly takesCommands = false;
  readonly keptByServer = false;
  readonly missionId: string;

  constructor(
    private readonly exported: ExportedMission,
    private readonly server: Server = new LiveSource(null, false),
  ) {
    this.missionId = exported.mission_id;
  }

  start(listener: (message: SourceMessage) => void): void {
    const { events } = this.exported;
    const last = events.at(-1)?.seq ?? 0;
    listener({ type: "hello", server_version: "", mission_id: this.missionId, last_seq: last, time_factor: 1 });
    for (const recorded of events) listener({ type: "event", recorded });
    this.server.start((message) => {
      if (message.type === "link" || message.type === "telemetry" || message.type === "status") listener(message);
    });
  }

  stop(): void {
    this.server.stop();
  }

  /** The server rebuilds beliefs of missions it knows; for others the picture stays empty. */
  belief = api.belief;
  async track(missionId: string, craftId: string): Promise<Track> {
    const own = this.exported.tracks.find(({ craft_id }) => craft_id === craftId);
    return own ?? { mission_id: missionId, craft_id: craftId, points: [] };
  }
  order = api.orderCraft;
  /** The recorded mission takes no commands; one that flies meanwhile does, and the orders of the bar always go out. */
  async send(missionId: string, command: Command, sending?: api.Sending): Promise<CommandReply> {
    const urgent = ["abort", "hold", "return", "land"].includes(command.kind);
    return urgent || missionId !== this.missionId ? api.sendCommand(missionId, command, sending) : refuse();
  }
  async preflight(): Promise<PreflightReply> {
    return refuse();
  }
  async expectedTime(): Promise<ExpectedTime> {
    return refuse();
  }
  importArea = api.importArea;
}
