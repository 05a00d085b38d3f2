"""How a craft turns so that each emitter still wanted is heard long enough all around: how fast, and how often.

A receiver whose band does not hold all emitters hears them in groups, a whole turn each. Going round once for two
groups and changing between them at every heading takes no less: a tag has to be listened to for its pulses at each of
SLICES headings either way, and every change costs the receiver's settling besides. Only carriers, whose turns are
bounded by the craft and not by their pulses, could be heard together sooner, by seconds.

A group costs max(360 / rate, SLICES n P SPARE): n pulses of its slowest tag's period P at each heading.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from backend.spec import EmitterSpec, MissionSpec, SensorSpec
from hardware.sdr.pulses import PulseSetting
from hardware.sdr.spectrum import ToneSetting
from hardware.sdr.tuning import Reach, width_hz

SLICES = 16
SPARE = 1.1
"""The turn is this much slower than the pulses need at least, because they do not come in step with the headings."""
SLOWEST_DEG_S = 2.0
MOST_TURNS = 3
"""Of one group, however rarely its pulses come. Bursts every 50 s leave eleven directions so; two turns leave seven,
too few for a bearing, so that fewer pulses a heading make this no shorter."""
CHANGE_S = 1.0
"""From the last of one group to the first sample of the next: opening, tuning and settling."""
FAR_OFF = 2.0
"""The specified turn time is trusted unless the turn needs this many times as long."""


@dataclass(frozen=True, slots=True)
class Round:
    """All the way round for one group. emitters: those that are heard, wanted or not, in the specification's order.
    times: how often it turns, more than once where pulses come too rarely for the slowest turn."""

    emitters: tuple[EmitterSpec, ...]
    rate_deg_s: float
    times: int = 1

    @property
    def seconds(self) -> float:
        """Of the turning alone."""
        return self.times * 360.0 / self.rate_deg_s


@dataclass(frozen=True, slots=True)
class TurnSchedule:
    """What a turn is made of."""

    rounds: tuple[Round, ...]

    @property
    def seconds(self) -> float:
        """Of the turning, and of changing between the groups."""
        return sum(one.seconds for one in self.rounds) + CHANGE_S * (len(self.rounds) - 1)


def turn_schedule(mission: MissionSpec, wanted: Collection[str] | None = None) -> TurnSchedule:
    """wanted: emitters by id, None: all. The others are heard where that costs nothing, and a group of which none is
    wanted is not turned for."""
    sensor = mission.sensor
    groups = heard_at_once(mission.emitters, sensor.receiver_band_hz)
    rounds: list[Round] = []
    for group in groups:
        asked = [emitter for emitter in group if wanted is None or emitter.emitter_id in wanted]
        if asked:
            rounds.append(_round(sensor, group, asked))
    return TurnSchedule(tuple(rounds))


def _round(sensor: SensorSpec, group: tuple[EmitterSpec, ...], wanted: Sequence[EmitterSpec]) -> Round:
    """As fast as specified, but for tags no faster than lets each sixteenth of the circle hear their pulses."""
    slowest_s = max((emitter.pulse_period_s for emitter in wanted if emitter.kind == "pulsed"), default=0.0)
    needed_s = SLICES * sensor.pulses_per_heading * slowest_s * SPARE
    rate = min(sensor.turn_rate_deg_s, 360.0 / needed_s if needed_s else math.inf)
    rate = max(rate, min(SLOWEST_DEG_S, sensor.turn_rate_deg_s))
    times = math.ceil(needed_s * rate / 360.0 - 1e-6)
    return Round(group, rate, min(max(times, 1), MOST_TURNS))


def heard_at_once(emitters: Sequence[EmitterSpec], band_hz: float | None) -> tuple[tuple[EmitterSpec, ...], ...]:
    """The fewest groups that a band holds, by frequency from below: no other groups of neighbours are fewer. band_hz
    None: it holds all. An emitter that needs more than the band is a group of its own, which the receiver refuses."""
    if band_hz is None:
        return (tuple(emitters),)
    groups: list[list[EmitterSpec]] = []
    for emitter in sorted(emitters, key=lambda one: (one.frequency_hz, emitters.index(one))):
        if groups and width_hz([_reach(one) for one in (*groups[-1], emitter)]) <= band_hz:
            groups[-1].append(emitter)
        else:
            groups.append([emitter])
    return tuple(tuple(sorted(group, key=emitters.index)) for group in groups)


def turn_s(mission: MissionSpec, wanted: Collection[str] = ()) -> float:
    """What a turn takes, from the order to the bearings: as specified, or as long as it has to where the receiver hears
    the emitters in groups, or a tag's pulses come so seldom that the specified time is off by far. wanted: those still
    looked for, by id; none: all."""
    stated = mission.sensor.measurement_time_s
    needed = turn_schedule(mission, wanted or None).seconds
    if mission.sensor.receiver_band_hz is None and needed < FAR_OFF * stated:
        return stated
    return max(stated, needed)


def _reach(emitter: EmitterSpec) -> Reach:
    setting = ToneSetting() if emitter.kind == "carrier" else PulseSetting()
    return Reach(emitter.frequency_hz, setting.reach_hz)
