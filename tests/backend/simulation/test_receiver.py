from __future__ import annotations

from refusals import refusing

from backend.simulation.emitters import SimulatedEmitter, emitter_places
from backend.simulation.receiver import EmittersAroundHome
from hardware.clock import ScaledClock
from hardware.ports import ReceiverError
from hardware.readings import Channel, HeadingSample, Place, Pulses, Telemetry
from hardware.reasons.receiver import ReceiverNotOpen
from hardware.reasons.simulation import HomeNotKnown

CHOSEN = (SimulatedEmitter(433.1e6), SimulatedEmitter(433.2e6, 1.0))
HOME = Place(50.0, 7.0)


class ParkedVehicle:
    """Only its telemetry and its headings are asked."""

    def __init__(self, clock: ScaledClock) -> None:
        self.clock = clock
        self.home: Place | None = None

    def telemetry(self) -> Telemetry:
        now = self.clock.now()
        return Telemetry(
            connected=True,
            at_s=now,
            position=self.home,
            altitude_relative_m=40.0,
            heading_deg=0.0,
            heading_at_s=now,
            home=self.home,
            home_amsl_m=100.0,
        )

    def headings(self, since_s: float) -> list[HeadingSample]:
        now = self.clock.now()
        return [HeadingSample(now, 0.0, self.home)] if now >= since_s else []


async def test_the_emitters_wait_for_the_vehicle_to_know_its_home() -> None:
    clock = ScaledClock(factor=50.0)
    vehicle = ParkedVehicle(clock)
    receiver = EmittersAroundHome(vehicle, clock, seed=3)  # type: ignore[arg-type]
    with refusing(HomeNotKnown(), ReceiverError):
        await receiver.open([Channel(868.3e6)])
    with refusing(ReceiverNotOpen(), ReceiverError):
        receiver.silence(True)
    assert receiver.truth == {}
    vehicle.home = HOME
    await receiver.open([Channel(868.3e6)])
    assert {868.3e6, 150e6} < {signal.frequency_hz for signal in receiver.truth}
    await receiver.close()


async def test_chosen_emitters_are_heard_at_once_and_each_has_its_truth() -> None:
    clock = ScaledClock(factor=50.0)
    vehicle = ParkedVehicle(clock)
    vehicle.home = HOME
    receiver = EmittersAroundHome(vehicle, clock, seed=3, emitters=CHOSEN)  # type: ignore[arg-type]
    await receiver.open([Channel(433.1e6), Channel(433.2e6, Pulses(0.02, 1.0))])
    heard: set[float] = set()
    async for sample in receiver.samples():
        if sample.detected and sample.noise_floor_db is not None and sample.power_db > sample.noise_floor_db + 6.0:
            heard.add(sample.frequency_hz)
        if len(heard) == 2:
            break
    await receiver.close()
    assert receiver.truth == emitter_places(3, HOME, CHOSEN)
