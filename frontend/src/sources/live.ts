// The running server: a read-only websocket that resumes where it broke off, and REST for everything else.
import type { LiveMessage } from "../wire";
import { decodeBeliefFrame } from "../wire/beliefFrame";
import * as api from "./api";
import type { Source, SourceMessage } from "./source";

const FIRST_RETRY_MS = 500;
const LONGEST_RETRY_MS = 8_000;
/** Status comes once a second: a socket silent for this long is dead even when it says it is open. */
const SILENCE_MS = 6_000;
/** Events that were promised by the greeting but have not come after this long are asked for again. */
const BACKLOG_MS = 8_000;
const NO_SUCH_MISSION = 4404;

export function retryDelayMs(attempt: number, random: number): number {
  const ceiling = Math.min(LONGEST_RETRY_MS, FIRST_RETRY_MS * 2 ** attempt);
  return ceiling / 2 + (random * ceiling) / 2;
}

export class LiveSource implements Source {
  readonly happensNow = true;
  readonly takesCommands = true;
  readonly keptByServer = true;
  private socket: WebSocket | null = null;
  private listener: (message: SourceMessage) => void = () => undefined;
  private lastSeq = 0;
  private attempt = 0;
  private stopped = true;
  private retryTimer: ReturnType<typeof setTimeout> | undefined;
  private silenceTimer: ReturnType<typeof setTimeout> | undefined;
  private backlogTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    readonly missionId: string | null,
    private readonly lite: boolean,
  ) {}

  start(listener: (message: SourceMessage) => void): void {
    this.listener = listener;
    this.stopped = false;
    this.connect();
  }

  stop(): void {
    this.stopped = true;
    clearTimeout(this.retryTimer);
    clearTimeout(this.silenceTimer);
    clearTimeout(this.backlogTimer);
    this.socket?.close();
    this.socket = null;
  }

  private address(): string {
    const query = new URLSearchParams({ after: String(this.lastSeq) });
    if (this.missionId) query.set("mission", this.missionId);
    if (this.lite) query.set("lite", "1");
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    return `${scheme}://${location.host}/api/live?${query}`;
  }

  private connect(): void {
    this.listener({ type: "link", state: "connecting", attempt: this.attempt });
    const socket = new WebSocket(this.address());
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.watchSilence(socket);
    socket.onopen = () => {
      this.listener({ type: "link", state: "open", attempt: this.attempt });
    };
    socket.onmessage = (received: MessageEvent<string | ArrayBuffer>) => {
      this.attempt = 0;
      this.watchSilence(socket);
      try {
        this.receive(received.data);
      } catch (error) {
        this.listener({ type: "unreadable", detail: error instanceof Error ? error.message : String(error) });
      }
    };
    socket.onclose = ({ code }: CloseEvent) => {
      if (this.socket !== socket) return;
      if (code === NO_SUCH_MISSION && this.missionId !== null) {
        this.stop();
        this.listener({ type: "gone", missionId: this.missionId });
      } else this.reconnect();
    };
  }

  private watchSilence(socket: WebSocket): void {
    clearTimeout(this.silenceTimer);
    this.silenceTimer = setTimeout(() => this.abandon(socket), SILENCE_MS);
  }

  private watchBacklog(promised: number): void {
    const socket = this.socket;
    clearTimeout(this.backlogTimer);
    if (!socket || promised <= this.lastSeq) return;
    const had = this.lastSeq;
    this.backlogTimer = setTimeout(() => {
      if (this.lastSeq >= promised) return;
      if (this.lastSeq > had) this.watchBacklog(promised);
      else this.abandon(socket);
    }, BACKLOG_MS);
  }

  private abandon(socket: WebSocket): void {
    if (this.socket !== socket) return;
    socket.onclose = null;
    socket.close();
    this.reconnect();
  }

  private reconnect(): void {
    clearTimeout(this.silenceTimer);
    clearTimeout(this.backlogTimer);
    this.socket = null;
    if (this.stopped) return;
    this.listener({ type: "link", state: "closed", attempt: this.attempt });
    this.retryTimer = setTimeout(() => this.connect(), retryDelayMs(this.attempt, Math.random()));
    this.attempt += 1;
  }

  private receive(data: string | ArrayBuffer): void {
    if (typeof data !== "string") {
      this.listener({ type: "belief", frame: decodeBeliefFrame(data) });
      return;
    }
    const message = JSON.parse(data) as LiveMessage;
    if (message.type === "event" && message.recorded.mission_id === this.missionId) {
      if (message.recorded.seq <= this.lastSeq) return;
      this.lastSeq = message.recorded.seq;
    }
    if (message.type === "hello" && this.missionId !== null) this.watchBacklog(message.last_seq);
    this.listener(message);
  }

  send = api.sendCommand;
  order = api.orderCraft;
  belief = api.belief;
  track = api.track;
  preflight = api.preflight;
  expectedTime = api.expectedTime;
  importArea = api.importArea;
}
