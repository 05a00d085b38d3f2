// Slide, or hold the space bar for 1.5 s, to confirm. Expires when it is left alone.
import { useEffect, useRef, useState } from "preact/hooks";
import { t } from "../i18n";

export const HOLD_MS = 1500;
export const EXPIRES_S = 20;
const CONFIRM_AT = 0.92;

interface Properties {
  label: string;
  testId: string;
  /** Where it returns a promise, the slide can be drawn again once that has settled. */
  onConfirm: () => unknown;
  onCancel: () => void;
  /** Seconds until it goes away by itself. */
  expiresS?: number;
}

export function SlideToConfirm({ label, testId, onConfirm, onCancel, expiresS = EXPIRES_S }: Properties) {
  const track = useRef<HTMLDivElement>(null);
  const [position, setPosition] = useState(0);
  const [left, setLeft] = useState(expiresS);
  const dragFrom = useRef<number | null>(null);
  const holding = useRef<number | null>(null);
  const heldSince = useRef<number | null>(null);
  const confirmed = useRef(false);

  const confirm = async () => {
    if (confirmed.current) return;
    confirmed.current = true;
    setPosition(1);
    await onConfirm();
    confirmed.current = false;
    release();
    setLeft(expiresS);
  };

  const release = () => {
    if (holding.current !== null) cancelAnimationFrame(holding.current);
    holding.current = null;
    heldSince.current = null;
    dragFrom.current = null;
    if (!confirmed.current) setPosition(0);
  };
  useEffect(() => {
    track.current!.focus({ preventScroll: true });
    const timer = setInterval(() => {
      if (dragFrom.current === null && holding.current === null) setLeft((seconds) => seconds - 1);
    }, 1000);
    return () => {
      clearInterval(timer);
      release();
    };
  }, []);

  useEffect(() => {
    if (left <= 0 && !confirmed.current) onCancel();
  }, [left]);

  const hold = (began: number) => {
    if (holding.current !== null) return;
    heldSince.current = began;
    const step = () => {
      const share = (performance.now() - began) / HOLD_MS;
      setPosition(Math.min(1, share));
      if (share >= 1) {
        holding.current = null;
        void confirm();
      } else holding.current = requestAnimationFrame(step);
    };
    holding.current = requestAnimationFrame(step);
  };

  // A busy page may draw no frame in the last moment before the key comes up: the events' own times decide.
  const onKeyUp = (event: KeyboardEvent) => {
    if (event.key !== " ") return;
    if (heldSince.current !== null && event.timeStamp - heldSince.current >= HOLD_MS) void confirm();
    release();
  };

  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key === " ") {
      event.preventDefault();
      if (!event.repeat) hold(event.timeStamp);
    } else if (event.key === "Escape") {
      event.stopPropagation();
      onCancel();
    }
  };

  /** How far the knob has been drawn, 0..1, when the pointer is at `x`. */
  const shareAt = (x: number) => {
    const travel = track.current ? track.current.clientWidth - track.current.clientHeight : 1;
    return Math.min(1, Math.max(0, (x - (dragFrom.current ?? x)) / travel));
  };

  return (
    <div class="slide-row">
      <div
        ref={track}
        class="slide"
        data-testid={testId}
        role="slider"
        tabIndex={0}
        aria-label={`${label}, ${t("slide.hint")}`}
        aria-valuemin={0}
        aria-valuemax={100}
        aria-valuenow={Math.floor(position * 100)}
        onKeyDown={onKeyDown}
        onKeyUp={onKeyUp}
        onBlur={release}
      >
        <div class="slide-fill" style={{ width: `calc(var(--target) + (100% - var(--target)) * ${position})` }} />
        <span class="slide-label">
          {label}
          <small>
            {t("slide.hint")} · {t("slide.expires", { seconds: Math.max(0, left) })}
          </small>
        </span>
        <div
          class="slide-knob"
          style={{ left: `calc((100% - var(--target)) * ${position})` }}
          onPointerDown={(event) => {
            event.currentTarget.setPointerCapture(event.pointerId);
            dragFrom.current = event.clientX;
          }}
          onPointerMove={(event) => {
            if (dragFrom.current === null) return;
            setPosition(shareAt(event.clientX));
          }}
          onPointerUp={(event) => {
            if (dragFrom.current !== null && shareAt(event.clientX) >= CONFIRM_AT) void confirm();
            release();
          }}
          onPointerCancel={release}
          aria-hidden="true"
        >
          ›
        </div>
      </div>
      <button type="button" class="icon" aria-label={t("slide.cancel")} data-testid={`${testId}-cancel`} onClick={onCancel}>
        ✕
      </button>
    </div>
  );
}
