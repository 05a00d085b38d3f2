// Tones and speech for alerts that are new: a triple for a warning, a double for a caution, none for an advisory.
import { effect } from "@preact/signals";
import { reasonText, t } from "../i18n";
import { isOpen } from "../state/alerts";
import { live } from "../state/connection";
import { craftAlerts } from "../state/craftAlerts";
import { cursor } from "../state/moment";
import { settings } from "../state/settings";
import type { AlertLevel } from "../wire";

const TONES: Record<AlertLevel, { hertz: number; times: number }> = {
  warning: { hertz: 880, times: 3 },
  caution: { hertz: 660, times: 2 },
  advisory: { hertz: 0, times: 0 },
};

let context: AudioContext | null = null;

function beep(level: AlertLevel): void {
  const { hertz, times } = TONES[level];
  if (times === 0) return;
  context ??= new AudioContext();
  for (let i = 0; i < times; i++) {
    const tone = context.createOscillator();
    const gain = context.createGain();
    gain.gain.value = 0.2;
    tone.frequency.value = hertz;
    tone.connect(gain).connect(context.destination);
    tone.start(context.currentTime + 0.22 * i);
    tone.stop(context.currentTime + 0.22 * i + 0.14);
  }
}

function say(text: string): void {
  if (!("speechSynthesis" in window)) return;
  const utterance = new SpeechSynthesisUtterance(text);
  utterance.lang = settings.peek().language;
  speechSynthesis.speak(utterance);
}

export function watchAlerts(): void {
  let known = new Set<string>();
  let knownMission: string | null = null;
  let primed = false;
  effect(() => {
    const { mission, hello } = live.value;
    const open = [...mission.alerts, ...craftAlerts.value].filter(isOpen);
    if (mission.missionId !== knownMission || !primed) {
      // What was already open when the page came is shown, but not sounded again.
      knownMission = mission.missionId;
      primed = hello !== null && mission.lastSeq >= hello.last_seq;
      known = new Set(open.map((a) => a.id));
      return;
    }
    const fresh = open.filter((a) => !known.has(a.id));
    known = new Set(open.map((a) => a.id));
    if (cursor.peek() !== null) return;
    for (const alert of fresh) {
      if (settings.peek().tones) beep(alert.level);
      if (settings.peek().speech) say(`${t(`alerts.${alert.level}`)}. ${reasonText(alert.reason)}`);
    }
  });
}
