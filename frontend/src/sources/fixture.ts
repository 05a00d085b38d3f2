// The built-in example: a mission that flies itself in the browser, for looking at the page without a server.
import type { Command, CommandReply, ExpectedTime, MissionEvent, MissionSpec, Phase, Place, PreflightReply, Track } from "../wire";
import type { BeliefFrame, LonLat } from "../wire/beliefFrame";
import { bearingDeg, destination, distanceM, lonLat, place as placeOf } from "../state/geometry";
import { inFlight } from "../state/mission";
import { ExampleBelief } from "./fixtureBelief";
import type { Source, SourceMessage } from "./source";

export const EXAMPLE_ID = "example";
const SW: LonLat = [7.0965, 50.7335];
const [WIDTH, HEIGHT] = [313, 120];
const SIGMA = 7;
const SPEED = 14;
const TICK_MS = 50;
const TURN_DEG_S = 90;

const clock = (seconds: number) => `${Math.floor(seconds / 60)}:${String(Math.round(seconds % 60)).padStart(2, "0")}`;

/** Mulberry32: the same example each time. */
function random(seed: number): () => number {
  let a = seed;
  return () => {
    a = (a + 0x6d2b79f5) | 0;
    let x = Math.imul(a ^ (a >>> 15), 1 | a);
    x = (x + Math.imul(x ^ (x >>> 7), 61 | x)) ^ x;
    return ((x ^ (x >>> 14)) >>> 0) / 4294967296;
  };
}

export const exampleSpec = (corners: LonLat[]): MissionSpec => ({
  name: "Wildlife tag at the meadow",
  area: { type: "Polygon", coordinates: [corners] },
  prior: { kind: "uniform" },
  emitter: { frequency_hz: 868_300_000, kind: "carrier", label: "emitter", pulse_width_s: 0.02, pulse_period_s: 1.3, pulse_jitter_s: 0.03 },
  sensor: { sigma_deg: SIGMA, outlier_probability: 0.05, measurement_time_s: 30, turn_rate_deg_s: 30, pulses_per_heading: 2, minimum_quality: 0.7, maximum_retakes: 2 },
  planner: {
    method: "rollout", base_policy: "fisher", selection: "sequential_halving", sampling: "crn", estimator: "map", budget: 1000,
    action_spacing_m: 15, standoff_m: 50, motion: { kind: "linear_constant", speed_m_s: 7, constant_s: 11.2 }, seed: 1,
  },
  localization: { expected_rmse_m: 10, minimum_places: 2, minimum_place_distance_m: 10, minimum_crossing_angle_deg: 20, maximum_bearings: 20 },
  flight: {
    altitude_relative_m: 40, minimum_altitude_relative_m: 10, maximum_altitude_relative_m: 120, speed_m_s: 7, fence: null,
    fence_margin_m: 60, no_fly: [], reserve_battery_percent: 25, battery_telemetry: true, automatic: true,
  },
  timers: { console_lost_hold_s: 10, console_lost_return_s: 60, receiver_silent_s: 5, vehicle_command_s: 60 },
}); // prettier-ignore

export class FixtureSource implements Source {
  readonly kind = "fixture";
  private readonly home: LonLat;
  private readonly target: LonLat;
  private readonly belief_: ExampleBelief;
  private readonly frames: BeliefFrame[] = [];
  private readonly rand = random(5);
  private listener: (message: SourceMessage) => void = () => undefined;
  private timer: ReturnType<typeof setInterval> | undefined;
  private seq = 0;
  private tick = 0;
  private phase: Phase = "draft";
  private at: LonLat;
  private heading = 40;
  private goal: LonLat;
  private place = 0;
  private turned = 0;
  private samples: [number, number][] = [];
  private battery = 96;
  private automatic = true;
  /** `?fixture=endless`: never localized, for measurements of the page. */
  private endless = false;
  private readonly points: Track["points"] = [];

  constructor(readonly missionId: string | null) {
    this.belief_ = new ExampleBelief(SW, WIDTH, HEIGHT, EXAMPLE_ID);
    this.home = this.belief_.toLonLat(20, -25);
    this.target = this.belief_.toLonLat(228, 84);
    this.at = this.home;
    this.goal = this.home;
  }

  start(listener: (message: SourceMessage) => void): void {
    this.listener = listener;
    const wanted = new URLSearchParams(location.search).get("fixture");
    this.endless = wanted === "endless";
    listener({ type: "link", state: "open", attempt: 0 });
    listener({ type: "hello", server_version: "example", mission_id: this.missionId, last_seq: 0, time_factor: 1 });
    if (this.missionId) {
      const corner = (x: number, y: number) => this.belief_.toLonLat(x, y);
      const spec = exampleSpec([corner(0, 0), corner(WIDTH, 0), corner(WIDTH, HEIGHT), corner(0, HEIGHT), corner(0, 0)]);
      const noFly = [corner(120, 125), corner(170, 125), corner(170, 165), corner(120, 165), corner(120, 125)];
      this.emit({ kind: "mission_drafted", spec: { ...spec, flight: { ...spec.flight, no_fly: [{ type: "Polygon", coordinates: [noFly] }] } } });
      this.remember();
      if (wanted !== "draft") void this.preflight().then(() => this.fly());
    }
    this.timer = setInterval(() => this.step(), TICK_MS);
  }

  stop(): void {
    clearInterval(this.timer);
  }

  private emit(event: MissionEvent): void {
    this.seq += 1;
    this.listener({ type: "event", recorded: { seq: this.seq, mission_id: EXAMPLE_ID, at_utc: new Date().toISOString(), event } });
  }

  private become(after: Phase, reason: string): void {
    if (after === this.phase) return;
    this.emit({ kind: "phase_changed", before: this.phase, after, reason });
    this.phase = after;
  }

  private remember(): void {
    const frame = this.belief_.frame(this.frames.length);
    this.frames.push(frame);
    this.listener({ type: "belief", frame });
  }

  private fly(): void {
    this.emit({ kind: "mission_started", by: "operator", home: placeOf(this.home), home_amsl_m: 62, software: "example", antenna: null });
    this.become("taking_off", "started by operator");
    this.emit({ kind: "took_off", place: placeOf(this.home), altitude_relative_m: 40 });
    this.plan();
  }

  private value(at: LonLat): number {
    const estimate = this.frames.length > 1 ? lonLat(this.belief_.estimate()) : this.belief_.toLonLat(WIDTH / 2, HEIGHT / 2);
    const distance = distanceM(at, estimate);
    const angle = this.place === 0 ? 90 : Math.abs(((bearingDeg(at, estimate) - 62 + 540) % 180) - 90);
    return 70 + distanceM(this.at, at) / 7 + Math.max(0, distance - 60) / 6 + angle * 0.8;
  }

  private plan(): void {
    this.become("planning", "");
    this.place += 1;
    const candidates = Array.from({ length: 112 }, (_, i) => {
      const at = this.belief_.toLonLat(-30 + (i % 14) * 28, -40 + Math.floor(i / 14) * 28);
      return { at, value: this.value(at) + 6 * this.rand() };
    }).toSorted((a, b) => a.value - b.value);
    const rounds = Math.ceil(Math.log2(candidates.length));
    const facts = candidates.map(({ at, value }, rank) => {
      const round = rank < 2 ? null : Math.max(1, rounds - Math.floor(Math.log2(rank)));
      const rollouts = Math.round(1000 / rounds / (candidates.length / 2 ** ((round ?? rounds) - 1))) + 4;
      return { lat: at[1], lon: at[0], value_s: value, std_error_s: 24 / Math.sqrt(rollouts), rollouts, dropped_in_round: round };
    });
    const best = candidates[0]!;
    this.goal = best.at;
    this.emit({
      kind: "plan_chosen", place_number: this.place, place: placeOf(best.at), source: "planner",
      reason: `localized in about ${clock(best.value)} by way of this place, ${Math.round(candidates[1]!.value - best.value + 2)} s sooner than by any other of ${candidates.length} places tried`,
      expected_time_s: best.value, time_90_s: best.value * 1.6, candidates: facts, rollouts: 1004, plan_ms: 18.4, by: null,
    }); // prettier-ignore
    if (this.automatic) this.depart();
    else this.become("waiting", "accept the next place");
  }

  private depart(): void {
    this.become("flying", "");
    this.emit({ kind: "flight_started", place_number: this.place, place: placeOf(this.goal), altitude_amsl_m: 102 });
  }

  private gain(relative: number): number {
    const r = (((relative + 540) % 360) - 180) / 32;
    return Math.max(-17, -3 * r * r) + (Math.abs(Math.abs(relative % 360) - 150) < 25 ? 5 : 0);
  }

  private measure(): void {
    const truth = bearingDeg(this.at, this.target);
    const noise = SIGMA * 0.6 * (this.rand() + this.rand() + this.rand() - 1.5) * 2;
    const bearing = (truth + noise + 360) % 360;
    const level = -58 - 20 * Math.log10(distanceM(this.at, this.target) / 50);
    const heading = (i: number) => 2 * i + 1;
    const binned = Array.from({ length: 180 }, (_, i) => (i % 41 === 7 ? null : level + this.gain(heading(i) - bearing) + 3 * (this.rand() - 0.5)));
    const fitted = Array.from({ length: 180 }, (_, i) => level + this.gain(heading(i) - bearing));
    const sweepId = `sweep-${this.place}-${this.seq}`;
    const at = placeOf(this.at);
    if (this.place === 2 && this.turned >= 0) {
      this.turned = -1;
      this.emit({ kind: "sweep_rejected", sweep_id: sweepId, place_number: 2, attempt: 1, quality: 0.52, reason: "the sweep does not look like the antenna (similarity 0.52, needs 0.70): reflections, interference or no signal", place: at, binned_db: binned.map((v, i) => (v === null ? null : v + 7 * Math.sin(i / 9))), fitted_db: fitted });
      this.emit({ kind: "alert_raised", alert_id: "quality-2", level: "caution", text: "no usable bearing here: quality 0.52 is below 0.70", remedy: "look at the vehicle and resume, or order the return" });
      this.emit({ kind: "sweep_started", place_number: 2, attempt: 2 });
      this.samples = [];
      return;
    }
    const peaks = this.place === 1 ? [{ bearing_deg: (bearing + 118) % 360, weight: 0.31 }] : [];
    this.emit({
      kind: "bearing_measured", bearing_id: `bearing-${this.place}`, sweep_id: sweepId, place_number: this.place, place: at, altitude_amsl_m: 102,
      bearing_deg: bearing, sigma_deg: SIGMA, quality: 0.86 + 0.1 * this.rand(), peaks, snr_db: 17.2, drift_m: 0.7, binned_db: binned, fitted_db: fitted, measurement_time_s: 30, heading_sigma_deg: 4,
    }); // prettier-ignore
    this.belief_.update(this.at, bearing, SIGMA);
    const estimate = this.belief_.estimate();
    const localized = !this.endless && this.place >= 3 && estimate.expected_rmse_m < 14;
    const tooWide = `not yet: expected error ${estimate.expected_rmse_m.toFixed(0)} m, wanted below 10 m`;
    const oneSide = "not yet: all bearings from one side, crossing at 24 deg, 30 deg are needed";
    const doubt = this.place === 1 ? "not yet: one bearing from one place, 2 places are needed" : estimate.expected_rmse_m < 10 ? oneSide : tooWide;
    const notYet = localized ? [] : [doubt];
    this.emit({ kind: "belief_updated", bearings: this.place, estimate, consistent: true, localized, not_yet: notYet, contradicting: [], heading_offset_deg: null, heading_offset_std_error_deg: null, digest: "" });
    this.remember();
    if (localized || (!this.endless && this.place >= 6)) {
      this.goal = this.home;
      this.become("returning", "localized");
      this.emit({ kind: "mission_ended", outcome: localized ? "localized" : "not_localized", reason: "the expected error is below the threshold", mission_time_s: this.tick * (TICK_MS / 1000) });
    } else this.plan();
  }

  private step(): void {
    this.tick += 1;
    const seconds = TICK_MS / 1000;
    if (this.phase === "flying" || this.phase === "returning") {
      const far = distanceM(this.at, this.goal);
      const wanted = bearingDeg(this.at, this.goal);
      if (far > 1) this.heading += Math.max(-6, Math.min(6, ((wanted - this.heading + 540) % 360) - 180));
      this.at = far < SPEED * seconds ? this.goal : destination(this.at, wanted, SPEED * seconds);
      if (far < SPEED * seconds) this.arrive();
    } else if (this.phase === "measuring") this.turn(seconds);
    this.battery = Math.max(0, this.battery - (inFlight(this.phase) ? 0.008 : 0));
    const [lon, lat] = this.at;
    const flies = inFlight(this.phase) && this.phase !== "landing";
    this.listener({
      type: "telemetry", at_utc: new Date().toISOString(), connected: true, lat, lon, position_age_s: 0.1, altitude_amsl_m: 102,
      altitude_relative_m: flies ? 40 : 0, heading_deg: (this.heading + 360) % 360, heading_age_s: 0.1, ground_speed_m_s: this.phase === "flying" ? SPEED : 0,
      climb_m_s: 0, battery_percent: this.battery, battery_age_s: 0.6, gps_fix: "3D", satellites: 14, armed: flies, in_air: flies,
      mode: this.phase === "hold" ? "HOLD" : "OFFBOARD", mode_age_s: 0.4, controller: "crossfix", autopilot: "px4", dropped: 0,
    }); // prettier-ignore
    if (this.tick % 10 === 0) this.points.push({ at_utc: new Date().toISOString(), lat, lon, altitude_amsl_m: 102, altitude_relative_m: 40, heading_deg: this.heading, battery_percent: this.battery, mode: null });
    if (this.tick % 20 === 0) {
      this.listener({
        type: "status", at_utc: new Date().toISOString(), mission_id: this.missionId ? EXAMPLE_ID : null, phase: this.phase, doing: this.doing(),
        waits_for: this.phase === "waiting" ? "accept, veto or another place" : null, receiver: "ok", receiver_power_db: -71, receiver_age_s: 0.2, viewers: 1,
        battery_to_return_percent: 8, database: "ok",
      }); // prettier-ignore
    }
  }

  private doing(): string {
    const left = distanceM(this.at, this.goal) / SPEED;
    const words: Partial<Record<Phase, string>> = {
      flying: `flying to bearing ${this.place}, 0:${String(Math.round(left)).padStart(2, "0")}`,
      measuring: `taking bearing ${this.place}, turned ${Math.round(Math.abs(this.turned))}°`,
      draft: "draft", ready: "ready to start", hold: "holding: held by operator", waiting: `waiting for you: place ${this.place} is proposed`,
      returning: "returning home", done: "done: localized", aborted: "aborted",
    }; // prettier-ignore
    return words[this.phase] ?? this.phase;
  }

  private arrive(): void {
    if (this.phase === "returning") {
      this.become("done", "the expected error is below the threshold");
      return;
    }
    this.emit({ kind: "place_reached", place_number: this.place, place: placeOf(this.at), distance_m: 0.4, flight_time_s: 12 });
    this.become("measuring", "");
    this.emit({ kind: "sweep_started", place_number: this.place, attempt: 1 });
    this.turned = 0;
    this.samples = [];
  }

  private turn(seconds: number): void {
    this.heading += TURN_DEG_S * seconds;
    const progress = this.samples.length * TURN_DEG_S * seconds;
    const truth = bearingDeg(this.at, this.target);
    this.samples.push([(this.heading + 360) % 360, -62 + this.gain(this.heading - truth) + 3 * (this.rand() - 0.5)]);
    if (this.samples.length % 3 === 0) {
      this.listener({
        type: "sweep_progress", mission_id: EXAMPLE_ID, place_number: this.place,
        heading_deg: this.samples.map((s) => s[0]), power_db: this.samples.map((s) => s[1]), turned_deg: progress,
      }); // prettier-ignore
    }
    if (progress >= 360) this.measure();
  }

  async send(_missionId: string, command: Command, commandId = ""): Promise<CommandReply> {
    switch (command.kind) {
      case "start":
        this.fly();
        break;
      case "hold":
        this.emit({ kind: "hold_ordered", by: "operator", reason: "ordered" });
        this.become("hold", "held by operator");
        break;
      case "resume":
        this.emit({ kind: "resume_ordered", by: "operator" });
        this.depart();
        break;
      case "abort":
      case "return":
        this.emit(command.kind === "abort" ? { kind: "abort_ordered", by: "operator", reason: "ordered" } : { kind: "return_ordered", by: "operator", reason: "ordered" });
        this.goal = this.home;
        this.become("returning", `${command.kind === "abort" ? "aborted" : "return ordered"} by operator`);
        break;
      case "override":
        this.goal = lonLat(command.place);
        this.emit({ kind: "plan_chosen", place_number: this.place, place: command.place, source: "operator", reason: "chosen by operator", expected_time_s: null, time_90_s: null, candidates: [], rollouts: 0, plan_ms: 0, by: "operator" });
        this.depart();
        break;
      case "accept":
        this.depart();
        break;
      case "veto":
        this.emit({ kind: "plan_vetoed", place: placeOf(this.goal), by: "operator" });
        this.plan();
        break;
      case "set_automatic":
        this.automatic = command.automatic;
        this.emit({ kind: "automatic_changed", automatic: command.automatic, by: "operator" });
        break;
      case "exclude_bearing":
        this.emit({ kind: "bearing_excluded", bearing_id: command.bearing_id, by: "operator", reason: command.reason ?? "" });
        break;
      case "acknowledge_alert":
        this.emit({ kind: "alert_acknowledged", alert_id: command.alert_id, by: "operator" });
        break;
    }
    return { command_id: commandId, accepted: true, reason: "", remedy: "", seq: this.seq };
  }

  async belief(_missionId: string, bearings: number): Promise<BeliefFrame | null> {
    return this.frames[bearings] ?? null;
  }

  async track(): Promise<Track> {
    return { mission_id: EXAMPLE_ID, points: [...this.points] };
  }

  async preflight(): Promise<PreflightReply> {
    const checks = [
      { name: "Vehicle link", ok: true, detail: "px4, mode HOLD", remedy: "", blocking: true },
      { name: "GPS", ok: true, detail: "3D, 14 satellites", remedy: "", blocking: true },
      { name: "Battery", ok: true, detail: "96 %", remedy: "", blocking: true },
      { name: "safety", ok: true, detail: "fence, battery and position allow the start", remedy: "", blocking: true },
      { name: "Failsafe NAV_DLL_ACT", ok: false, detail: "ground station lost: NAV_DLL_ACT = 0", remedy: "Set NAV_DLL_ACT to 2 (return): at 0 a vehicle without its station hovers until its battery is empty.", blocking: false },
      { name: "receiver", ok: true, detail: "delivers samples at 868.3000 MHz", remedy: "", blocking: true },
      { name: "antenna pattern", ok: true, detail: "3-element Yagi, 868 MHz", remedy: "", blocking: true },
    ];
    this.emit({ kind: "preflight_checked", passed: true, checks });
    if (!inFlight(this.phase)) this.become("ready", "preflight passed");
    return { passed: true, checks };
  }

  async expectedTime(_missionId: string, place: Place): Promise<ExpectedTime> {
    const allowed = distanceM(lonLat(place), this.belief_.toLonLat(WIDTH / 2, HEIGHT / 2)) < 260;
    const mean = this.value(lonLat(place));
    return { place, allowed, reason: allowed ? "" : "outside the fence", expected_time_s: mean, std_error_s: 2, time_90_s: mean * 1.6, rollouts: 64 };
  }

  async importArea(): Promise<never> {
    throw new Error("The built-in example reads no files.");
  }
}
