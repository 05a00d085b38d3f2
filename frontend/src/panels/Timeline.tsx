// Everything that happened: a strip of time with a handle, and the events in words. Live and review are one screen.
import { signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { type MessageKey, t } from "../i18n";
import { minuteStep } from "../state/courses";
import { type EventTone, isMain, toneOf } from "../state/eventWeight";
import { eventWords } from "../state/eventWords";
import { lastFlown } from "../state/flown";
import { cursor, events, liveMission, look } from "../state/moment";
import { settings } from "../state/settings";
import { mission } from "../state/shown";
import { formatClock, formatLength, formatNumber } from "../units/quantities";
import type { MissionEvent, Recorded } from "../wire";
import { Icon } from "./Icon";

const showAll = signal(false);
const pace = signal(10);

/** Seconds of the mission a second. */
const PACES = [0.5, 1, 2, 5, 10, 20, 50];
const JUMPS = ["decision", "bearing", "alert"] as const;

/** Lanes of the strip under its minutes, each from and to, of 30: what the craft did, decisions, bearings, alerts. */
const LANES: Record<Exclude<EventTone, "other">, [number, number]> = {
  mode: [9, 13],
  decision: [14, 18.5],
  bearing: [19.5, 24],
  alert: [25, 29.5],
};

type Doing = "moving" | "measuring" | "held";

function doingOf(event: MissionEvent): Doing | null {
  if (event.kind !== "phase_changed") return null;
  switch (event.after) {
    case "taking_off":
    case "flying":
    case "returning":
    case "landing":
      return "moving";
    case "measuring":
      return "measuring";
    case "hold":
    case "manual":
    case "waiting":
      return "held";
    case "ground":
    case "planning":
      return null;
  }
}

/** What a craft did from one change of its phase to the next, as bars of the first lane. */
function Doings({ all, craftId, share }: { all: readonly Recorded[]; craftId: string | null; share: (at: string) => number }) {
  const changes = all.filter(({ event }) => event.kind === "phase_changed" && event.craft_id === craftId);
  const [from, to] = LANES.mode;
  return changes.map(({ event, at_utc, seq }, i) => {
    const doing = doingOf(event);
    const x = share(at_utc);
    const width = (i + 1 < changes.length ? share(changes[i + 1]!.at_utc) : 100) - x;
    return doing && <rect class={`doing doing-${doing}`} x={x} width={width} y={from} height={to - from} key={seq} />;
  });
}

/** Runs through the recorded moments, `speed` seconds of the mission a second, until somebody looks elsewhere. */
function usePlayback(): [number | null, (speed: number | null) => void] {
  const [speed, setSpeed] = useState<number | null>(null);
  useEffect(() => {
    let shown = cursor.peek();
    const from = events.peek().find((e) => e.seq === shown);
    if (speed === null || !from) return;
    const missionMs = Date.parse(from.at_utc);
    const began = performance.now();
    const timer = setInterval(() => {
      if (cursor.peek() !== shown) return setSpeed(null);
      const time = missionMs + (performance.now() - began) * speed;
      shown = (events.peek().findLast((e) => Date.parse(e.at_utc) <= time) ?? from).seq;
      look(shown);
      if (shown >= lastFlown(events.peek())!.seq) setSpeed(null);
    }, 100);
    return () => clearInterval(timer);
  }, [speed]);
  return [speed, setSpeed];
}

function Strip({ all }: { all: readonly Recorded[] }) {
  const first = all[0];
  const last = all.at(-1);
  const emitters = mission.value.spec?.emitters ?? [];
  if (!first || !last) return null;
  const begin = Date.parse((all.find((e) => e.event.kind === "mission_started") ?? first).at_utc);
  const end = Math.max(begin + 1000, Date.parse(lastFlown(all)!.at_utc));
  const share = (at: string) => Math.min(1, Math.max(0, (Date.parse(at) - begin) / (end - begin))) * 100;
  const step = 60 * minuteStep((end - begin) / 1000);
  const minutes = Array.from({ length: Math.floor((end - begin) / 1000 / step) + 1 }, (_, i) => i * step);
  const rmse = mission.value.beliefs.filter((b) => b.expectedRmse !== null);
  const top = Math.max(1, ...rmse.map((b) => b.expectedRmse!));
  const at = cursor.value === null ? last : (all.findLast((e) => e.seq <= cursor.value!) ?? first);
  const steps = rmse.map((b, i) => {
    const x = share(b.at);
    const y = 29 - 20 * (b.expectedRmse! / top);
    return i === 0 ? `M${x} ${y}` : `H${x}V${y}`;
  });
  const eventAt = (seconds: number) => all.findLast((e) => Date.parse(e.at_utc) <= begin + seconds * 1000) ?? first;
  const settle = (seconds: number) => {
    const nearest = eventAt(seconds);
    look(nearest.seq >= lastFlown(all)!.seq ? null : nearest.seq);
  };
  const scale = rmse.length > 0 ? `${t("timeline.rmse")} ≤ ${formatLength(top, settings.value.units)}` : "";
  return (
    <div class="strip" style={{ "--scale": scale.length }}>
      <svg class="strip-ticks" viewBox="0 0 100 30" preserveAspectRatio="none" aria-hidden="true">
        {steps.length > 0 && <path class="strip-rmse" d={`${steps.join("")}H100`} vector-effect="non-scaling-stroke" />}
        <Doings all={all} craftId={mission.value.craftId} share={share} />
        {all.map((e) => {
          const tone = toneOf(e.event);
          if (tone === "other" || e.event.kind === "phase_changed") return null;
          const [y1, y2] = LANES[tone];
          const x = share(e.at_utc);
          return <line class={`tick tick-${tone}`} x1={x} x2={x} y1={y1} y2={y2} vector-effect="non-scaling-stroke" key={e.seq} />;
        })}
      </svg>
      <div class="strip-minutes" aria-hidden="true" data-testid="strip-minutes">
        {minutes.map((s) => (
          <span style={{ "--at": (1000 * s) / (end - begin) }} key={s}>
            {s === 0 ? t("timeline.minutes") : s / 60}
          </span>
        ))}
      </div>
      {scale !== "" && (
        <span class="strip-scale" aria-hidden="true">
          {scale}
        </span>
      )}
      <input
        type="range"
        data-testid="scrub"
        aria-label={t("timeline.scrub")}
        aria-valuetext={`${formatClock(at.at_utc)} ${eventWords(at, settings.value.units, emitters)}`}
        min={0}
        max={(end - begin) / 1000}
        step={0.1}
        value={Math.min(end - begin, Math.max(0, Date.parse(at.at_utc) - begin)) / 1000}
        onInput={(e) => settle(Number(e.currentTarget.value))}
        onPointerMove={(e) => {
          const { left, width } = e.currentTarget.getBoundingClientRect();
          const under = eventAt((Math.max(0, Math.min(1, (e.clientX - left) / width)) * (end - begin)) / 1000);
          e.currentTarget.title = `${formatClock(under.at_utc)} ${eventWords(under, settings.value.units, emitters)}`;
        }}
        onKeyDown={(e) => {
          const step = e.key === "ArrowLeft" ? -1 : e.key === "ArrowRight" ? 1 : 0;
          if (step === 0) return;
          e.preventDefault();
          stepEvent(step);
        }}
      />
    </div>
  );
}

/** One event back or on; past the newest is live. */
export function stepEvent(step: -1 | 1): void {
  const all = events.peek();
  const last = all.at(-1);
  if (!last) return;
  const target = (cursor.peek() ?? last.seq) + step;
  look(target >= last.seq ? null : Math.max(all[0]!.seq, target));
}

/** To the next event of its kind after the one looked at; from the last one, or live, to the first. */
function jumpTo(tone: EventTone): void {
  const those = events.peek().filter((e) => toneOf(e.event) === tone);
  const next = those.find((e) => e.seq > (cursor.peek() ?? Infinity)) ?? those[0];
  if (next) look(next.seq);
}

/** Snapping to a whole row moves the list by less. */
const ROW_PX = 24;

function Log({ all }: { all: readonly Recorded[] }) {
  const list = useRef<HTMLOListElement>(null);
  const settledAt = useRef(0);
  const scrolledUp = useRef(false);
  const emitters = mission.value.spec?.emitters ?? [];
  const at = cursor.value;
  const shown = showAll.value ? all : all.filter((e) => isMain(e.event));
  const current = at === null ? null : shown.findLast((e) => e.seq <= at)?.seq;
  useEffect(() => {
    const box = list.current;
    if (!box) return;
    const settle = () => {
      const row = box.querySelector<HTMLElement>('[aria-current="true"]');
      if (!row && scrolledUp.current) return;
      box.scrollTop = row ? row.offsetTop - (box.clientHeight - row.offsetHeight) / 2 : box.scrollHeight;
      settledAt.current = box.scrollTop;
      scrolledUp.current = false;
    };
    const resized = new ResizeObserver(settle); // tells at once, and whenever the page's size changes
    resized.observe(box);
    return () => resized.disconnect();
  }, [shown.length, current, all.length === 0]);
  if (all.length === 0) return <p class="muted log-empty">{t("timeline.empty")}</p>;
  return (
    <ol
      class="log"
      ref={list}
      data-testid="event-log"
      aria-label={t("timeline.events")}
      // biome-ignore lint/a11y/noNoninteractiveTabindex: a list that scrolls must be within reach of the keyboard
      tabIndex={0}
      onScroll={({ currentTarget: { scrollHeight, clientHeight, scrollTop } }) => {
        scrolledUp.current = at === null && Math.min(settledAt.current, scrollHeight - clientHeight) - scrollTop > ROW_PX;
      }}
    >
      {shown.map((recorded) => (
        <li key={recorded.seq} aria-current={recorded.seq === current ? "true" : undefined}>
          <button
            type="button"
            class={`log-row log-${toneOf(recorded.event)}`}
            data-testid="event-row"
            data-kind={recorded.event.kind}
            data-seq={recorded.seq}
            onClick={() => look(recorded.seq === all.at(-1)?.seq ? null : recorded.seq)}
          >
            <time>{formatClock(recorded.at_utc)}</time>
            <span>{eventWords(recorded, settings.value.units, emitters)}</span>
          </button>
        </li>
      ))}
    </ol>
  );
}

function liveLabel(reviewing: boolean): MessageKey {
  const over = liveMission.value.ended !== null;
  if (reviewing) return over ? "timeline.toEnd" : "timeline.goLive";
  return over ? "timeline.review" : "timeline.live";
}

export function Timeline() {
  const all = events.value;
  const reviewing = cursor.value !== null;
  const [speed, play] = usePlayback();
  return (
    <section class="timeline" aria-label={t("timeline.label")} data-testid="timeline" data-tour="6">
      <Strip all={all} />
      <div class="timeline-controls">
        <div class="timeline-run">
          <button
            type="button"
            class={reviewing ? "primary" : "is-live"}
            data-testid="go-live"
            data-live={!reviewing}
            onClick={() => look(null)}
          >
            {t(liveLabel(reviewing))}
          </button>
          <button
            type="button"
            class="icon"
            aria-label={t("timeline.previous")}
            data-testid="step-back"
            disabled={all.length === 0}
            onClick={() => stepEvent(-1)}
          >
            <Icon name="back" />
          </button>
          <button
            type="button"
            class="icon"
            aria-label={t("timeline.next")}
            data-testid="step-on"
            disabled={!reviewing}
            onClick={() => stepEvent(1)}
          >
            <Icon name="on" />
          </button>
          <button
            type="button"
            data-testid="play"
            disabled={all.length === 0}
            onClick={() => {
              if (speed === null && (cursor.peek() ?? Infinity) >= lastFlown(all)!.seq) look(all[0]!.seq);
              play(speed === null ? pace.value : null);
            }}
          >
            <Icon name={speed === null ? "play" : "pause"} />
            <span class="play-word">{t(speed === null ? "timeline.play" : "timeline.pause")}</span>
          </button>
        </div>
        <div class="timeline-run">
          <select
            data-testid="pace"
            aria-label={t("timeline.pace")}
            value={pace.value}
            onChange={(e) => {
              pace.value = Number(e.currentTarget.value);
              if (speed !== null) play(pace.value);
            }}
          >
            {PACES.map((one) => (
              <option value={one} key={one}>
                {formatNumber(one, one < 1 ? 1 : 0)}×
              </option>
            ))}
          </select>
          <select
            class="jump"
            data-testid="jump"
            aria-label={t("timeline.jump")}
            value=""
            disabled={all.length === 0}
            onChange={(e) => {
              jumpTo(e.currentTarget.value as EventTone);
              e.currentTarget.value = "";
            }}
          >
            <option value="">{t("timeline.jump")}</option>
            {JUMPS.filter((tone) => all.some((e) => toneOf(e.event) === tone)).map((tone) => (
              <option value={tone} key={tone}>
                {t(`timeline.jump.${tone}`)}
              </option>
            ))}
          </select>
          <label class="check">
            <input type="checkbox" checked={showAll.value} onChange={(e) => (showAll.value = e.currentTarget.checked)} />
            {t("timeline.filter.all")}
          </label>
        </div>
      </div>
      <Log all={all} />
    </section>
  );
}
