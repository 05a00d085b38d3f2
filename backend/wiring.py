"""The only place that names concrete adapters: settings in, the parts of a running server out."""

from __future__ import annotations

import asyncio
import json
import logging
import math
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from backend.api.services import Services
from backend.api.suggestion import HEIGHT_M, WIDTH_M, suggested_mission
from backend.live.hub import Hub
from backend.mission.equipment import Equipment
from backend.mission.forecast import preview
from backend.mission.localization import localization
from backend.mission.patient_vehicle import PatientVehicle
from backend.mission.service import MissionService
from backend.settings import Settings
from backend.spec import EmitterSpec, Place
from backend.store.journal import SqlJournal
from backend.store.opening import open_journal
from backend.version import VERSION
from hardware.autopilot.link import check_url
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import ScaledClock
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.frame import LocalFrame
from hardware.payload.receiver import PayloadReceiver
from hardware.payload.session import PayloadHub
from hardware.ports import Receiver, ReceiverError, Vehicle
from hardware.readings import GeoPoint, PowerSample, Pulses
from hardware.sdr.device import receiver_from
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, find_simulated, launch_simulated
from hardware.sim.receiver import SimulatedReceiver
from hardware.sim.world import Emitter, Reflector, World

log = logging.getLogger("crossfix")

HOME_AMSL_M = 120.0
TELEMETRY_HELD_WALL_S = 0.25
"""The simulated receiver waits so long for the pose of its samples, however fast the simulation runs."""
EDGE_M = 10.0
"""The simulated emitter stays so far inside the suggested area."""
WALLS = 3
WALL_LOSS_DB = (2.0, 7.0)
AROUND_M = 60.0
"""Of the multipath world, see `walls`."""


@dataclass(frozen=True, slots=True)
class SimulatedEmitter:
    """pulse_period_s None: a carrier."""

    frequency_hz: float
    pulse_period_s: float | None = None


EMITTERS = (
    SimulatedEmitter(EmitterSpec().frequency_hz),
    SimulatedEmitter(150_000_000.0, EmitterSpec().pulse_period_s),
    SimulatedEmitter(121_500_000.0),
    SimulatedEmitter(1_575_420_000.0),
)
"""What transmits in the simulated world, each from a place of its own: the suggested mission's emitter, and those of
the page's presets (wildlife tag, rescue beacon, interference). A mission hears the one at its frequency."""


def emitter_place(seed: int, home: GeoPoint, frequency_hz: float = EMITTERS[0].frequency_hz) -> GeoPoint:
    """Where a simulated emitter stands: anywhere in the area that is suggested around `home`, by seed and frequency."""
    rng = np.random.default_rng([seed, int(frequency_hz / 1e6)])
    east = rng.uniform(-WIDTH_M / 2 + EDGE_M, WIDTH_M / 2 - EDGE_M)
    north = rng.uniform(EDGE_M, HEIGHT_M - EDGE_M)
    return LocalFrame(home).to_geo(float(east), float(north))


def walls(seed: int, home: GeoPoint) -> tuple[Reflector, ...]:
    """What reflects in the multipath world: anywhere in the suggested area and a little around it, by the seed.

    With these 6 % of the bearings are more than 30 degrees off and the others have an RMS of 7 degrees; of a fielded
    system's beyond 50 m it was 9 of 93, and 7.5 degrees (spec 8).
    """
    rng = np.random.default_rng([seed, 1])
    frame = LocalFrame(home)
    return tuple(
        Reflector(
            frame.to_geo(
                float(rng.uniform(-WIDTH_M / 2 - AROUND_M, WIDTH_M / 2 + AROUND_M)),
                float(rng.uniform(-AROUND_M, HEIGHT_M + AROUND_M)),
            ),
            loss_db=float(rng.uniform(*WALL_LOSS_DB)),
            phase_rad=float(rng.uniform(0.0, 2.0 * math.pi)),
        )
        for _ in range(WALLS)
    )


class EmitterAroundHome:
    """The Receiver port: a simulated world made around the vehicle's home once that is known.

    truth: where the simulated emitter that is listened to stands, None until then or when there is none.
    """

    def __init__(self, vehicle: Vehicle, clock: ScaledClock, seed: int, world: str = "open") -> None:
        self._vehicle = vehicle
        self._clock = clock
        self._seed = seed
        self._world = world
        self._receiver: SimulatedReceiver | None = None
        self._pulses: Pulses | None = None
        self._places: dict[float, GeoPoint] = {}
        self.truth: GeoPoint | None = None

    def expect(self, pulses: Pulses | None) -> None:
        """See HearsPulses."""
        self._pulses = pulses

    async def open(self, frequency_hz: float) -> None:
        if self._receiver is None:
            telemetry = self._vehicle.telemetry()
            home = telemetry.home or telemetry.position
            if home is None:
                raise ReceiverError("the simulated emitter stands around the vehicle's home, which is not known yet")
            self._places = {e.frequency_hz: emitter_place(self._seed, home, e.frequency_hz) for e in EMITTERS}
            emitters = tuple(
                Emitter(self._places[e.frequency_hz], e.frequency_hz, pulse_period_s=e.pulse_period_s) for e in EMITTERS
            )
            reflectors = walls(self._seed, home) if self._world == "multipath" else ()
            world = World(emitters, reflectors=reflectors, seed=self._seed)
            ground = telemetry.home_amsl_m or 0.0
            held_s = max(0.5, TELEMETRY_HELD_WALL_S * self._clock.factor)
            self._receiver = SimulatedReceiver(
                world, self._vehicle.telemetry, self._clock, ground_amsl_m=ground, telemetry_held_s=held_s
            )
        self._receiver.expect(self._pulses)
        self.truth = self._places.get(frequency_hz)
        await self._receiver.open(frequency_hz)

    async def close(self) -> None:
        if self._receiver is not None:
            await self._receiver.close()

    def silence(self, silent: bool) -> None:
        """Stop or resume delivering samples, as a hung driver would. Raises ReceiverError before the first opening."""
        if self._receiver is None:
            raise ReceiverError("the receiver is not open")
        self._receiver.silence(silent)

    async def samples(self) -> AsyncIterator[PowerSample]:
        if self._receiver is None:
            raise ReceiverError("the receiver is not open")
        async for sample in self._receiver.samples():
            yield sample


@dataclass(frozen=True, slots=True)
class Hangar:
    """Remembers the simulated vehicle in a file, so that it flies on when the server is killed and is found again."""

    settings: Settings

    @property
    def _register(self) -> Path:
        return self.settings.data_dir / "simulated_vehicle.json"

    def _key(self) -> dict[str, object]:
        s = self.settings
        return {
            "flavour": s.simulate,
            "time_factor": s.time_factor,
            "seed": s.seed,
            "home": [s.home_lat_deg, s.home_lon_deg],
        }

    async def enter(self, in_flight: bool) -> SimulatedAutopilot:
        """The vehicle that an unfinished mission left in the air, else a new one."""
        left = await self._left_behind()
        if left is not None:
            found, same = left
            if in_flight and same:
                log.warning("the simulated vehicle is still flying, it is taken over")
                return found
            await found.stop()
        s = self.settings
        started = await launch_simulated(
            Setting(
                flavour=s.simulate,
                home=HomeFrame(s.home_lat_deg, s.home_lon_deg, HOME_AMSL_M),
                speedup=s.time_factor,
                seed=s.seed,
                wind=(3.0, 240.0, 1.0),
                keep_running=s.simulated_flies_on,
            )
        )
        ports = {"connect_port": started.connect_port, "control_port": started.control_port}
        self._register.parent.mkdir(parents=True, exist_ok=True)
        self._register.write_text(json.dumps(self._key() | ports))
        return started

    async def _left_behind(self) -> tuple[SimulatedAutopilot, bool] | None:
        try:
            kept = json.loads(self._register.read_text())
            found = await find_simulated(int(kept["connect_port"]), int(kept["control_port"]))
        except (OSError, ValueError, KeyError, TypeError):
            return None
        same = all(kept.get(name) == value for name, value in self._key().items())
        return None if found is None else (found, same)

    async def leave(self, vehicle: SimulatedAutopilot) -> None:
        await vehicle.stop()
        with suppress(OSError):
            self._register.unlink()


async def _latest_utc_s(journal: SqlJournal) -> float | None:
    """Time of the last fact of an unfinished mission: a sped-up clock must not run behind it."""
    journals = [await journal.read(mission_id) for mission_id in await journal.unfinished()]
    return max((recorded[-1].at_utc.timestamp() for recorded in journals if recorded), default=None)


def _warm_up() -> None:
    """Compile the planner's kernels before anybody waits for them in the air."""
    home = Place(lat=0.0, lon=0.0)
    spec = suggested_mission(home)
    preview(localization(spec, home, 0.0), home, threads=2)


def _receiver(settings: Settings, vehicle: Vehicle, clock: ScaledClock, payload: PayloadHub | None) -> Receiver:
    """Raises ReceiverError for a device of no known form."""
    named = settings.receiver or ("simulated" if payload is None else "payload")
    if named == "simulated":
        return EmitterAroundHome(vehicle, clock, settings.seed, settings.world)
    if named == "payload":
        if payload is None:
            raise ReceiverError("a payload's receiver needs CROSSFIX_PAYLOAD_TOKENS, so that a payload may connect")
        return PayloadReceiver(payload)
    return receiver_from(named, clock)


@asynccontextmanager
async def open_services(settings: Settings) -> AsyncIterator[Services]:
    """Everything of a running server; taken down in the opposite order.

    Raises ValueError for a vehicle address or an antenna pattern that cannot be read, DatabaseUnusable, HardwareError.
    """
    async with open_simulation(settings) as (services, _):
        yield services


@asynccontextmanager
async def open_simulation(
    settings: Settings, leave_flying: bool = True
) -> AsyncIterator[tuple[Services, EmitterAroundHome | None]]:
    """The same, with the simulated emitter beside it (for whoever grades the answer), None when the receiver is real.

    leave_flying: a simulated vehicle in the middle of a mission flies on by itself, as a real one would, and the next
    server on the same data directory finds it.
    """
    pattern = load_pattern(settings.antenna_pattern or SMALL_YAGI)
    if settings.vehicle_url is not None:
        check_url(settings.vehicle_url)
    clock = ScaledClock(factor=settings.time_factor)
    warming = asyncio.create_task(asyncio.to_thread(_warm_up))
    async with open_journal(settings, lambda: clock.now()) as journal:
        unfinished = await journal.unfinished()
        latest = await _latest_utc_s(journal)
        if latest is not None and latest > clock.now():
            clock = ScaledClock(latest, settings.time_factor)
        hangar = Hangar(settings)
        simulated = None if settings.vehicle_url else await hangar.enter(bool(unfinished))
        missions = None
        try:
            url = settings.vehicle_url if simulated is None else simulated.url
            vehicle = PatientVehicle(lambda: MavsdkVehicle(url or "", clock), clock, url or "")
            hub = Hub(journal.read, clock.now)
            payload = PayloadHub(settings.payload_tokens, clock.now) if settings.payload_tokens else None
            receiver = _receiver(settings, vehicle, clock, payload)
            finder = SparseDirectionFinder(heading_sigma_deg=settings.heading_sigma_deg)
            missions = MissionService(
                Equipment(
                    vehicle=vehicle,
                    receiver=receiver,
                    finder=finder,
                    pattern=pattern,
                    journal=journal,
                    publisher=hub,
                    clock=clock,
                    software=VERSION,
                    database=lambda: journal.report().state,
                )
            )
            await missions.start_up()
            if not unfinished:  # a mission in flight needs its page at once
                await warming
            services = Services(missions, journal, hub, settings, clock.now, payload, finder=finder, pattern=pattern)
            yield services, receiver if isinstance(receiver, EmitterAroundHome) else None
        finally:
            await asyncio.gather(warming, return_exceptions=True)
            in_flight = missions is not None and missions.active_mission_id is not None
            if missions is not None:
                await missions.shut_down()
            if simulated is not None and not (leave_flying and in_flight):
                await hangar.leave(simulated)
