// Sheets over the page: settings, keys, tour.
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { type MessageKey, t } from "../i18n";
import { Instruments } from "../panels/Instruments";
import { type Overlay, overlay } from "../state/overlay";
import { CHOICES, change, type Settings, settings } from "../state/settings";
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

function Pick({ name }: { name: Exclude<keyof typeof CHOICES, "scale"> }) {
  const id = `setting-${name}`;
  return (
    <div class="field">
      <label for={id}>{t(`settings.${name}`)}</label>
      <select
        id={id}
        data-testid={id}
        value={settings.value[name]}
        onChange={(e) => change(name, e.currentTarget.value as Settings[typeof name])}
      >
        {CHOICES[name].map((value) => (
          <option value={value} key={value}>
            {t(`settings.${name}.${value}` as MessageKey)}
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

function SettingsSheet() {
  return (
    <Sheet title={t("settings.title")} testId="settings">
      <Pick name="theme" />
      <div class="field">
        <label for="setting-scale">{t("settings.scale")}</label>
        <select
          id="setting-scale"
          value={String(settings.value.scale)}
          onChange={(e) => change("scale", Number(e.currentTarget.value) as Settings["scale"])}
        >
          {CHOICES.scale.map((scale) => (
            <option value={String(scale)} key={scale}>
              {Math.round(scale * 100)} %
            </option>
          ))}
        </select>
      </div>
      <Pick name="units" />
      <Pick name="coordinates" />
      <Pick name="language" />
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
