// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { watchKeys } from "../app/keys";
import { landingArmed } from "../commands/landing";
import { HOLD_MS } from "../commands/SlideToConfirm";
import { urgent } from "../commands/urgent";
import { t } from "../i18n";
import { FakeSource } from "../sources/fakeSource";
import type { SourceMessage } from "../sources/source";
import { moveClock, nowMs } from "../state/clock";
import { live } from "../state/connection";
import { emptyLive } from "../state/live";
import { open } from "../state/open";
import { session } from "../state/session";
import type { Authority, CraftStatus, MissionEvent, Phase } from "../wire";
import { CRAFT, NOBODY, phase, record, someSpec, someStatus, someTelemetry } from "../wire/examples";
import { SafetyBar } from "./SafetyBar";

watchKeys();

const part = (testId: string) => document.querySelector<HTMLButtonElement>(`[data-testid=${testId}]`);
const press = (code: string, repeat = false) => dispatchEvent(new KeyboardEvent("keydown", { code, altKey: true, shiftKey: true, repeat }));
const drafted: MissionEvent = { kind: "mission_drafted", spec: someSpec() };
const happens = (...events: MissionEvent[]): SourceMessage[] => record(...events).map((recorded) => ({ type: "event", recorded }));
const inPhase = (after: Phase) => happens(drafted, phase(after));

/** What the server says of the one craft there is. */
const craftStatus = (changes: Partial<CraftStatus>) =>
  someStatus({
    crafts: [
      {
        craft_id: "craft-1",
        mission_id: null,
        phase: "ground",
        receiver: "ok",
        receiver_power_db: -90,
        receiver_age_s: 0,
        battery_to_return_percent: 10,
        order: null,
        resume_refused: null,
        alerts: [],
        settling_samples: 0,
        receiver_lost_percent: 0,
        ...changes,
      },
    ],
  });

let source: FakeSource;
const show = (next: FakeSource, ...messages: SourceMessage[]) =>
  act(() => {
    source = next;
    open(source);
    source.tell({ type: "link", state: "open", attempt: 0 }, ...messages);
    vi.advanceTimersByTime(200);
  });

let begun = 0;
beforeEach(() => {
  vi.useFakeTimers();
  vi.advanceTimersByTime(60_000 * ++begun);
  nowMs.value = performance.now(); // the test before may have gone on into the future
  act(() => render(<SafetyBar />, document.body));
});
afterEach(async () => {
  act(() => render(null, document.body));
  await vi.runOnlyPendingTimersAsync();
  vi.useRealTimers();
  urgent.value = {};
  session.value = null;
});

const signIn = () => {
  const person = { person_id: "p", name: "Ada", role: "operator" };
  session.value = { mode: "people", person } as unknown as NonNullable<typeof session.value>;
};

const COMMANDS = [
  ["abort", "KeyA"],
  ["hold", "KeyH"],
  ["return", "KeyR"],
] as const;

/** What buttons and keys send, in this order. */
function sentByAll(): string[] {
  for (const [kind, code] of COMMANDS) {
    act(() => part(kind)!.click());
    act(() => void vi.advanceTimersByTime(1000)); // sooner, it would be a second tap
    act(() => void press(code));
  }
  return source.sent.map(({ missionId, kind }) => `${missionId} ${kind}`);
}

const both = (id: string) => COMMANDS.flatMap(([kind]) => [`${id} ${kind}`, `${id} ${kind}`]);

describe("abort, hold and return", () => {
  it("act on the mission in flight, by button and by key", () => {
    show(new FakeSource(), ...inPhase("flying"), someTelemetry());
    expect(sentByAll()).toEqual(both("m"));
  });

  it("act on it still when it was aborted and its vehicle is in the air", () => {
    const aborted: MissionEvent = {
      kind: "mission_ended",
      outcome: "aborted",
      reason: { code: "ordered", order: "abort", by: "operator" },
      mission_time_s: 1,
    };
    const flies = craftStatus({ mission_id: "m", phase: "returning" });
    show(new FakeSource(), ...happens(drafted, phase("returning"), aborted), someTelemetry({ in_air: true }), flies);
    expect(sentByAll()).toEqual(both("m"));
  });

  it("act on the mission that flies while another one is shown, and the bar says so", () => {
    show(new FakeSource(), ...happens(drafted), someTelemetry(), craftStatus({ mission_id: "other", phase: "flying" }));
    expect(part("other-flies")!.querySelector("a")!.getAttribute("href")).toContain("other");
    expect(sentByAll()).toEqual(both("other"));
  });

  it("never act on a recording", () => {
    class Recording extends FakeSource {
      override readonly takesCommands = false;
    }
    show(new Recording(), ...inPhase("flying"), someTelemetry(), craftStatus({}));
    expect(sentByAll()).toEqual([]);
  });

  it("are disabled, keys too, when nothing flies", () => {
    const ready: MissionEvent = { kind: "preflight_checked", passed: true, checks: [] };
    show(new FakeSource(), ...happens(drafted, ready), someTelemetry({ in_air: false }), craftStatus({}));
    for (const [kind] of COMMANDS) expect(part(kind)!.disabled).toBe(true);
    expect(sentByAll()).toEqual([]);
  });
});

describe("a key that is kept down", () => {
  it("orders once by its chord", async () => {
    show(new FakeSource(), ...inPhase("flying"), someTelemetry());
    act(() => void press("KeyH"));
    for (let times = 0; times < 60; times++) {
      act(() => void press("KeyH", true));
      await act(async () => void (await vi.advanceTimersByTimeAsync(33)));
    }
    expect(source.sent).toHaveLength(1);
  });

  it("presses a button once, and goes on making lines where one writes", () => {
    show(new FakeSource(), ...inPhase("flying"), someTelemetry());
    const text = document.body.appendChild(document.createElement("textarea"));
    const enter = (target: HTMLElement, repeat: boolean) =>
      target.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", repeat, bubbles: true, cancelable: true }));
    expect([enter(part("hold")!, false), enter(part("hold")!, true), enter(text, true)]).toEqual([true, false, true]);
    text.remove();
  });
});

describe("a vehicle in the air without a mission", () => {
  const loose = craftStatus({ mission_id: null, phase: "hold" });

  it("is shown, and hold and return act on it by button and by key; there is nothing to abort or to resume", () => {
    show(new FakeSource(null), someTelemetry({ in_air: true }), loose);
    expect(part("no-mission")).not.toBeNull();
    expect(part("abort")!.disabled).toBe(true);
    expect(part("resume")).toBeNull();
    expect(sentByAll()).toEqual(["hold", "hold", "return", "return"].map((kind) => `craft craft-1 ${kind}`));
  });

  it("is landed after a slide, which button and key bring up", () => {
    for (const arm of [() => part("land")!.click(), () => void press("KeyL")]) {
      show(new FakeSource(null), someTelemetry({ in_air: true }), loose);
      act(arm);
      expect(part("land-slider")).not.toBeNull();
      expect(source.sent).toEqual([]);
      act(() => {
        landingArmed.value = false;
      });
    }
  });
});

it("shows an order as not done until the vehicle confirms it, with the reason why", () => {
  const order = { order: "abort", way: "return", stage: "waits", because: { code: "no_link" } } as const;
  const note = () => part("order-note");
  const becomes = (stage: "tried" | "done") =>
    act(() => {
      source.tell(craftStatus({ mission_id: "m", phase: "returning", order: { ...order, stage, because: null } }));
      vi.advanceTimersByTime(200);
    });
  show(new FakeSource(), ...inPhase("returning"), someTelemetry(), craftStatus({ mission_id: "m", phase: "returning", order }));
  expect(note()?.dataset.stage).toBe("waits");
  expect(note()?.getAttribute("role")).toBe("alert");
  becomes("tried");
  expect(note()?.dataset.stage).toBe("tried");
  becomes("done");
  expect(note()).toBeNull();
});

it("resumes only what holds or the pilot flies, and only after a slide", () => {
  for (const after of ["taking_off", "planning", "waiting", "flying", "measuring", "returning", "landing"] as const) {
    show(new FakeSource(), ...inPhase(after), someTelemetry());
    expect(part("resume"), after).toBeNull();
  }
  show(new FakeSource(), ...inPhase("manual"), someTelemetry());
  expect(part("resume")).not.toBeNull();
  show(new FakeSource(), ...inPhase("hold"), someTelemetry());
  act(() => part("resume")!.click());
  expect(part("resume-slider")).not.toBeNull();
  expect(source.sent).toEqual([]);
  act(() => void part("resume-slider")!.dispatchEvent(new KeyboardEvent("keydown", { key: " ", bubbles: true })));
  act(() => void vi.advanceTimersByTime(2 * HOLD_MS));
  expect(source.sent).toMatchObject([{ missionId: "m", kind: "resume", craftId: CRAFT }]);
});

it("asks for a slide no more once what it was for has gone away, and does not come back with it", () => {
  const status = (reason: CraftStatus["resume_refused"]) => craftStatus({ mission_id: "m", phase: "hold", resume_refused: reason });
  const told = (...messages: SourceMessage[]) =>
    act(() => {
      source.tell(...messages);
      vi.advanceTimersByTime(200);
    });
  show(new FakeSource(), ...inPhase("hold"), someTelemetry(), status(null));
  act(() => part("resume")!.click());
  act(() => part("land")!.click());
  expect(part("resume-slider")).not.toBeNull();
  expect(part("land-slider")).not.toBeNull();
  told(status({ code: "no_link" }));
  expect(part("resume-slider")).toBeNull();
  told(status(null));
  expect(part("resume-slider")).toBeNull();
  expect(part("resume")!.disabled).toBe(false);

  show(new FakeSource(null), someTelemetry({ in_air: false }), craftStatus({}));
  expect(part("land-slider")).toBeNull();
  show(new FakeSource(), ...inPhase("hold"), someTelemetry(), status(null));
  expect(part("land-slider")).toBeNull();
  expect(part("land")).not.toBeNull();
});

it.each(["mission", "vehicle"])("asks for another slide once another %s is meant", async (what) => {
  const one = { craft_id: "a", mission_id: "mA", phase: "hold" } as const;
  const other = { ...one, ...(what === "mission" ? { mission_id: "mB" } : { craft_id: "b" }) };
  show(new FakeSource(null), craftStatus(one));
  const becomes = (...status: SourceMessage[]) =>
    act(() => {
      source.tell(...status);
      vi.advanceTimersByTime(200);
    });
  for (const name of ["land", "resume"]) {
    becomes(craftStatus(one));
    act(() => part(name)!.click());
    const slide = part(`${name}-slider`)!;
    await act(async () => {
      slide.dispatchEvent(new KeyboardEvent("keydown", { key: " ", bubbles: true }));
      await vi.advanceTimersByTimeAsync(HOLD_MS / 2);
    });
    becomes(craftStatus(other));
    await act(async () => void (await vi.advanceTimersByTimeAsync(2 * HOLD_MS)));
    expect([part(`${name}-slider`), part(name) !== null, source.sent]).toEqual([null, true, []]);
  }
});

it("sends whoever is signed in to the mission's own page to resume: only there its control is known", () => {
  signIn();
  show(new FakeSource("shown"), craftStatus({ mission_id: "m", phase: "hold" }));
  act(() => part("resume")!.click());
  expect([part("resume-slider"), location.hash]).toEqual([null, "#/mission/m"]);
  show(new FakeSource(), ...inPhase("hold"), craftStatus({ mission_id: "m", phase: "hold" }));
  act(() => part("resume")!.click());
  expect(part("resume-slider")).not.toBeNull();
  show(new FakeSource("shown"), craftStatus({ mission_id: "m", phase: "hold" }));
  expect(part("resume-slider")).toBeNull();
  act(() => {
    session.value = null;
  });
  act(() => part("resume")!.click());
  expect(part("resume-slider")).not.toBeNull();
});

it("says of a recording that it is one, and not who steered when it was made", () => {
  class Recording extends FakeSource {
    override readonly happensNow = false;
    override readonly takesCommands = false;
  }
  signIn();
  show(new FakeSource(), ...inPhase("hold"));
  const words = () => part("state-words")!.lastChild!.textContent;
  const then = words();
  expect(part("who-steers")).not.toBeNull();
  show(new Recording(), ...inPhase("hold"));
  expect(words()).toBe(`${t("state.recording")}: ${then}`);
  expect(part("who-steers")).toBeNull();
});

it("offers to resume only when the server would accept it, and says who has control by authority", () => {
  const taken = { ...NOBODY, who: "pilot", taken_by: "mode", mode: "POSCTL" } as const;
  const flies = (authority: Authority): MissionEvent => ({ kind: "authority_changed", craft_id: CRAFT, authority, by: null });
  const refused = { code: "not_given_back", mode: "POSCTL" } as const;
  const status = (reason: CraftStatus["resume_refused"]) =>
    craftStatus({ mission_id: "m", phase: "manual", craft_id: CRAFT, resume_refused: reason });
  const words = () => part("control")!.textContent;

  show(new FakeSource(), ...happens(drafted, flies(taken), phase("manual")), someTelemetry({ who: "pilot" }), status(refused));
  expect(part("resume")!.disabled).toBe(true);
  expect(part("resume")!.title).toContain("POSCTL");
  expect(part("hold")!.className).toContain("refused-now");
  expect(words()).toBe(t("control.pilot", { mode: "POSCTL" }));

  const given = flies({ ...taken, given_back: true });
  show(new FakeSource(), ...happens(drafted, flies(taken), phase("manual"), given), someTelemetry({ who: "pilot" }), status(null));
  expect(part("resume")!.disabled).toBe(false);
  expect(words()).toBe(t("control.givenBack"));

  const failsafe = flies({ ...taken, who: "failsafe", mode: "RTL" });
  const heard = someTelemetry({ who: "failsafe", mode: "RTL" });
  show(new FakeSource(), ...happens(drafted, flies(taken), phase("hold"), failsafe), heard, status(null));
  expect(words()).toBe(t("control.failsafe", { mode: "RTL" }));
});

/** The page's clock started with the page, before this test's time. */
const later = (ms: number) =>
  act(() => {
    vi.advanceTimersByTime(ms);
    moveClock();
  });

it("says what the way home needs and what it would leave, as the server says now", () => {
  show(new FakeSource(), someTelemetry({ battery_percent: 40 }), craftStatus({ battery_to_return_percent: 12.2 }));
  expect(part("battery")!.textContent).toContain("home needs 13 %, leaves 27 %");
});

it("shows values with their age, and none when they are too old", () => {
  show(new FakeSource(), someTelemetry({ battery_percent: 63 }));
  expect(part("battery")!.textContent).toContain("63 %");
  later(5_000);
  expect(part("battery")!.dataset.state).toBe("old");
  later(30_000);
  expect(part("battery")!.dataset.state).toBe("gone");
  expect(part("battery")!.textContent).not.toContain("63");
});

it("counts down to the return of a low battery in hold, which one tap stops", () => {
  const reason = { code: "battery_silent" } as const;
  const counting: MissionEvent = { kind: "battery_countdown_started", craft_id: "craft-1", seconds: 30, reason };
  const flies = someStatus({ mission_id: "m1", phase: "hold" });
  show(new FakeSource(), ...happens(drafted, phase("hold"), counting), flies);
  expect(part("countdown")!.textContent).toMatch(/\d+ s/);
  act(() => part("keep-holding")!.click());
  expect(source.sent.map(({ kind }) => kind)).toContain("keep_holding");
  const over: MissionEvent = { kind: "battery_countdown_stopped", craft_id: "craft-1", by: "Ada" };
  show(new FakeSource(), ...happens(drafted, phase("hold"), counting, over), flies);
  expect(part("countdown")).toBeNull();
});

it("warns below the charge that the way home needs", () => {
  show(new FakeSource(), someTelemetry({ battery_percent: 20 }), craftStatus({ battery_to_return_percent: 30 }));
  expect(part("battery")!.className).toContain("warning");
});

describe("who has control", () => {
  const control = () => part("control")!.textContent;
  const taken = (authority: Partial<Authority>): SourceMessage[] =>
    happens(drafted, phase("manual"), { kind: "authority_changed", craft_id: "craft-1", authority: { ...NOBODY, ...authority }, by: null });

  it("is not known before the vehicle was heard", () => {
    live.value = emptyLive;
    show(new FakeSource());
    expect(control()).toMatch(/not known/);
  });

  it.each([
    ["ours", /^Crossfix/],
    ["pilot", /^The pilot has control \(Loiter\)/],
    ["failsafe", /failsafe has control \(Loiter\)/],
    ["nobody", /^Nobody/],
  ] as const)("is %s as the server says it", (who, words) => {
    show(new FakeSource(), ...inPhase("flying"), someTelemetry({ who, mode: "Loiter" }));
    expect(control()).toMatch(words);
  });

  it("is the pilot until an operator takes it back, in the mode in which they took it", () => {
    const pilots = taken({ who: "pilot", taken_by: "mode", mode: "Position" });
    show(new FakeSource(), ...pilots, someTelemetry({ who: "nobody", mode: "Loiter" }));
    expect(control()).toBe("The pilot has control (Position)");
  });

  it("may be the failsafe's as well as the pilot's, and says so", () => {
    show(new FakeSource(), ...taken({ who: "pilot", taken_by: "mode", mode: "Return", perhaps_failsafe: true }), someTelemetry());
    expect(control()).toMatch(/pilot or .*failsafe/);
  });
});
