// Vehicle and receiver in full: every value with its age, and the last five minutes as lines.
import { signal } from "@preact/signals";
import { type MessageKey, t } from "../i18n";
import { ageS, freshness } from "../state/age";
import { nowMs } from "../state/clock";
import { live, serverNowMs } from "../state/connection";
import { craftStatus, telemetry } from "../state/heard";
import { emptySeries, extend, type Series } from "../state/series";
import { settings } from "../state/settings";
import { autopilotWords } from "../state/words";
import { formatAge, formatBearing, formatLength, formatNumber, formatSpeed } from "../units/quantities";
import { Chart } from "./Chart";
import { Payloads } from "./Payloads";

const series = signal<Series>(emptySeries);

interface Row {
  label: MessageKey;
  value: string | null;
  age: number | null;
}

function Values() {
  const now = nowMs.value;
  const units = settings.value.units;
  const { status } = live.value;
  const value = telemetry.value?.value;
  const at = telemetry.value?.atMs ?? null;
  const craft = craftStatus.value;
  const length = (metres: number | null | undefined) => (metres == null ? null : formatLength(metres, units));
  const position = ageS(value?.position_age_s, at, now);
  const heard = ageS(craft?.value.receiver_age_s, craft?.atMs ?? null, now);
  const rows: Row[] = [
    { label: "instruments.autopilot", value: value ? autopilotWords(value.autopilot) : null, age: ageS(0, at, now) },
    { label: "instruments.mode", value: value?.mode ?? null, age: ageS(value?.mode_age_s, at, now) },
    {
      label: "instruments.armed",
      value: value?.armed == null ? null : t(value.armed ? "instruments.yes" : "instruments.no"),
      age: ageS(value?.mode_age_s, at, now),
    },
    { label: "instruments.altitude", value: length(value?.altitude_relative_m), age: position },
    { label: "instruments.amsl", value: length(value?.altitude_amsl_m), age: position },
    {
      label: "instruments.speed",
      value: value?.ground_speed_m_s == null ? null : formatSpeed(value.ground_speed_m_s, units),
      age: position,
    },
    { label: "instruments.climb", value: value?.climb_m_s == null ? null : formatSpeed(value.climb_m_s, units), age: position },
    {
      label: "instruments.heading",
      value: value?.heading_deg == null ? null : formatBearing(value.heading_deg),
      age: ageS(value?.heading_age_s, at, now),
    },
    {
      label: "instruments.power",
      value: craft?.value.receiver_power_db == null ? null : `${formatNumber(craft.value.receiver_power_db, 1)}\u00a0dB`,
      age: heard,
    },
    ...(craft?.value.settling_samples
      ? [{ label: "instruments.settling" as const, value: String(craft.value.settling_samples), age: ageS(0, craft.atMs, now) }]
      : []),
    ...(craft?.value.receiver_lost_percent
      ? [{ label: "instruments.lost" as const, value: `${formatNumber(craft.value.receiver_lost_percent, 1)}\u00a0%`, age: heard }]
      : []),
    { label: "instruments.viewers", value: status ? String(status.value.viewers) : null, age: ageS(0, status?.atMs ?? null, now) },
    {
      label: "instruments.database",
      value: status ? t(`instruments.database.${status.value.database}`) : null,
      age: ageS(0, status?.atMs ?? null, now),
    },
    { label: "instruments.dropped", value: value ? String(value.dropped) : null, age: ageS(0, at, now) },
  ];
  return (
    <table class="keys">
      <tbody>
        {rows.map(({ label, value: shown, age }) => (
          <tr key={label} class={freshness(age)}>
            <td>{t(label)}</td>
            <td>
              {shown === null || freshness(age) === "gone" ? "–" : shown}{" "}
              {freshness(age) === "old" && age !== null && <small>{t("bar.age", { age: formatAge(age) })}</small>}
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

/** Called once the chunk is there: the lines begin with the first look. */
export function collect(): void {
  const heard = telemetry.peek()?.value;
  series.value = extend(series.peek(), {
    t: serverNowMs.peek() / 1000,
    powerDb: craftStatus.peek()?.value.receiver_power_db ?? null,
    altitudeM: heard?.altitude_relative_m ?? null,
    batteryPercent: heard?.battery_percent ?? null,
  });
}
setInterval(collect, 1000);

export function Instruments() {
  const { t: times, powerDb, altitudeM, batteryPercent } = series.value;
  return (
    <>
      <Values />
      <Payloads />
      <Chart t={times} values={powerDb} label={t("instruments.chart.power")} />
      <Chart t={times} values={altitudeM} label={t("instruments.chart.altitude")} />
      <Chart t={times} values={batteryPercent} label={t("instruments.chart.battery")} />
    </>
  );
}
