// The companion computers that listen: link, radio, clock, temperature, clipping, and what is still on its way.
import { useEffect, useState } from "preact/hooks";
import { type MessageKey, reasonText, t } from "../i18n";
import * as api from "../sources/api";
import { source } from "../state/connection";
import { formatAge, formatNumber } from "../units/quantities";
import type { PayloadList } from "../wire";

const ASK_MS = 2000;

type Payload = PayloadList["payloads"][number];

interface Row {
  label: MessageKey;
  value: string;
  bad?: boolean;
}

export function rowsOf(payload: Payload): Row[] {
  const { clock_offset_s: offset, round_trip_s: trip, temperature_c: temperature } = payload;
  return [
    {
      label: "payload.link",
      value: payload.connected ? t("payload.connected") : t("payload.gone", { age: formatAge(payload.age_s) }),
      bad: !payload.connected,
    },
    { label: "payload.radio", value: payload.receiver ? reasonText(payload.receiver) : "–", bad: !payload.receiver_ok },
    { label: "payload.clock", value: offset === null ? t("payload.clockUnknown") : `${formatNumber(1000 * offset, 0)} ms` },
    { label: "payload.trip", value: trip === null ? "–" : `${formatNumber(1000 * trip, 0)} ms` },
    { label: "payload.temperature", value: temperature === null ? "–" : `${formatNumber(temperature, 0)} °C` },
    { label: "payload.clipping", value: `${formatNumber(payload.clipped_percent, 1)} %`, bad: payload.clipped_percent > 5 },
    { label: "payload.waiting", value: t("payload.samples", { count: payload.waiting }) },
    ...(payload.lost > 0 ? [{ label: "payload.lost" as const, value: t("payload.samples", { count: payload.lost }), bad: true }] : []),
  ];
}

export function Payloads() {
  const [list, setList] = useState<PayloadList | null>(null);
  const expected = source.value?.keptByServer;
  useEffect(() => {
    if (!expected) return;
    const ask = () => void api.payloads().then(setList, () => setList(null));
    ask();
    const timer = setInterval(ask, ASK_MS);
    return () => clearInterval(timer);
  }, [expected]);
  if (!list?.expected) return null;
  if (list.payloads.length === 0) return <p class="muted">{t("payload.none")}</p>;
  return (
    <>
      {list.payloads.map((payload) => (
        <section key={payload.name} data-testid="payload">
          <h3>{t("payload.title", { name: payload.name })}</h3>
          <table class="keys">
            <tbody>
              {rowsOf(payload).map(({ label, value, bad }) => (
                <tr key={label}>
                  <td>{t(label)}</td>
                  <td class={bad ? "refused" : ""}>{value}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </section>
      ))}
    </>
  );
}
