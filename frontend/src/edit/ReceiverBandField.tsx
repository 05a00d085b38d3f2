// How wide a band the receiver hears at once: asked where several emitters are looked for.
import { t } from "../i18n";
import { draft, update } from "./draft";

const USUAL_KHZ = [12.5, 25, 50, 100, 250, 1000, 2400];

export function ReceiverBandField() {
  const { sensor, emitters } = draft.value!.spec;
  const band = sensor.receiver_band_hz ?? null;
  if (emitters.length === 1 && band === null) return null;
  const choose = (khz: string) => {
    const now = draft.peek()!;
    const receiver_band_hz = khz === "" ? null : Number(khz) * 1000;
    update({ ...now, spec: { ...now.spec, sensor: { ...now.spec.sensor, receiver_band_hz } } });
  };
  const offered = [...new Set([...USUAL_KHZ, ...(band === null ? [] : [band / 1000])])].sort((a, b) => a - b);
  return (
    <div class="field field-choice">
      <label for="field-receiver-band">{t("edit.receiverBand")}</label>
      <select
        id="field-receiver-band"
        data-testid="field-receiver-band"
        value={band === null ? "" : String(band / 1000)}
        onChange={(e) => choose(e.currentTarget.value)}
      >
        <option value="">{t("edit.receiverBand.all")}</option>
        {offered.map((khz) => (
          <option value={String(khz)} key={khz}>
            {t("edit.receiverBand.khz", { khz })}
          </option>
        ))}
      </select>
    </div>
  );
}
