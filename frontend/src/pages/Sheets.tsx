// Sheets over the page: settings, keys, tour.
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { type Language, type MessageKey, t } from "../i18n";
import { Instruments } from "../panels/Instruments";
import { type Overlay, overlay } from "../state/overlay";
import { change, type Settings, settings } from "../state/settings";
import type { CoordinateFormat } from "../units/coordinates";
import type { UnitSystem } from "../units/quantities";
import { Tour } from "./Tour";

const close = () => {
  overlay.value = null;
};

function Sheet({ title, testId, children }: { title: string; testId: string; children: ComponentChildren }) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const before = document.activeElement;
    box.current?.focus();
    return () => {
      if (before instanceof HTMLElement) before.focus();
    };
  }, []);
  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: keys close it with Escape, wherever the focus is
    <div class="sheet-back" role="presentation" onClick={(e) => e.target === e.currentTarget && close()}>
      <div class="sheet" role="dialog" aria-modal="true" aria-label={title} data-testid={testId} ref={box} tabIndex={-1}>
        <div class="sheet-head">
          <h1>{title}</h1>
          <button type="button" class="icon" aria-label={t("menu.close")} onClick={close}>
            ✕
          </button>
        </div>
        {children}
      </div>
    </div>
  );
}

interface Option<T> {
  value: T;
  label: MessageKey;
}

function Pick<K extends keyof Settings>({
  name,
  label,
  options,
}: {
  name: K;
  label: MessageKey;
  options: readonly Option<Settings[K] & string>[];
}) {
  const id = `setting-${name}`;
  return (
    <div class="field">
      <label for={id}>{t(label)}</label>
      <select
        id={id}
        data-testid={id}
        value={String(settings.value[name])}
        onChange={(e) => change(name, e.currentTarget.value as Settings[K])}
      >
        {options.map((o) => (
          <option value={o.value} key={o.value}>
            {t(o.label)}
          </option>
        ))}
      </select>
    </div>
  );
}

function Toggle({ name, label }: { name: "tones" | "speech" | "lite"; label: MessageKey }) {
  return (
    <label class="check field-switch">
      <input type="checkbox" checked={settings.value[name]} onChange={(e) => change(name, e.currentTarget.checked)} />
      {t(label)}
    </label>
  );
}

const THEMES: Option<Settings["theme"]>[] = [
  { value: "outdoor", label: "settings.theme.outdoor" },
  { value: "indoor", label: "settings.theme.indoor" },
];
const UNITS: Option<UnitSystem>[] = [
  { value: "metric", label: "settings.units.metric" },
  { value: "imperial", label: "settings.units.imperial" },
];
const FORMATS: Option<CoordinateFormat>[] = [
  { value: "dd", label: "settings.coordinates.dd" },
  { value: "dms", label: "settings.coordinates.dms" },
  { value: "utm", label: "settings.coordinates.utm" },
  { value: "mgrs", label: "settings.coordinates.mgrs" },
];
const LANGUAGES: Option<Language>[] = [
  { value: "en", label: "settings.language.en" },
  { value: "de", label: "settings.language.de" },
];
const SCALES = [0.85, 1, 1.15, 1.3];

function SettingsSheet() {
  return (
    <Sheet title={t("settings.title")} testId="settings">
      <Pick name="theme" label="settings.theme" options={THEMES} />
      <div class="field">
        <label for="setting-scale">{t("settings.scale")}</label>
        <select id="setting-scale" value={String(settings.value.scale)} onChange={(e) => change("scale", Number(e.currentTarget.value))}>
          {SCALES.map((scale) => (
            <option value={String(scale)} key={scale}>
              {Math.round(scale * 100)} %
            </option>
          ))}
        </select>
      </div>
      <Pick name="units" label="settings.units" options={UNITS} />
      <Pick name="coordinates" label="settings.coordinates" options={FORMATS} />
      <Pick name="language" label="settings.language" options={LANGUAGES} />
      <Toggle name="tones" label="settings.tones" />
      <Toggle name="speech" label="settings.speech" />
      <Toggle name="lite" label="settings.lite" />
    </Sheet>
  );
}

const KEYS: readonly [MessageKey, readonly string[]][] = [
  ["keys.abort", ["Alt", "Shift", "A"]],
  ["keys.hold", ["Alt", "Shift", "H"]],
  ["keys.return", ["Alt", "Shift", "R"]],
  ["keys.land", ["Alt", "Shift", "L"]],
  ["keys.confirm", ["␣"]],
  ["keys.cancel", ["Esc"]],
  ["keys.alerts", ["a"]],
  ["alerts.mute", ["m"]],
  ["timeline.goLive", ["l"]],
  ["keys.step", ["←", "→"]],
  ["keys.missions", ["g"]],
  ["keys.sheet", ["?"]],
];

function KeysSheet() {
  return (
    <Sheet title={t("keys.title")} testId="key-sheet">
      <table class="keys">
        <tbody>
          {KEYS.map(([label, keys]) => (
            <tr key={label}>
              <td>{t(label)}</td>
              <td>
                {keys.map((key) => (
                  <kbd key={key}>{key === "␣" ? t("keys.space") : key}</kbd>
                ))}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Sheet>
  );
}

export function Sheets({ which }: { which: Overlay }) {
  if (which === "settings") return <SettingsSheet />;
  if (which === "keys") return <KeysSheet />;
  if (which === "instruments") {
    return (
      <Sheet title={t("instruments.title")} testId="instruments">
        <Instruments />
      </Sheet>
    );
  }
  return <Tour />;
}
