"""Whose pulse was that? Pulses heard at one frequency, told apart by the rhythms of the tags that send there.

A tag's pulses come a period p after one another, each interval straying by e ~ N(0, (jitter / 3)^2); p is the nominal
period give or take the jitter (a clock that is off) and drifts. A pulse is heard give or take a quarter of its width.
What is not a tag's is a stranger's: as likely at any time as at any other. How loud a pulse is says nothing here, so
that no bearing is bent by the choice.

First a beam search over who sent what (a multiple hypothesis tracker: Reid 1979; a Kalman filter of phase and period a
tag), forward in time, which finds the rhythms through missed pulses, strangers and other tags. Then each pulse is
judged by what the tags' other pulses on both sides of it say: it is a tag's only if it is `SURE` times likelier that
tag's than anybody else's, and no other tag was due at the same moment. The idea of following candidates through skipped
bursts with growing slack is find_tags' (Brzustowski); that a pulse counts as soon as it fits a candidate is not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hardware.readings import Pulses

Floats = NDArray[np.float64]

HEARD = 0.6
"""How probable it is that a pulse that was sent is heard, while nothing is known of where the antenna points."""
STRANGERS = 0.1
"""Pulses of nobody who is looked for, one of the tags' own."""
COUNTED_MISSES = 4
"""More pulses in a row that were not heard say no more: the antenna looks elsewhere."""
BEGINS_AGAIN = 1e-3
"""How probable it is that a tag whose rhythm is known goes on in another phase."""
DRIFT = 2e-4
"""Of a period, by which it may change from one pulse to the next."""
LOST = 1.0 / 6.0
"""Of a period: a phase less certain than this (standard deviation) is no longer known."""
BEAM = 64
LEAST_PULSES = 4
"""A tag of which fewer fit together has not been found: a stranger's pulses fit by chance."""
IN_A_ROW = 0.35
"""Nor has one of whose pulses fewer follow one another without a gap: every fourth pulse of 1.3 s fits every third of a
stranger's 1.7 s."""
SURE = 20.0
Whose = int | Literal["overlapping", "unclear", "stranger"]
"""The tag's number; or two tags sent at once; or it could be of more than one, or of one not found yet; or nobody's."""


def whose_pulses(at_s: Sequence[float], tags: Sequence[Pulses]) -> list[Whose]:
    """(n,) whose each pulse is. at_s: (n,) middles of the pulses heard, seconds, ascending."""
    sorter = RhythmSorter(tags)
    for moment in at_s:
        sorter.take(moment)
    return sorter.whose()


@dataclass(slots=True)
class RhythmSorter:
    """The same, pulse by pulse. kept_s: pulses older than that are forgotten."""

    tags: Sequence[Pulses]
    kept_s: float = math.inf
    at_s: list[float] = field(default_factory=list[float], init=False)
    _assumed: _Assumed = field(init=False)
    _beam: _Beam = field(init=False)
    _steps: list[_Step] = field(default_factory=list["_Step"], init=False)

    def __post_init__(self) -> None:
        self._assumed = _Assumed.of(self.tags)
        self._beam = _Beam.begun(self._assumed)

    def take(self, at_s: float) -> None:
        """Take the next pulse. One that is earlier than the last (the clock was set) starts everything over."""
        if self.at_s and at_s < self.at_s[-1]:
            self.at_s, self._steps, self._beam = [], [], _Beam.begun(self._assumed)
        self.at_s.append(at_s)
        self._beam, step = self._beam.after(at_s, self._assumed)
        self._steps.append(step)
        if at_s - self.at_s[0] > 2.0 * self.kept_s:
            keep = int(np.searchsorted(self.at_s, at_s - self.kept_s))
            self.at_s, self._steps = self.at_s[keep:], self._steps[keep:]

    def whose(self) -> list[Whose]:
        """Of the pulses in `at_s`, as all of them say."""
        return _judged(np.array(self.at_s), self._likeliest(), self.tags)

    def _likeliest(self) -> NDArray[np.int64]:
        """(n,) the tag that each pulse belongs to in the likeliest history, -1: none."""
        chosen = np.full(len(self._steps), -1, dtype=np.int64)
        at = 0  # hypotheses are kept with the likeliest first
        for k in range(len(self._steps) - 1, -1, -1):
            chosen[k], at = self._steps[k].choice[at], int(self._steps[k].parent[at])
        return chosen


@dataclass(frozen=True, slots=True)
class _Assumed:
    """(k,) of the tags: nominal period, and the variances of an interval's straying, of a pulse's time as it is heard,
    of the period's change from one pulse to the next, and of the period at first. begins: (k,) log likelihood, against
    a stranger's, that a pulse is the first of a tag. heard_first: log(HEARD / strangers a second). miss: log likelihood
    of a pulse that was not heard."""

    nominal: Floats
    stray: Floats
    heard: Floats
    wander: Floats
    clock: Floats
    begins: Floats
    heard_first: float
    miss: float

    @classmethod
    def of(cls, tags: Sequence[Pulses]) -> _Assumed:
        """What follows from what they send."""
        nominal = np.array([tag.period_s for tag in tags])
        heard_first = math.log(HEARD / _strangers_hz(tags))
        return cls(
            nominal,
            np.array([_stray_s(tag) for tag in tags]) ** 2,
            np.array([_heard_s(tag) for tag in tags]) ** 2,
            (DRIFT * nominal) ** 2,
            np.array([tag.jitter_s / 2.0 for tag in tags]) ** 2,
            heard_first - np.log(nominal),
            heard_first,
            math.log(1.0 - HEARD),
        )


@dataclass(frozen=True, slots=True)
class _Step:
    """Of each hypothesis after a pulse: the one it came from, and the tag that the pulse was given to (-1: none)."""

    parent: NDArray[np.int64]
    choice: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class _Due:
    """(h, k) of each hypothesis and tag at a pulse. known: whether the phase still is. periods: since its last pulse.
    off: s from where it was due. variance: of that place; total: and of the pulse's time as it is heard."""

    known: NDArray[np.bool_]
    periods: Floats
    off: Floats
    variance: Floats
    total: Floats


@dataclass(frozen=True, slots=True)
class _Beam:
    """Hypotheses about who sent what, likeliest first.

    score: (h,) log likelihood. known: (h, k) whether the tag's phase is. last, period: (h, k) s, of its last pulse's
    true time and its period; cov: (h, k, 3) of both (last last, last period, period period). missed: (h, k) pulses not
    heard since, as counted in the score.
    """

    score: Floats
    known: NDArray[np.bool_]
    last: Floats
    period: Floats
    cov: Floats
    missed: NDArray[np.int64]

    @classmethod
    def begun(cls, assumed: _Assumed) -> _Beam:
        """Nothing was heard yet."""
        shape = (1, assumed.nominal.size)
        unknown, none = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=np.int64)
        return cls(np.zeros(1), unknown, np.zeros(shape), assumed.nominal[None, :].copy(), np.zeros((*shape, 3)), none)

    def after(self, at_s: float, assumed: _Assumed) -> tuple[_Beam, _Step]:
        """Every hypothesis with the new pulse given to nobody and to each tag; the likeliest of these."""
        due, tags = self._due(at_s, assumed), assumed.nominal.size
        missed = self._missed(at_s, due)
        base = self.score + assumed.miss * np.where(due.known, missed - self.missed, 0).sum(axis=1)

        fits = -0.5 * (due.off**2 / due.total + np.log(2.0 * math.pi * due.total))
        gain = np.where(due.known, assumed.heard_first + fits, assumed.begins)
        # the pulse itself is not one that was missed
        itself = due.known & (missed >= due.periods) & (missed > self.missed)
        gain = np.where(itself, gain - assumed.miss, gain)
        again = np.where(due.known, assumed.begins + math.log(BEGINS_AGAIN), -np.inf)
        options = np.concatenate([np.zeros((base.size, 1)), gain, again], axis=1) + base[:, None]

        best = np.argsort(-options, axis=None, kind="stable")[:BEAM]
        parent, option = np.unravel_index(best, options.shape)
        tag = np.where(option == 0, -1, (option - 1) % tags)
        score = options.ravel()[best]
        after = _Beam(
            score - score[0],
            due.known[parent],
            self.last[parent],
            self.period[parent],
            self.cov[parent],
            np.where(due.known, missed, 0)[parent],
        )
        given = np.flatnonzero(option > 0)
        follows = (option[given] <= tags) & due.known[parent[given], tag[given]]
        after.known[given, tag[given]] = True
        after.missed[given, tag[given]] = 0
        after._begin(at_s, given[~follows], tag[given[~follows]], assumed)
        after._follow(self, due, given[follows], tag[given[follows]], parent[given[follows]], assumed)
        return after, _Step(parent.astype(np.int64), tag.astype(np.int64))

    def _due(self, at_s: float, assumed: _Assumed) -> _Due:
        """x = (last, period), x' = F^m x, P' = F^m P F^mT + Q(m)."""
        since = at_s - self.last
        m = np.maximum(np.rint(since / self.period), 1.0)
        variance = self.cov[..., 0] + 2.0 * m * self.cov[..., 1] + m**2 * self.cov[..., 2]
        variance += m * assumed.stray + m**3 * assumed.wander / 3.0
        known = self.known & (np.sqrt(variance) < LOST * assumed.nominal)
        return _Due(known, m, since - m * self.period, variance, variance + assumed.heard)

    def _missed(self, at_s: float, due: _Due) -> NDArray[np.int64]:
        """(h, k) pulses that were due and not heard by now, as far as they count."""
        passed = np.floor((at_s - self.last - 3.0 * np.sqrt(due.total)) / self.period)
        return np.clip(np.where(due.known, passed, 0.0), self.missed, COUNTED_MISSES).astype(np.int64)

    def _begin(self, at_s: float, rows: NDArray[np.int64], tag: NDArray[np.int64], assumed: _Assumed) -> None:
        """The pulse is a tag's first, or first again."""
        self.last[rows, tag], self.period[rows, tag] = at_s, assumed.nominal[tag]
        self.cov[rows, tag] = np.stack([assumed.heard[tag], np.zeros(rows.size), assumed.clock[tag]], axis=-1)

    def _follow(
        self,
        before: _Beam,
        due: _Due,
        rows: NDArray[np.int64],
        tag: NDArray[np.int64],
        parent: NDArray[np.int64],
        assumed: _Assumed,
    ) -> None:
        """The pulse is a tag's next: K = P' H^T / total, x'' = x' + K off, P'' = (I - K H) P', H = (1, 0)."""
        m, cov = due.periods[parent, tag], before.cov[parent, tag]
        cross = cov[:, 1] + m * cov[:, 2] + 0.5 * m**2 * assumed.wander[tag]
        own = cov[:, 2] + m * assumed.wander[tag]
        variance, total, off = due.variance[parent, tag], due.total[parent, tag], due.off[parent, tag]
        to_last, to_period = variance / total, cross / total
        period = before.period[parent, tag]
        self.last[rows, tag] = before.last[parent, tag] + m * period + to_last * off
        self.period[rows, tag] = period + to_period * off
        self.cov[rows, tag] = np.stack(
            [(1.0 - to_last) * variance, (1.0 - to_last) * cross, own - to_period * cross], axis=-1
        )


def _strangers_hz(tags: Sequence[Pulses]) -> float:
    return STRANGERS * sum(1.0 / tag.period_s for tag in tags)


def _stray_s(tag: Pulses) -> float:
    """Standard deviation of an interval: what strays by up to the jitter strays by a third of it."""
    return tag.jitter_s / 3.0


def _heard_s(tag: Pulses) -> float:
    """Standard deviation of the time at which a pulse is heard: a quarter of its width, and what it strays itself."""
    return math.hypot(tag.width_s / 4.0, tag.jitter_s / 6.0)


def _judged(at_s: Floats, given: NDArray[np.int64], tags: Sequence[Pulses]) -> list[Whose]:
    """Each pulse, as the tags' pulses before and after it say whose it is."""
    found = [k for k, tag in enumerate(tags) if _is_found(at_s[given == k], tag)]
    missing = len(found) < len(tags)
    ratio, due_within = np.zeros((at_s.size, len(tags))), np.full((at_s.size, len(tags)), np.inf)
    for k in found:
        off, sd = _off_schedule(at_s, at_s[given == k], tags[k])
        density = np.exp(-0.5 * (off / sd) ** 2) / (math.sqrt(2.0 * math.pi) * sd)
        ratio[:, k] = HEARD * density / _strangers_hz(tags)
        due_within[:, k] = np.abs(off) - 2.0 * sd
    verdicts: list[Whose] = []
    for i in range(at_s.size):
        best = int(np.argmax(ratio[i]))
        likely, others = float(ratio[i, best]), float(np.delete(ratio[i], best).sum()) + 1.0
        widths = [(tags[best].width_s + tag.width_s) / 2.0 for tag in tags]
        at_once = [k for k in found if k != best and due_within[i, k] < widths[k]]
        if likely < 1.0:
            verdicts.append("unclear" if missing else "stranger")
        elif at_once and not _heard_apart(i, best, at_once, at_s, given, widths):
            verdicts.append("overlapping")
        elif given[i] != best or likely < SURE * others:
            verdicts.append("unclear")
        else:
            verdicts.append(best)
    return verdicts


def _heard_apart(
    i: int, mine: int, others: Sequence[int], at_s: Floats, given: NDArray[np.int64], widths: Sequence[float]
) -> bool:
    """Whether each other tag that was due at about the same moment was heard by itself, a whole pulse away."""
    for k in others:
        near = [j for j in (i - 1, i + 1) if 0 <= j < at_s.size and given[j] == k]
        if not any(abs(at_s[j] - at_s[i]) > 1.25 * widths[k] for j in near):
            return False
        if not any(abs(at_s[j] - at_s[i]) < 0.5 for j in near):
            return False
    return given[i] == mine


def _off_schedule(at_s: Floats, own_s: Floats, tag: Pulses) -> tuple[Floats, Floats]:
    """(n,) s from each moment to where the tag was due next to it, and that place's standard deviation.

    own_s: its pulses, two or more, of which the moment itself does not count. Between two of them, the due place m
    periods after the one and n before the other lies at t_a + (t_b - t_a) m / (m + n) (a Brownian bridge); outside,
    whole mean periods away from the nearest.
    """
    stray, heard = _stray_s(tag) ** 2, _heard_s(tag) ** 2
    period = _mean_period(own_s, tag)
    before = np.searchsorted(own_s, at_s, "left") - 1
    after = np.searchsorted(own_s, at_s, "right")
    inside = (before >= 0) & (after < own_s.size)
    left, right = own_s[np.maximum(before, 0)], own_s[np.minimum(after, own_s.size - 1)]

    whole = np.maximum(np.rint((right - left) / period), 1.0)
    step = np.where(inside, (right - left) / whole, period)
    m = np.clip(np.rint((at_s - left) / step), 0.0, whole)
    share = m / whole
    between = stray * m * (whole - m) / whole + heard * (1.0 + (1.0 - share) ** 2 + share**2)

    edge = np.where(before >= 0, left, right)
    periods = np.rint((at_s - edge) / period)
    beyond = stray * np.abs(periods) + 2.0 * heard + (periods * _period_sd(own_s, tag)) ** 2

    off = at_s - np.where(inside, left + m * step, edge + periods * period)
    sd = np.sqrt(np.where(inside, between, beyond))
    return off, np.minimum(sd, tag.period_s / 2.0)


def _is_found(own_s: Floats, tag: Pulses) -> bool:
    """Whether these are a tag's pulses, and not some of a stranger's."""
    if own_s.size < LEAST_PULSES:
        return False
    return float((np.diff(own_s) < 1.5 * tag.period_s).mean()) >= IN_A_ROW


def _mean_period(own_s: Floats, tag: Pulses) -> float:
    """Between the pulses heard, each gap taken for the whole number of periods that it is nearest to."""
    gaps = np.diff(own_s)
    period = tag.period_s
    for _ in range(3):
        counts = np.maximum(np.rint(gaps / period), 1.0)
        period = float(gaps.sum() / counts.sum())
    return period


def _period_sd(own_s: Floats, tag: Pulses) -> float:
    """Of that mean."""
    spanned = max((own_s[-1] - own_s[0]) / tag.period_s, 1.0)
    return math.sqrt(_stray_s(tag) ** 2 / spanned + 2.0 * _heard_s(tag) ** 2 / spanned**2)
