// The example: a flight recorded from the server (scripts/record_example.py), told again in real time.
// A mission that really flies meanwhile is still seen and stopped from here.
import type { Command, CommandReply, ExpectedTime, LiveMessage, PreflightReply, Track } from "../wire";
import { type BeliefFrame, bytesOf, decodeBeliefFrame } from "../wire/beliefFrame";
import * as api from "./api";
import { LiveSource } from "./live";
import { refuse } from "./replays";
import type { Source, SourceMessage } from "./source";

/** Its mission's id, which no mission of the server has. */
export const EXAMPLE_ID = "example";

/** Seconds since the start of the flight, and what the websocket said; a text is a binary frame in base64. */
export type Said = readonly (readonly [number, LiveMessage | string])[];

const TICK_MS = 50;
/** When the recording ends the vehicle stands at home and goes on saying so. */
const AGAIN_MS = 1000;

const isOfVehicle = (message: SourceMessage) => message.type === "status" || message.type === "telemetry";

async function recordedFlight(): Promise<Said> {
  const response = await fetch("example.json");
  return ((await response.json()) as { said: Said }).said;
}

export class ExampleSource implements Source {
  readonly missionId = EXAMPLE_ID;
  readonly happensNow = true;
  readonly takesCommands = false;
  readonly keptByServer = false;
  private readonly frames: BeliefFrame[] = [];
  private readonly tracks = new Map<string, Track["points"]>();
  private listener: (message: SourceMessage) => void = () => undefined;
  private timer: ReturnType<typeof setInterval> | undefined;
  private isStopped = false;
  private somethingFlies = false;
  /** The recording's own clock, by which the mission's time is counted whoever else flies. */
  private atUtc: string | undefined;

  constructor(
    private readonly flight: () => Promise<Said> = recordedFlight,
    private readonly server: Pick<Source, "start" | "stop"> = new LiveSource(null, false),
  ) {}

  start(listener: (message: SourceMessage) => void): void {
    this.listener = listener;
    void this.flight().then(
      (said) => this.play(said),
      (error: unknown) => listener({ type: "unreadable", detail: String(error) }),
    );
    this.server.start((message) => {
      if (message.type === "status") this.somethingFlies = message.crafts.some((craft) => craft.mission_id !== null);
      if (this.somethingFlies && isOfVehicle(message)) listener({ ...message, at_utc: this.atUtc ?? message.at_utc });
    });
  }

  stop(): void {
    this.isStopped = true;
    clearInterval(this.timer);
    this.server.stop();
  }

  private play(said: Said): void {
    if (this.isStopped) return;
    const began = performance.now();
    const last = said.findLast(([, message]) => typeof message === "object" && message.type === "telemetry");
    let [told, againMs] = [0, Infinity];
    this.listener({ type: "link", state: "open", attempt: 0 });
    this.timer = setInterval(() => {
      const now = performance.now();
      for (; told < said.length && said[told]![0] <= (now - began) / 1000; told++) {
        this.tell(said[told]![1]);
        againMs = now + AGAIN_MS;
      }
      if (told < said.length || !last || now < againMs) return;
      this.tell(last[1]);
      againMs = now + AGAIN_MS;
    }, TICK_MS);
  }

  private tell(message: LiveMessage | string): void {
    if (typeof message === "string") {
      const frame = decodeBeliefFrame(bytesOf(message));
      this.frames.push(frame);
      this.listener({ type: "belief", frame });
      return;
    }
    if (isOfVehicle(message)) this.atUtc = message.at_utc;
    if (message.type === "telemetry") this.keep(message);
    if (this.somethingFlies && isOfVehicle(message)) return;
    this.listener(message);
  }

  private keep(telemetry: LiveMessage & { type: "telemetry" }): void {
    const { craft_id, at_utc, lat, lon, altitude_amsl_m, altitude_relative_m, heading_deg, battery_percent, mode } = telemetry;
    if (lat === null || lon === null) return;
    const point = { at_utc, lat, lon, altitude_amsl_m, altitude_relative_m, heading_deg, battery_percent, mode };
    this.tracks.set(craft_id, [...(this.tracks.get(craft_id) ?? []), point]);
  }

  async belief(_missionId: string, emitterId: string, seq: number): Promise<BeliefFrame | null> {
    return this.frames.findLast((frame) => frame.emitterId === emitterId && frame.seq <= seq) ?? null;
  }
  async track(_missionId: string, craftId: string): Promise<Track> {
    return { mission_id: EXAMPLE_ID, craft_id: craftId, points: this.tracks.get(craftId) ?? [] };
  }
  order = api.orderCraft;
  /** The recorded mission takes no commands; one that flies meanwhile does. */
  async send(missionId: string, command: Command, sending?: api.Sending): Promise<CommandReply> {
    return missionId === EXAMPLE_ID ? refuse() : api.sendCommand(missionId, command, sending);
  }
  async preflight(): Promise<PreflightReply> {
    return refuse();
  }
  async expectedTime(): Promise<ExpectedTime> {
    return refuse();
  }
  importArea = api.importArea;
}
