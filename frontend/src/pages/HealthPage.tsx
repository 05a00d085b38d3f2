// How the server is, in words: each part, what is wrong with it, and how to mend it.
import type { ComponentChildren } from "preact";
import { useEffect, useState } from "preact/hooks";
import { asProblem } from "../commands/send";
import { reasonRemedy, reasonText, t } from "../i18n";
import { ProblemBox } from "../panels/ProblemNote";
import * as api from "../sources/api";
import { autopilotWords } from "../state/words";
import { formatClock, formatDuration, formatNumber } from "../units/quantities";
import type { Health, Problem, Reason } from "../wire";

const REFRESH_MS = 3000;
const DATABASES = { sqlite: "SQLite", postgresql: "PostgreSQL" } as const;

function Part({ name, good, children }: { name: string; good: boolean; children: ComponentChildren }) {
  return (
    <section class="card health-part" data-testid="health-part" data-good={good}>
      <h2>{name}</h2>
      {children}
    </section>
  );
}

const Why = ({ reason }: { reason: Reason }) => (
  <p class="refused">
    {reasonText(reason)} {reasonRemedy(reason)}
  </p>
);

const megabytes = (bytes: number | null) => (bytes === null ? "?" : formatNumber(Math.round(bytes / 1e6)));

function StockLine({ stock }: { stock: Health["stocks"][number] }) {
  const number = stock.number === null ? "?" : formatNumber(stock.number);
  const room = { most: formatNumber(stock.most), size: megabytes(stock.size_bytes), room: megabytes(stock.most_bytes) };
  return (
    <>
      <p data-testid={`stock-${stock.what}`}>{t(`health.stock.${stock.what}`, { number, ...room })}</p>
      {stock.full && <p class="refused">{t("health.stockFull")}</p>}
    </>
  );
}

function ByUdp({ told }: { told: NonNullable<Health["bearings_udp"]> }) {
  const { host, port, taken, refused, senders } = told;
  return (
    <Part name={t("health.udp")} good>
      <p data-testid="udp-counts">
        {t("health.udpCounts", { host, port: String(port), taken: formatNumber(taken), refused: formatNumber(refused) })}
      </p>
      {senders.map((one) => (
        <p data-testid="udp-refused" key={one.address}>
          {t("health.udpRefused", {
            sender: one.name === null ? one.address : `${one.name} (${one.address})`,
            count: formatNumber(one.refused),
            time: `${formatClock(one.at_utc)} UTC`,
          })}{" "}
          {reasonText(one.reason)} {reasonRemedy(one.reason)}
        </p>
      ))}
    </Part>
  );
}

function Parts({ health }: { health: Health }) {
  const { database } = health;
  return (
    <>
      <p role="status" data-testid="health-state" data-state={health.state}>
        <strong>{t(`health.${health.state}`)}</strong>
      </p>
      <Part name={t("health.server")} good>
        <p>{t("health.serverRuns", { version: health.version, time: formatDuration(health.uptime_s) })}</p>
        {health.simulated && <p>{t("health.simulated", { factor: formatNumber(health.time_factor) })}</p>}
        <p>{t("health.viewers", { count: health.viewers })}</p>
      </Part>
      <Part name={t("health.database")} good={database.state === "ok" && database.refused === 0}>
        {database.reason ? <Why reason={database.reason} /> : <p>{t("health.databaseOk", { kind: DATABASES[database.kind] })}</p>}
        {database.spooled > 0 && <p>{t("health.spooled", { count: database.spooled })}</p>}
        {database.refused > 0 && <p class="refused">{t("health.refused", { count: database.refused })}</p>}
        <p class="muted">
          {health.keep_sweeps_days === null
            ? t("health.keepForever")
            : t("health.keepDays", { days: formatNumber(health.keep_sweeps_days) })}
        </p>
      </Part>
      <Part name={t("health.disk")} good={!health.stocks.some((stock) => stock.full)}>
        <p>
          {health.disk_free_bytes === null
            ? t("health.diskUnknown")
            : t("health.diskFree", { size: `${formatNumber(health.disk_free_bytes / 1e9, 1)} GB` })}
        </p>
        {health.stocks.map((stock) => (
          <StockLine stock={stock} key={stock.what} />
        ))}
      </Part>
      {health.vehicles.map((vehicle) => (
        <Part name={t("health.vehicle", { craft: vehicle.craft_id })} good={vehicle.connected} key={vehicle.craft_id}>
          {vehicle.reason ? (
            <Why reason={vehicle.reason} />
          ) : (
            <p>{t("health.vehicleOk", { autopilot: autopilotWords(vehicle.autopilot) })}</p>
          )}
        </Part>
      ))}
      {health.bearings_udp && <ByUdp told={health.bearings_udp} />}
    </>
  );
}

export function HealthPage() {
  const [health, setHealth] = useState<Health | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  useEffect(() => {
    const read = () =>
      api.health().then(
        (told) => {
          setHealth(told);
          setProblem(null);
        },
        (error: unknown) => {
          setHealth(null);
          setProblem(asProblem(error));
        },
      );
    void read();
    const timer = setInterval(() => void read(), REFRESH_MS);
    return () => clearInterval(timer);
  }, []);
  return (
    <div class="page" data-testid="health">
      <h1>{t("health.title")}</h1>
      {problem && (
        <>
          <p>{t("health.unknown")}</p>
          <ProblemBox problem={problem} />
        </>
      )}
      {health && <Parts health={health} />}
    </div>
  );
}
