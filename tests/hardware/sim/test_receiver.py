"""A simulated sweep, from the world through the receiver to the direction finder."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from refusals import refusing
from stepped_clock import SteppedClock

from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.direction_finding.rhythm import whose_pulses
from hardware.direction_finding.sweep import assemble_sweep
from hardware.frame import LocalFrame
from hardware.ports import ReceiverError
from hardware.readings import Channel, HeadingSample, Place, PowerSample, Pulses, Sweep, Telemetry
from hardware.reasons.channels import BandTooNarrow
from hardware.reasons.receiver import ReceiverNotOpen, ReceiverUnplugged
from hardware.sim.pose_track import PoseTrack
from hardware.sim.receiver import SimulatedReceiver
from hardware.sim.world import Emitter, World

HOME = Place(50.6, 7.2)
FREQUENCY_HZ = 868_300_000.0
CARRIER = Channel(FREQUENCY_HZ)


class TurningVehicle:
    """Hovers at HOME and turns; telemetry comes in steps of `period_s`."""

    def __init__(self, clock: SteppedClock, rate_deg_s: float = 30.0, period_s: float = 0.05) -> None:
        self.clock, self.rate_deg_s, self.period_s = clock, rate_deg_s, period_s
        self.start_s = clock.now()

    def telemetry(self) -> Telemetry:
        stamp = self.clock.now() - (self.clock.now() - self.start_s) % self.period_s
        heading = (stamp - self.start_s) * self.rate_deg_s % 360.0
        return Telemetry(True, stamp, HOME, stamp, 100.0, 40.0, heading, stamp)

    def headings(self, until_s: float) -> list[HeadingSample]:
        count = int((until_s - self.start_s) / self.period_s) + 1
        times = [self.start_s + k * self.period_s for k in range(count)]
        return [HeadingSample(t, (t - self.start_s) * self.rate_deg_s % 360.0, HOME) for t in times]


def world_with_emitter_at(bearing_deg: float, distance_m: float, **changes: object) -> World:
    import math

    east = distance_m * math.sin(math.radians(bearing_deg))
    north = distance_m * math.cos(math.radians(bearing_deg))
    emitter = Emitter(LocalFrame(HOME).to_geo(east, north), FREQUENCY_HZ)
    return dataclasses.replace(World((emitter,)), **changes)


async def listen(receiver: SimulatedReceiver, seconds: float, channel: Channel = CARRIER) -> list[PowerSample]:
    await receiver.open([channel])
    heard: list[PowerSample] = []
    async for sample in receiver.samples():
        heard.append(sample)
        if sample.at_s >= heard[0].at_s + seconds:
            break
    return heard


async def turn_once(world: World, rate_deg_s: float = 30.0, period_s: float = 0.05) -> Sweep:
    clock = SteppedClock(1_000_000.0)
    vehicle = TurningVehicle(clock, rate_deg_s, period_s)
    receiver = SimulatedReceiver(world, vehicle.telemetry, clock)
    heard = await listen(receiver, 360.0 / rate_deg_s)
    headings = vehicle.headings(clock.now())
    return assemble_sweep(heard, headings, frequency_hz=FREQUENCY_HZ, altitude_amsl_m=100.0)


@pytest.mark.parametrize("bearing_deg", [3.0, 77.0, 181.0, 359.0])
@pytest.mark.parametrize("period_s", [0.05, 0.25])
async def test_sweep_points_at_the_emitter_whatever_the_telemetry_rate(bearing_deg: float, period_s: float) -> None:
    sweep = await turn_once(world_with_emitter_at(bearing_deg, 200.0), period_s=period_s)
    reading = SparseDirectionFinder().estimate(sweep, load_pattern(SMALL_YAGI))
    assert reading.accepted, reading.reason
    assert abs((reading.bearing_deg - bearing_deg + 180.0) % 360.0 - 180.0) < 12.0


async def test_heading_error_of_the_world_shifts_the_bearing() -> None:
    sweep = await turn_once(world_with_emitter_at(100.0, 200.0, heading_error_deg=25.0))
    reading = SparseDirectionFinder().estimate(sweep, load_pattern(SMALL_YAGI))
    assert abs(reading.bearing_deg - 75.0) < 12.0


async def test_same_seed_same_samples_other_seed_other_samples() -> None:
    world = world_with_emitter_at(10.0, 150.0)
    first, again = await turn_once(world), await turn_once(world)
    other = await turn_once(dataclasses.replace(world, seed=2))
    assert first.power_db.tolist() == again.power_db.tolist()
    assert first.power_db.tolist() != other.power_db.tolist()


async def test_samples_come_at_the_stated_rate_and_in_order() -> None:
    clock = SteppedClock(1_000_000.0)
    receiver = SimulatedReceiver(world_with_emitter_at(0.0, 100.0), TurningVehicle(clock).telemetry, clock, 20.0)
    times = [sample.at_s for sample in await listen(receiver, 5.0)]
    assert len(times) == pytest.approx(100, abs=2)
    assert times == sorted(times)


async def test_unplugged_receiver_raises_and_unopened_receiver_says_so() -> None:
    clock = SteppedClock(1_000_000.0)
    receiver = SimulatedReceiver(world_with_emitter_at(0.0, 100.0), TurningVehicle(clock).telemetry, clock)
    with refusing(ReceiverNotOpen(), ReceiverError):
        await anext(receiver.samples())
    await receiver.open([CARRIER])
    stream = receiver.samples()
    await anext(stream)
    receiver.unplug()
    with refusing(ReceiverUnplugged(), ReceiverError):
        async for _ in stream:
            pass


async def test_without_an_emitter_in_band_only_noise_is_heard() -> None:
    world = world_with_emitter_at(0.0, 100.0)
    clock = SteppedClock(1_000_000.0)
    receiver = SimulatedReceiver(world, TurningVehicle(clock).telemetry, clock)
    await receiver.open([Channel(FREQUENCY_HZ + 1e6)])
    stream = receiver.samples()
    heard = [await anext(stream) for _ in range(50)]
    assert all(abs(s.power_db - world.front_end.noise_dbm) < 3.0 for s in heard)


async def test_a_tag_is_heard_once_a_pulse_and_only_in_its_own_rhythm() -> None:
    world = world_with_emitter_at(60.0, 150.0)
    tag = dataclasses.replace(world.emitters[0], pulse_period_s=1.3)
    clock = SteppedClock(1_000_000.0)
    receiver = SimulatedReceiver(dataclasses.replace(world, emitters=(tag,)), TurningVehicle(clock).telemetry, clock)
    heard = await listen(receiver, 26.0, Channel(FREQUENCY_HZ, Pulses(0.02, 1.3, 0.03)))
    assert all(sample.detected for sample in heard)
    assert np.diff([sample.at_s for sample in heard]) == pytest.approx(1.3, abs=1e-6)
    other = await listen(receiver, 10.0, Channel(FREQUENCY_HZ, Pulses(0.02, 1.7, 0.03)))
    assert not any(sample.detected for sample in other)
    assert len(await listen(receiver, 5.0)) > 90


async def test_what_is_heard_at_a_frequency_does_not_depend_on_what_is_heard_beside_it() -> None:
    world = world_with_emitter_at(60.0, 150.0)
    tag = dataclasses.replace(world.emitters[0], frequency_hz=150e6, pulse_period_s=1.3)
    world = dataclasses.replace(world, emitters=(*world.emitters, tag))

    async def heard(*channels: Channel) -> list[float]:
        clock = SteppedClock(1_000_000.0)
        receiver = SimulatedReceiver(world, TurningVehicle(clock).telemetry, clock)
        await receiver.open(channels)
        powers: list[float] = []
        async for sample in receiver.samples():
            if sample.frequency_hz == FREQUENCY_HZ:
                powers.append(sample.power_db)
            if len(powers) == 100:
                break
        return powers

    assert await heard(CARRIER) == await heard(Channel(150e6, Pulses(0.02, 1.3)), CARRIER)


class LateVehicle(TurningVehicle):
    """What it says is heard `late_s` later; it keeps the headings that were heard, as a link does."""

    def __init__(self, clock: SteppedClock, late_s: float, burst_s: float = 0.05) -> None:
        super().__init__(clock, period_s=burst_s)
        self.start_s -= 10.0
        self.late_s = late_s

    def telemetry(self) -> Telemetry:
        stamp = self.clock.now() - self.late_s
        stamp -= (stamp - self.start_s) % self.period_s
        heading = (stamp - self.start_s) * self.rate_deg_s % 360.0
        return Telemetry(True, stamp, HOME, stamp, 100.0, 40.0, heading, stamp)

    def kept(self, since_s: float) -> list[HeadingSample]:
        newest_s = self.telemetry().at_s
        count = int((newest_s - self.start_s) / 0.05 + 1e-6) + 1
        times = [self.start_s + k * 0.05 for k in range(count)]
        return [HeadingSample(t, (t - self.start_s) * 30.0 % 360.0, HOME) for t in times if t >= since_s]


@pytest.mark.parametrize(("late_s", "burst_s"), [(0.0, 0.05), (3.0, 0.05), (0.5, 4.0), (3.0, 8.0)])
async def test_telemetry_late_or_in_bursts_never_turns_the_bearing(late_s: float, burst_s: float) -> None:
    """On a starved machine a fast simulation's telemetry is seconds of its time late, and comes in bursts."""
    clock = SteppedClock(1_000_000.0)
    vehicle = LateVehicle(clock, late_s, burst_s)
    receiver = SimulatedReceiver(
        world_with_emitter_at(77.0, 200.0), vehicle.telemetry, clock, headings=vehicle.kept, telemetry_held_s=0.5
    )
    heard = [sample for sample in await listen(receiver, 14.0) if sample.detected]
    headings = TurningVehicle.headings(vehicle, clock.now())
    if burst_s > 0.05:
        headings = vehicle.kept(0.0)
    sweep = assemble_sweep(heard, headings, frequency_hz=FREQUENCY_HZ, altitude_amsl_m=100.0)
    reading = SparseDirectionFinder().estimate(sweep, load_pattern(SMALL_YAGI))
    assert reading.accepted, reading.reason
    assert abs((reading.bearing_deg - 77.0 + 180.0) % 360.0 - 180.0) < 12.0


def test_where_the_nose_may_have_gone_either_way_round_its_direction_is_not_known() -> None:
    def report(at_s: float, heading_deg: float) -> Telemetry:
        return Telemetry(True, at_s, HOME, at_s, 100.0, 40.0, heading_deg, at_s)

    track = PoseTrack()
    for at_s, heading_deg in ((0.0, 0.0), (1.0, 30.0), (2.0, 200.0), (3.0, 230.0), (9.0, 240.0)):
        assert track.hear(report(at_s, heading_deg))
    known = {at_s: track.at(at_s) for at_s in (-0.1, 0.5, 1.0, 1.5, 2.5, 5.0, 9.0, 9.1)}
    found = {at_s: pose.heading_deg for at_s, pose in known.items() if pose is not None}
    assert found == pytest.approx({0.5: 15.0, 1.0: 30.0, 2.5: 215.0, 9.0: 240.0})


async def test_a_receiver_without_telemetry_lives_and_delivers_nothing_that_counts() -> None:
    clock = SteppedClock(1_000_000.0)
    vehicle = LateVehicle(clock, late_s=0.0)
    stuck = vehicle.telemetry()
    receiver = SimulatedReceiver(
        world_with_emitter_at(77.0, 200.0),
        lambda: stuck if clock.now() > 1_000_001.0 else vehicle.telemetry(),
        clock,
        telemetry_held_s=0.5,
    )
    await receiver.open([CARRIER])
    late: list[PowerSample] = []
    async for sample in receiver.samples():
        if clock.now() > 1_000_002.0:
            late.append(sample)
        if clock.now() > 1_000_005.0:
            break
    assert len(late) > 10
    assert not any(sample.detected for sample in late)
    assert {sample.at_s for sample in late} == {late[0].at_s}


PERIODS_S = (1.3, 1.05)
SHARED = Channel(FREQUENCY_HZ, Pulses(0.02, PERIODS_S[0]), (Pulses(0.02, PERIODS_S[1]),))


def world_with_two_tags(phases_s: tuple[float, float] = (0.4, 0.9)) -> World:
    world = world_with_emitter_at(60.0, 150.0)
    first, second = world.emitters[0], world_with_emitter_at(200.0, 180.0).emitters[0]
    tags = (
        dataclasses.replace(first, pulse_period_s=PERIODS_S[0], pulse_phase_s=phases_s[0]),
        dataclasses.replace(second, pulse_period_s=PERIODS_S[1], pulse_phase_s=phases_s[1], clock_error=0.004),
    )
    return dataclasses.replace(world, emitters=tags)


async def test_two_tags_at_one_frequency_are_heard_each_at_its_own_times_and_told_apart() -> None:
    clock = SteppedClock(1_000_000.0)
    world = world_with_two_tags()
    receiver = SimulatedReceiver(world, TurningVehicle(clock).telemetry, clock)
    heard = [sample for sample in await listen(receiver, 60.0, SHARED) if sample.detected]
    at_s = [sample.at_s for sample in heard]
    assert at_s == sorted(at_s)
    whose = whose_pulses(at_s, SHARED.rhythms)
    for number, tag in enumerate(world.emitters):
        assert tag.beat is not None
        own = [moment for moment, by in zip(at_s, whose, strict=True) if by == number]
        assert len(own) > 0.75 * 60.0 / PERIODS_S[number]
        assert tag.beat.sends(np.array(own)).all()


async def test_pulses_that_fall_together_are_heard_as_one() -> None:
    clock = SteppedClock(1_000_000.0)
    world = world_with_two_tags()
    begin = world.emitters[0].beat
    assert begin is not None
    together = dataclasses.replace(world.emitters[0], pulse_phase_s=begin.phase_s + 0.008)
    receiver = SimulatedReceiver(
        dataclasses.replace(world, emitters=(world.emitters[0], together)), TurningVehicle(clock).telemetry, clock
    )
    heard = await listen(receiver, 26.0, SHARED)
    assert np.diff([sample.at_s for sample in heard]).min() > 1.0


async def test_a_single_tag_is_heard_as_before_beside_another_at_its_frequency() -> None:
    clock = SteppedClock(1_000_000.0)
    receiver = SimulatedReceiver(world_with_two_tags(), TurningVehicle(clock).telemetry, clock)
    for pulses, gap_s in zip(SHARED.rhythms, (PERIODS_S[0], PERIODS_S[1] * 1.004), strict=True):
        heard = await listen(receiver, 20.0, Channel(FREQUENCY_HZ, pulses))
        assert np.diff([sample.at_s for sample in heard]) == pytest.approx(gap_s, abs=1e-3)


async def test_a_narrow_receiver_refuses_what_its_band_does_not_hold_and_locks_late() -> None:
    clock = SteppedClock(1_000_000.0)
    world = world_with_emitter_at(60.0, 150.0)
    receiver = SimulatedReceiver(world, TurningVehicle(clock).telemetry, clock, band_hz=25e3)
    with refusing(BandTooNarrow(25e3, 54e3, (FREQUENCY_HZ + 50e3,)), ReceiverError):
        await receiver.open([CARRIER, Channel(FREQUENCY_HZ + 50e3)])
    began_s = clock.now()
    heard = await listen(receiver, 5.0)
    wide = await listen(SimulatedReceiver(world, TurningVehicle(clock).telemetry, clock), 5.0)
    early = [sample.power_db for sample in heard if sample.at_s < began_s + 0.2]
    assert early
    assert min(early) > max(sample.power_db for sample in wide) or len(set(early)) == 1
    assert len(heard) > 90


def test_a_flight_across_the_antimeridian_is_heard_there() -> None:
    """Between a report east of it and one west of it the vehicle was half the world away."""
    track = PoseTrack()
    for at_s, lon in ((0.0, 179.9999), (1.0, -179.9999)):
        track.hear(Telemetry(True, at_s, Place(0.0, lon), at_s, 100.0, 40.0, 10.0, at_s))
    between = track.at(0.5)
    assert between is not None
    assert between.place.lon % 360.0 == pytest.approx(180.0)
