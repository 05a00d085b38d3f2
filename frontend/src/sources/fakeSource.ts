// A source for tests: passes on what it is given, keeps what it is sent, and answers as the test chose.
import type { Command, CommandReply, CraftCommand } from "../wire";
import type { Sending } from "./api";
import type { Source, SourceMessage } from "./source";

export const accepted: CommandReply = { command_id: "", accepted: true, reason: null, seq: 1 };

export class FakeSource implements Source {
  readonly happensNow: boolean = true;
  readonly takesCommands: boolean = true;
  readonly keptByServer: boolean = true;
  readonly sent: (Pick<Sending, "press" | "timeoutMs"> & {
    missionId: string;
    kind: Command["kind"];
    commandId: string;
    craftId?: string | null;
  })[] = [];
  answer: () => Promise<CommandReply> = () => Promise.resolve(accepted);
  stopped = false;
  private listener: (message: SourceMessage) => void = () => undefined;

  constructor(readonly missionId: string | null = "m") {}

  start(listener: (message: SourceMessage) => void): void {
    this.listener = listener;
  }
  stop(): void {
    this.stopped = true;
  }
  tell(...messages: SourceMessage[]): void {
    for (const message of messages) this.listener(message);
  }
  send(missionId: string, command: Command, { commandId = "", press, timeoutMs }: Sending = {}): Promise<CommandReply> {
    const craft = "craft_id" in command ? { craftId: command.craft_id } : {};
    this.sent.push({ missionId, kind: command.kind, commandId, press, ...(timeoutMs && { timeoutMs }), ...craft });
    return this.answer();
  }
  order(craftId: string, { kind }: CraftCommand, { commandId = "", press }: Sending = {}): Promise<CommandReply> {
    this.sent.push({ missionId: `craft ${craftId}`, kind, commandId, press });
    return this.answer();
  }
  belief: Source["belief"] = () => Promise.resolve(null);
  track: Source["track"] = (missionId, craftId) => Promise.resolve({ mission_id: missionId, craft_id: craftId, points: [] });
  preflight: Source["preflight"] = () => Promise.resolve({ passed: true, checks: [] });
  expectedTime: Source["expectedTime"] = () => Promise.reject(new Error("no forecast in tests"));
  importArea: Source["importArea"] = () => Promise.reject(new Error("no import in tests"));
}
