"""Pulses at one frequency go to the tag that sent them, or to nobody. The trains here are not the sorter's own model:
each tag's clock is off by one factor for good and each pulse strays by itself, evenly."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.direction_finding.rhythm import RhythmSorter, whose_pulses
from hardware.readings import Pulses

WIDTH_S, JITTER_S = 0.02, 0.03
Sent = int | str
"""The tag's number, "both" of two that were heard as one, or "stranger"."""


def tags(*periods_s: float) -> list[Pulses]:
    return [Pulses(WIDTH_S, period_s, JITTER_S) for period_s in periods_s]


@dataclass(frozen=True)
class Scene:
    """seconds: of listening. heard: share of the pulses that are, where the antenna looks at the tag, which turns once
    in 46 s and hears less behind. clock: by which share the tags' clocks are off at most. stray_s: of each pulse, at
    most."""

    seconds: float = 120.0
    heard: float = 0.95
    clock: float = 0.01
    stray_s: float = 0.01
    strangers_hz: float = 0.05

    def drawn(self, seed: int, periods_s: Sequence[float]) -> tuple[list[float], list[Sent]]:
        rng = np.random.default_rng(seed)
        events: list[tuple[float, Sent]] = []
        for number, period_s in enumerate(periods_s):
            period = period_s * (1.0 + rng.uniform(-self.clock, self.clock))
            begins = np.arange(rng.uniform(0.0, period), self.seconds, period)
            front = rng.uniform(0.0, 2.0 * np.pi)
            share = self.heard * (0.5 + 0.5 * np.cos(2.0 * np.pi * begins / 46.0 - front)) ** 0.3
            begins = begins[rng.random(begins.size) < share]
            events += [(float(t + rng.uniform(-self.stray_s, self.stray_s)), number) for t in begins]
        count = rng.poisson(self.strangers_hz * self.seconds)
        events += [(float(t), "stranger") for t in rng.uniform(0.0, self.seconds, count)]
        events.sort(key=lambda event: event[0])
        merged: list[tuple[float, Sent]] = []
        for at_s, sent in events:
            if merged and at_s - merged[-1][0] < WIDTH_S:
                merged[-1] = (float(merged[-1][0] + rng.uniform(0.0, 1.0) * (at_s - merged[-1][0])), "both")
            else:
                merged.append((at_s, sent))
        return [at_s for at_s, _ in merged], [sent for _, sent in merged]


@dataclass(frozen=True)
class Tally:
    """Of the tags' own pulses. to_no_tag: strangers and overlapping ones that were given to a tag."""

    own: int
    right: int
    wrong: int
    strangers: int
    strangers_given: int


def tally(scene: Scene, periods_s: Sequence[float], seeds: int = 3) -> Tally:
    found: Counter[str] = Counter()
    for seed in range(seeds):
        at_s, sent = scene.drawn(seed, periods_s)
        for by, whose in zip(sent, whose_pulses(at_s, tags(*periods_s)), strict=True):
            if isinstance(by, int):
                found["own"] += 1
                found["right" if whose == by else "wrong" if isinstance(whose, int) else "left"] += 1
            elif by == "stranger":
                found["strangers"] += 1
                found["strangers_given"] += isinstance(whose, int)
    return Tally(*(found[name] for name in ("own", "right", "wrong", "strangers", "strangers_given")))


@pytest.mark.parametrize(
    ("scene", "periods_s", "least"),
    [
        (Scene(), (1.3, 1.05), 0.9),
        (Scene(strangers_hz=0.3), (1.3, 1.05), 0.9),
        (Scene(heard=0.6), (1.3, 1.05), 0.75),
        (Scene(clock=0.02, stray_s=0.005), (1.3, 1.24), 0.9),
        (Scene(), (1.0, 2.0), 0.85),
        (Scene(), (1.3, 1.05, 1.6), 0.85),
        (Scene(), (1.3, 1.05, 1.6, 0.85), 0.75),
    ],
    ids=["two", "strangers", "missed", "as alike as allowed", "twice the period", "three", "four"],
)
def test_pulses_go_to_their_own_tags(scene: Scene, periods_s: tuple[float, ...], least: float) -> None:
    found = tally(scene, periods_s)
    assert found.own > 200
    assert found.right >= least * found.own
    assert found.wrong <= 0.005 * found.own
    assert found.strangers_given <= 0.1 * found.strangers


@settings(max_examples=8, deadline=None)
@given(
    st.integers(0, 2**20),
    st.floats(0.8, 2.0),
    st.floats(0.06, 1.0),
    st.floats(0.5, 1.0),
    st.floats(0.0, 0.2),
)
def test_hardly_a_pulse_goes_to_another_tag_whatever_the_rhythms(
    seed: int, period_s: float, apart_s: float, heard: float, strangers_hz: float
) -> None:
    periods_s = (period_s, period_s + apart_s)
    at_s, sent = Scene(heard=heard, strangers_hz=strangers_hz).drawn(seed, periods_s)
    found = whose_pulses(at_s, tags(*periods_s))
    wrong = sum(
        isinstance(by, int) and isinstance(whose, int) and by != whose for by, whose in zip(sent, found, strict=True)
    )
    assert len(found) == len(at_s)
    assert wrong <= 0.05 * len(at_s)


@settings(max_examples=20, deadline=None)
@given(st.lists(st.floats(0.0, 1e5), max_size=60), st.floats(-1e9, 1e9))
def test_any_times_get_a_verdict_each_and_it_is_the_same_at_any_other_time_of_day(
    moments: list[float], shift_s: float
) -> None:
    at_s = sorted(moments)
    found = whose_pulses(at_s, tags(1.3, 1.05))
    assert len(found) == len(at_s)
    assert set(found) <= {0, 1, "overlapping", "unclear", "stranger"}
    assert len(whose_pulses([shift_s + t for t in at_s], tags(1.3, 1.05))) == len(at_s)


def test_a_tag_that_is_off_gets_nothing() -> None:
    at_s, sent = Scene(strangers_hz=0.0).drawn(1, [1.3])
    assert set(whose_pulses(at_s, tags(1.3, 1.05))) == {0}
    assert set(whose_pulses(at_s, tags(1.05, 1.3))) == {1}
    assert set(sent) == {0}


@pytest.mark.parametrize("period_s", [1.7, 2.6, 0.8])
def test_a_strangers_rhythm_is_no_tags(period_s: float) -> None:
    at_s, _ = Scene(strangers_hz=0.0).drawn(2, [period_s])
    given_to = [whose for whose in whose_pulses(at_s, tags(1.3, 1.05)) if isinstance(whose, int)]
    assert len(given_to) <= 0.02 * len(at_s)


def test_few_pulses_are_nobodys_yet() -> None:
    assert whose_pulses([0.0, 1.3, 2.6], tags(1.3, 1.05)) == ["unclear"] * 3
    assert whose_pulses([], tags(1.3, 1.05)) == []


def test_two_tags_that_keep_falling_together_are_given_to_neither() -> None:
    at_s = [2.1 * k for k in range(60)]  # every pulse of a tag of 2.1 s, and every second of one of 1.05 s, at once
    between = [2.1 * k + 1.05 for k in range(60)]
    found = dict(zip(sorted(at_s + between), whose_pulses(sorted(at_s + between), tags(2.1, 1.05)), strict=True))
    assert {found[t] for t in between} <= {1, "unclear"}
    assert all(found[t] != 0 for t in at_s)


def test_a_clock_that_was_set_begins_anew() -> None:
    sorter = RhythmSorter(tags(1.3, 1.05))
    for moment in (*np.arange(0.0, 20.0, 1.3), *np.arange(-100.0, -80.0, 1.05)):
        sorter.take(float(moment))
    assert set(sorter.whose()) == {1}
    assert sorter.at_s[0] == -100.0


def test_what_is_older_than_is_kept_is_forgotten_and_the_rhythm_is_not() -> None:
    sorter = RhythmSorter(tags(1.3, 1.05), kept_s=30.0)
    at_s, sent = Scene(seconds=300.0, strangers_hz=0.0, heard=1.0).drawn(3, [1.3, 1.05])
    for moment in at_s:
        sorter.take(moment)
    assert sorter.at_s[-1] - sorter.at_s[0] <= 60.0
    own = sent[-len(sorter.at_s) :]
    right = sum(by == whose for by, whose in zip(own, sorter.whose(), strict=True))
    assert right >= 0.8 * len(own)
    assert not any(
        isinstance(w, int) and isinstance(b, int) and b != w for b, w in zip(own, sorter.whose(), strict=True)
    )
