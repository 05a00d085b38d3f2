"""Figures for Prometheus: what happens is counted here, what is so is asked for when it is read."""

from __future__ import annotations

import asyncio
import logging
import shutil
import time
from collections.abc import AsyncGenerator, Callable, Iterable
from contextlib import asynccontextmanager

from prometheus_client import CollectorRegistry, Counter, Histogram, ProcessCollector, generate_latest
from prometheus_client.core import GaugeMetricFamily, Metric
from prometheus_client.registry import Collector
from starlette.routing import Route
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from backend.api.services import Services
from backend.commands import CommandReply
from backend.version import VERSION

log = logging.getLogger("crossfix.api")

ANSWER_BUCKETS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)
LAG_BUCKETS = (0.001, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 1.0)
LOOK_S = 0.5


class Meters:
    """One set an application; every label has few values (routes, not addresses; kinds, not ids)."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        ProcessCollector(registry=self.registry)
        self.requests = Counter(
            "crossfix_http_requests", "Answered requests.", ("method", "route", "status"), registry=self.registry
        )
        self.answers = Histogram(
            "crossfix_http_request_seconds",
            "Request to answer.",
            ("route",),
            buckets=ANSWER_BUCKETS,
            registry=self.registry,
        )
        self.commands = Counter(
            "crossfix_commands", "Commands of operators.", ("command", "accepted"), registry=self.registry
        )
        self.lag = Histogram(
            "crossfix_event_loop_lag_seconds",
            "How late the event loop was: an abort waits as long.",
            buckets=LAG_BUCKETS,
            registry=self.registry,
        )

    def watch(self, services: Callable[[], Services]) -> None:
        """Read the state of these when asked. Once."""
        self.registry.register(_State(services))

    def count_command(self, kind: str, reply: CommandReply) -> None:
        """A command was answered: counted, and said in the log."""
        self.commands.labels(kind, str(reply.accepted).lower()).inc()
        because = "" if reply.reason is None else f" ({reply.reason.code})"
        log.info("command %s %s%s", kind, "accepted" if reply.accepted else "refused", because)

    def page(self) -> bytes:
        """In Prometheus' text format."""
        return generate_latest(self.registry)

    @asynccontextmanager
    async def watched_loop(self) -> AsyncGenerator[None]:
        """Measures the lag of the running event loop inside the block."""
        task = asyncio.create_task(self._look())
        try:
            yield
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    async def _look(self) -> None:
        while True:
            began = time.monotonic()
            await asyncio.sleep(LOOK_S)
            self.lag.observe(max(0.0, time.monotonic() - began - LOOK_S))


class Metered:
    """ASGI middleware: counts and times what is answered over HTTP."""

    def __init__(self, app: ASGIApp, meters: Meters) -> None:
        self._app = app
        self._meters = meters

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Websockets pass uncounted: they are viewers, and last as long as their page."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        began, status = time.monotonic(), 500

        async def send_counted(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        try:
            await self._app(scope, receive, send_counted)
        finally:
            route = _route(scope)
            self._meters.requests.labels(scope["method"][:10], route, str(status)).inc()
            self._meters.answers.labels(route).observe(time.monotonic() - began)


def _route(scope: Scope) -> str:
    route = scope.get("route")
    return route.path if isinstance(route, Route) else "page"


class _State(Collector):
    def __init__(self, services: Callable[[], Services]) -> None:
        self._services = services

    def describe(self) -> Iterable[Metric]:
        """Nothing is known before the services run."""
        return []

    def collect(self) -> Iterable[Metric]:
        """Asks nobody who could keep it waiting."""
        services = self._services()
        report = services.journal.report()
        build = GaugeMetricFamily("crossfix_build_info", "The version that runs.", labels=("version",))
        build.add_metric((VERSION,), 1.0)
        yield build
        yield _one("crossfix_uptime_seconds", "Since its start.", time.monotonic() - services.began_monotonic_s)
        database = GaugeMetricFamily("crossfix_database_state", "1 for the state it is in.", labels=("state",))
        for state in ("ok", "slow", "lost"):
            database.add_metric((state,), float(report.state == state))
        yield database
        yield _one("crossfix_spooled_entries", "Wait on disk for the database.", report.spooled)
        yield _one("crossfix_refused_entries", "Kept aside: the database never takes them.", report.refused)
        yield _one("crossfix_viewers", "Open pages.", services.hub.viewers())
        yield _one(
            "crossfix_mission_in_flight", "A mission flies.", float(services.missions.flights.active is not None)
        )
        free = free_bytes(services)
        if free is not None:
            yield _one("crossfix_disk_free_bytes", "Where the data directory lies.", free)
        yield from _vehicles(services)
        if services.payload is not None:
            heard = services.payload.agents.values()
            yield _one("crossfix_payloads_connected", "Companion computers.", sum(agent.connected for agent in heard))


def _vehicles(services: Services) -> Iterable[Metric]:
    connected = GaugeMetricFamily("crossfix_vehicle_connected", "Its autopilot is heard.", labels=("craft",))
    battery = GaugeMetricFamily("crossfix_vehicle_battery_percent", "As it says itself.", labels=("craft",))
    for craft in services.missions.equipment.crafts.values():
        telemetry = craft.vehicle.telemetry()
        connected.add_metric((craft.craft_id,), float(telemetry.connected))
        if telemetry.battery_percent is not None:
            battery.add_metric((craft.craft_id,), telemetry.battery_percent)
    yield connected
    yield battery


def _one(name: str, says: str, value: float) -> Metric:
    return GaugeMetricFamily(name, says, value=value)


def free_bytes(services: Services) -> int | None:
    """Of the disk that the data directory lies on; None when it does not say."""
    try:
        return shutil.disk_usage(services.settings.data_dir).free
    except OSError:
        return None
