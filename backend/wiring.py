"""The only place that names concrete adapters: settings in, the parts of a running server out."""

from __future__ import annotations

import asyncio
import gc
import logging
import threading
import time
from collections.abc import AsyncGenerator, Sequence
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

from backend.api.services import Services
from backend.api.suggestion import suggested_mission
from backend.api.upload_folder import remove_left_behind
from backend.auth.access import Access
from backend.auth.audit import AuditLog
from backend.auth.records import Records
from backend.bearing_feed import BearingFeed, DatagramRefused, open_feed
from backend.craft.equipment import CraftEquipment
from backend.craft.reconnecting_vehicle import ReconnectingVehicle
from backend.events import FIRST_CRAFT, Recorded
from backend.first_hold import FirstHold
from backend.live.hub import Hub
from backend.maps.terrain_folder import TerrainFolder
from backend.mission.equipment import MissionEquipment
from backend.mission.room import MissionRoom, mission_room
from backend.reasons.datagrams import NoSearchFlies
from backend.search.first_beliefs import fold_first_beliefs, in_a_strip
from backend.search.forecast import preview
from backend.search.localization import localization
from backend.search.reported import ReportedBearing, on_our_clock
from backend.settings import AUDIT_FILE, Settings
from backend.simulation.emitters import SimulatedEmitter, world_of
from backend.simulation.hangar import Hangar
from backend.simulation.receiver import EmittersAroundHome
from backend.store.engine import make_engine
from backend.store.journal import SqlJournal
from backend.store.lessons_folder import LessonsFolder
from backend.store.opening import open_journal
from backend.version import VERSION
from hardware.autopilot.opening import check_url
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import ScaledClock
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import borrowed_pattern, load_pattern
from hardware.payload.receiver import PayloadReceiver
from hardware.payload.session import PayloadHub
from hardware.ports import Receiver, ReceiverError, Vehicle
from hardware.readings import Place
from hardware.reasons.payload import PayloadTokensMissing
from hardware.sdr.device import receiver_from
from hardware.sim.turntable import simulated_antenna
from planner.study import value_cache

if TYPE_CHECKING:
    from backend.auth.provider import Provider

log = logging.getLogger("crossfix.bearings")


async def _latest_utc_s(journal: SqlJournal) -> float | None:
    """Time of the last fact of an unfinished mission: a sped-up clock must not run behind it."""
    last = list[Recorded]()
    for mission_id in await journal.unfinished():
        digest = await journal.mission(mission_id)
        last += [] if digest is None else await journal.read(mission_id, after=digest.last_seq - 1)
    return max((recorded.at_utc.timestamp() for recorded in last), default=None)


def _warm_up() -> None:
    """Compile the planner's kernels before anybody waits for them in the air.

    What is loaded by then stays until the end. The garbage collector leaves it out from here on: a look at its 300,000
    objects takes 0.2 s, in which nobody's abort is read.
    """
    home = Place(lat=0.0, lon=0.0)
    spec = in_a_strip(suggested_mission(home), home)
    preview(localization(spec, home), home, threads=2)
    gc.freeze()


@asynccontextmanager
async def _bearings_by_udp(
    settings: Settings, missions: MissionRoom, clock: ScaledClock
) -> AsyncGenerator[BearingFeed | None]:
    """What listens, None without a port. Raises ValueError when the port cannot be had."""
    port = settings.bearings_udp_port
    if port is None:
        yield None
        return

    async def add(report: ReportedBearing) -> None:
        flying = missions.flights.active
        if flying is None:
            raise DatagramRefused(NoSearchFlies())
        await missions.reports.add(flying.mission_id, on_our_clock(report, clock.now(), time.time()))

    feed = BearingFeed(add, time.time, time.monotonic)
    async with open_feed(feed, settings.bearings_udp_host, port) as (host, bound):
        log.warning("bearings are taken by UDP on %s, port %d", host, bound)
        yield feed


def _warming() -> asyncio.Task[None]:
    return asyncio.create_task(asyncio.to_thread(_warm_up))


def compile_beliefs(until: threading.Event) -> None:
    """Every kind of belief that a flight may ask for, unless `until` is set meanwhile: on a new machine that takes a
    minute, and no thread can be interrupted."""
    home = Place(lat=0.0, lon=0.0)
    for _ in fold_first_beliefs(in_a_strip(suggested_mission(home), home), home):
        if until.is_set():
            return
    gc.freeze()


async def _then_beliefs(warming: asyncio.Task[None], until: threading.Event) -> None:
    """What a flight believes is compiled while the server answers already."""
    await asyncio.gather(warming, return_exceptions=True)
    try:
        await asyncio.to_thread(compile_beliefs, until)
    except Exception:
        log.exception("beliefs are not compiled: the first of each kind will be in flight")


def _receiver(
    settings: Settings,
    vehicle: Vehicle,
    clock: ScaledClock,
    payload: PayloadHub | None,
    emitters: Sequence[SimulatedEmitter],
) -> Receiver:
    """Raises ReceiverError for a device of no known form."""
    named = _receiver_name(settings)
    if named == "simulated":
        return EmittersAroundHome(vehicle, clock, settings.seed, settings.world, emitters, settings.simulated_band_hz)
    if named == "payload":
        if payload is None:
            raise ReceiverError(PayloadTokensMissing())
        return PayloadReceiver(payload)
    return receiver_from(named, clock)


def _pattern(settings: Settings) -> AntennaPattern:
    """The one that was set; else the simulated antenna's for the simulated receiver, and a borrowed one for any other.

    Raises PatternError.
    """
    if settings.antenna_pattern is not None:
        return load_pattern(settings.antenna_pattern)
    return simulated_antenna() if _receiver_name(settings) == "simulated" else borrowed_pattern()


def _receiver_name(settings: Settings) -> str:
    return settings.receiver or ("payload" if settings.payload_tokens else "simulated")


@asynccontextmanager
async def open_access(settings: Settings) -> AsyncGenerator[Access]:
    """Who may enter, read from the migrated database. Raises JournalUnavailable."""
    timeout_s = settings.database_timeout_s
    records = Records(make_engine(settings.async_database_url, timeout_s), timeout_s)
    access = Access(
        records,
        AuditLog(settings.data_dir / AUDIT_FILE, time.time),
        people_expected=settings.people_expected,
        payload_tokens=settings.payload_tokens,
        data_dir=settings.data_dir,
    )
    try:
        await access.load()
        yield access
    finally:
        await access.close()


def sign_in_provider(settings: Settings) -> Provider | None:
    """None: people sign in with passwords only. Raises ValueError when its secret cannot be read."""
    if settings.oidc_issuer is None:
        return None
    from backend.auth.provided import Rules
    from backend.auth.provider import Provider  # half a second that only such a server pays

    default, roles = settings.oidc_default_role, settings.oidc_roles
    domains = tuple(domain.lower() for domain in settings.oidc_email_domains)
    rules = Rules(settings.oidc_role_claim, roles, None if default == "none" else default, domains)
    return Provider(
        settings.oidc_issuer, settings.oidc_client_id, settings.oidc_client_secret, rules, name=settings.oidc_name
    )


@asynccontextmanager
async def open_services(settings: Settings) -> AsyncGenerator[Services]:
    """Everything of a running server; taken down in the opposite order.

    Raises ValueError for a vehicle address or a simulated emitter that cannot be read, PatternError, DatabaseUnusable,
    HardwareError.
    """
    async with open_simulation(settings) as (services, _):
        yield services


@asynccontextmanager
async def open_simulation(
    settings: Settings,
    leave_flying: bool = True,
    emitters: Sequence[SimulatedEmitter] | None = None,
    first: FirstHold | None = None,
) -> AsyncGenerator[tuple[Services, EmittersAroundHome | None]]:
    """The same, with the simulated emitters beside it (for whoever grades the answer), None when the receiver is real.

    emitters: what transmits in the simulated world, None: what the settings name. first: the vehicle that was found in
    flight and held already.

    leave_flying: a simulated vehicle in the middle of a mission flies on by itself, as a real one would, and the next
    server on the same data directory finds it.
    """
    pattern, provider = _pattern(settings), sign_in_provider(settings)
    transmitting = world_of(settings.emitters) if emitters is None else emitters
    if settings.vehicle_url is not None:
        check_url(settings.vehicle_url)
    clock = ScaledClock(factor=settings.time_factor) if first is None else first.clock
    warming: asyncio.Task[None] | None = None
    ended = threading.Event()
    async with open_journal(settings, lambda: clock.now()) as journal, open_access(settings) as access:
        unfinished = await journal.unfinished()
        if first is None:
            latest = await _latest_utc_s(journal)
            if latest is not None and latest > clock.now():
                clock = ScaledClock(latest, settings.time_factor)
        hangar = Hangar(settings)
        simulated = None if settings.vehicle_url else await hangar.enter()
        missions: MissionRoom | None = None
        try:
            url = settings.vehicle_url if simulated is None else simulated.url
            found = None
            if first is not None and first.url == url:
                found = (first.vehicle, first.authority)
            elif first is not None:
                await first.vehicle.close()
            vehicle = ReconnectingVehicle(lambda: MavsdkVehicle(url or "", clock), clock, url or "", found)
            hub = Hub(journal.read_texts, clock.now)
            expected = settings.payload_tokens or any(token.scope == "payload" for token in access.machines.tokens)
            payload = PayloadHub(settings.payload_tokens, clock.now) if expected else None
            receiver = _receiver(settings, vehicle, clock, payload, transmitting)
            finder = SparseDirectionFinder(heading_sigma_deg=settings.heading_sigma_deg)
            craft = CraftEquipment(
                craft_id=FIRST_CRAFT,
                vehicle=vehicle,
                receiver=receiver,
                finder=finder,
                pattern=pattern,
                clock=clock,
                publisher=hub,
            )
            missions = mission_room(
                MissionEquipment(
                    crafts={craft.craft_id: craft},
                    journal=journal,
                    publisher=hub,
                    clock=clock,
                    software=VERSION,
                    database=lambda: journal.report().state,
                    grounds=TerrainFolder(settings.data_dir / "terrain", settings.disk_low_bytes),
                    prepare_planner=value_cache.prepare,
                    lessons=LessonsFolder(settings.data_dir / "lessons"),
                )
            )
            if not unfinished:
                warming = _warming()
            await missions.start_up()
            if warming is None:  # a mission in flight needs its hold and its page first
                warming = _warming()
            else:
                await warming
            warming = asyncio.create_task(_then_beliefs(warming, ended))
            async with _bearings_by_udp(settings, missions, clock) as feed:
                services = Services(
                    missions, journal, hub, settings, clock.now, payload,
                    bearings=None if feed is None else feed.health,
                    access=access, provider=provider, finder=finder, pattern=pattern,
                )  # fmt: skip
                await asyncio.to_thread(remove_left_behind)
                try:
                    yield services, receiver if isinstance(receiver, EmittersAroundHome) else None
                finally:
                    await services.close()
        finally:
            in_flight = missions is not None and missions.flights.active is not None
            if missions is not None:
                await missions.shut_down()
            ended.set()
            if warming is not None:
                await asyncio.gather(warming, return_exceptions=True)
            if simulated is not None and not (leave_flying and in_flight):
                await hangar.leave(simulated)
