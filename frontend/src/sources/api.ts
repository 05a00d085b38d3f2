// REST, one function an endpoint. Every failure becomes a RequestFailed with a problem to show.
import { t } from "../i18n";
import type {
  AntennaReview,
  AreaImport,
  AreaOutlook,
  CheckFact,
  Command,
  CommandReply,
  CommandRequest,
  CompassKnown,
  CraftCommand,
  CraftRequest,
  Defaults,
  EventPage,
  ExpectedTime,
  ExportedMission,
  Health,
  Mission,
  MissionList,
  MissionSpec,
  PayloadList,
  Place,
  PreflightReply,
  Preview,
  Problem,
  Recorded,
  RecordingImport,
  SearchArea,
  Track,
  WhatIf,
  WhatIfRequest,
} from "../wire";
import { type BeliefFrame, decodeBeliefFrame } from "../wire/beliefFrame";
import { inPlace } from "./places";
import { localProblem, RequestFailed, unreachable } from "./problem";

const TIMEOUT_MS = 20_000;
const ANTENNA_S = 60;
/** A file of many megabytes may cross a thin link. */
const LONG_MS = 120_000;

/** A random UUID also where the page is served without TLS (crypto.randomUUID needs a secure context). */
export function newCommandId(): string {
  const b = crypto.getRandomValues(new Uint8Array(16));
  b[6] = (b[6]! & 0x0f) | 0x40;
  b[8] = (b[8]! & 0x3f) | 0x80;
  const hex = Array.from(b, (x) => x.toString(16).padStart(2, "0")).join("");
  return `${hex.slice(0, 8)}-${hex.slice(8, 12)}-${hex.slice(12, 16)}-${hex.slice(16, 20)}-${hex.slice(20)}`;
}

export async function problemOf(response: Response): Promise<RequestFailed> {
  const { status, statusText } = response;
  const fallback = localProblem(t("problem.status", { status }), statusText || t("problem.noReason"), status);
  const isJson = response.headers.get("content-type")?.includes("json") ?? false;
  const body: Partial<Problem> = (isJson && (await response.json().catch(() => null))) || {};
  return new RequestFailed({ ...fallback, ...body, errors: Array.isArray(body.errors) ? body.errors : [] });
}

async function request(path: string, init: RequestInit = {}, timeoutMs = TIMEOUT_MS): Promise<Response> {
  const timeout = AbortSignal.timeout(timeoutMs);
  const signal = init.signal ? AbortSignal.any([init.signal, timeout]) : timeout;
  const ask = async () => {
    const answered = await fetch(`/api${path}`, { ...init, signal });
    await answered.clone().arrayBuffer(); // until then it keeps its connection
    return answered;
  };
  let response: Response;
  try {
    response = await (path.endsWith("/commands") ? ask() : inPlace(ask, signal));
  } catch (error) {
    if (init.signal?.aborted) throw error;
    throw unreachable(timeout.aborted ? t("problem.timeout", { seconds: timeoutMs / 1000 }) : t("problem.connection"));
  }
  if (!response.ok) throw await problemOf(response);
  return response;
}

export async function requestEmpty(path: string, init: RequestInit): Promise<void> {
  await request(path, init);
}

export async function json<T>(path: string, init?: RequestInit, timeoutMs?: number): Promise<T> {
  return (await (await request(path, init, timeoutMs)).json()) as T;
}

export const withBody = (method: string, body: unknown, signal?: AbortSignal): RequestInit => ({
  method,
  headers: { "content-type": "application/json" },
  body: JSON.stringify(body),
  signal: signal ?? null,
});

export type ExportFormat = "geojson" | "kml" | "csv" | "mcap" | "cot" | "json" | "bundle" | "sigmf";

const missionPath = (id: string) => `/missions/${encodeURIComponent(id)}`;

export const health = () => json<Health>("/health");

export const payloads = () => json<PayloadList>("/payloads");
export const defaults = () => json<Defaults>("/defaults");
const compassPath = (craftId: string, offsetDeg: number) =>
  `/crafts/${encodeURIComponent(craftId)}/compass?bearing_offset_deg=${offsetDeg}`;
/** What was learned of the compass of a craft with its antenna, for a mission that takes this off its bearings. */
export const compass = (craftId: string, offsetDeg: number) => json<CompassKnown>(compassPath(craftId, offsetDeg));
export const forgetCompass = (craftId: string, offsetDeg: number) =>
  json<CompassKnown>(compassPath(craftId, offsetDeg), { method: "DELETE" });
/** A page of the list. after: `next` of the page before. */
export const missions = (asked: Readonly<Record<string, string>>, after: string | null) =>
  json<MissionList>(`/missions?${new URLSearchParams(after === null ? asked : { ...asked, after })}`);
export const mission = (id: string) => json<Mission>(missionPath(id));
/** id: sent again with the same one, it drafts nothing twice. */
export const draftMission = (spec: MissionSpec, id = newCommandId()) => json<Mission>(`/missions?mission_id=${id}`, withBody("POST", spec));
/** fromSeq: of what was edited; without, what is stored is replaced unseen. */
export const editMission = (id: string, spec: MissionSpec, fromSeq?: number) =>
  json<Mission>(`${missionPath(id)}/spec${fromSeq === undefined ? "" : `?from_seq=${fromSeq}`}`, withBody("PUT", spec));
export const preflight = (id: string) => json<PreflightReply>(`${missionPath(id)}/preflight`, { method: "POST" });
export const preview = (spec: MissionSpec, signal?: AbortSignal) => json<Preview>("/preview", withBody("POST", spec, signal));
export const track = (id: string, craftId: string) => json<Track>(`${missionPath(id)}/track?craft=${encodeURIComponent(craftId)}`);

/** Where a file of the mission can be fetched from. */
export const exportAddress = (id: string, format: ExportFormat) => `/api${missionPath(id)}/export/${format}`;

const PAGE = newCommandId();

/** How an order goes out. */
export interface Sending {
  /** Given again, it means the same order again: carried out once. */
  commandId?: string;
  /** Of the control lease. */
  fence?: number | null;
  /** Its number on this page: after a later one it comes too late. */
  press?: number | undefined;
  timeoutMs?: number;
}

const asked = ({ commandId = newCommandId(), fence = null, press }: Sending) => ({
  command_id: commandId,
  fence,
  press: press === undefined ? null : { page: PAGE, number: press },
});

export const sendCommand = (id: string, command: Command, sending: Sending = {}): Promise<CommandReply> => {
  const body: CommandRequest = { ...asked(sending), command };
  return json<CommandReply>(`${missionPath(id)}/commands`, withBody("POST", body), sending.timeoutMs);
};

export const orderCraft = (craftId: string, command: CraftCommand, sending: Sending = {}): Promise<CommandReply> => {
  const body: CraftRequest = { ...asked(sending), command };
  return json<CommandReply>(`/crafts/${encodeURIComponent(craftId)}/commands`, withBody("POST", body), sending.timeoutMs);
};

export const areaOutlook = (id: string, search: SearchArea, signal?: AbortSignal) =>
  json<AreaOutlook>(`${missionPath(id)}/area-outlook`, withBody("POST", search, signal));

/** insteadOf: a place to compare it with. */
export const expectedTime = (id: string, place: Place, signal?: AbortSignal, insteadOf: Place | null = null) =>
  json<ExpectedTime>(`${missionPath(id)}/expected-time`, withBody("POST", { place, instead_of: insteadOf }, signal));

/** The vehicle is turned by hand meanwhile: longer than other requests. */
export const checkAntenna = (id: string, emitter: { place: Place } | { bearing_deg: number }) =>
  json<CheckFact>(`${missionPath(id)}/antenna-check`, withBody("POST", { ...emitter, wait_s: ANTENNA_S }), (ANTENNA_S + 20) * 1000);

export const importRecording = (id: string, form: FormData) =>
  json<RecordingImport>(`${missionPath(id)}/recordings`, { method: "POST", body: form });

/** The text of an exported journal, of any age, in today's form. */
export const readExported = (text: string) =>
  json<ExportedMission>("/recordings/read", { method: "POST", headers: { "content-type": "application/json" }, body: text }, LONG_MS);

export const antennaReview = (id: string, emitterId: string) =>
  json<AntennaReview>(`${missionPath(id)}/antenna?emitter=${encodeURIComponent(emitterId)}`);
export const whatIf = (id: string, wanted: WhatIfRequest) => json<WhatIf>(`${missionPath(id)}/what-if`, withBody("POST", wanted));

export const importArea = (text: string, filename: string) => json<AreaImport>("/areas", withBody("POST", { text, filename }));

export async function events(id: string): Promise<Recorded[]> {
  const all: Recorded[] = [];
  for (;;) {
    const after = all.at(-1)?.seq ?? 0;
    const page = await json<EventPage>(`${missionPath(id)}/events?after=${after}`);
    all.push(...page.events);
    if (!page.more || page.events.length === 0) return all;
  }
}

export async function belief(id: string, emitterId: string, seq: number): Promise<BeliefFrame | null> {
  try {
    const response = await request(`${missionPath(id)}/beliefs?emitter=${encodeURIComponent(emitterId)}&seq=${seq}`);
    return decodeBeliefFrame(await response.arrayBuffer());
  } catch (error) {
    if (error instanceof RequestFailed && error.problem.status === 404) return null;
    throw error;
  }
}
