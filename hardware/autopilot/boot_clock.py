"""The autopilot's time since boot as UTC: when a heading was true, not when its message happened to arrive.

What is heard of boot time x at UTC t is late by the link's delay, never early, so t - x lies on or above a line over x,
whose slope is the rate of the two clocks: a crystal's, or that of a simulator that does not keep up. The height of the
line is the offset and the least delay; TIMESYNC exchanges tell the two apart. Where they are not answered half of the
shortest round trip is taken for the least delay (both ways take as long); without either the delay stays.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

RATE_LIMIT = 0.05
"""The autopilot's clock may be slower or faster than ours by this share; more is reported, not followed."""
WINDOW_S, BUCKET_S, RATE_FROM_S = 30.0, 1.0, 5.0
"""Of boot time: how much the line is drawn under, in parts of which the lowest point counts; from when it slopes."""
JUDGED_FROM_S, AGREES_AGAIN = 15.0, 0.8
"""How long the clocks are compared before one is called odd, and the share of the limit at which they agree again."""
ODD_LOOKS = 10
LONGEST_ROUND_TRIP_S = 3.0
AGEING = 0.01
"""s/s: the uncertainty that an exchange gains as it ages, in addition to half of its round trip."""
_STEP_S, _STEP_COUNT = 1.0, 30
"""An offset larger than this over many messages is a step (the autopilot was suspended), not delay."""


@dataclass(slots=True)
class LastingOddity:
    """Whether a rate stays odd: a simulated autopilot that catches up on a busy machine, or a link that lets go what it
    held up, looks odd for some seconds of wall time, however fast the mission's clock runs."""

    looks: int = 0

    def look(self, odd: bool) -> bool:
        """Once a second of real time. True from the ODD_LOOKS-th look on that finds it odd, in a row."""
        self.looks = self.looks + 1 if odd else 0
        return self.looks >= ODD_LOOKS


@dataclass(frozen=True, slots=True)
class _Point:
    boot_s: float
    offset_s: float


@dataclass(frozen=True, slots=True)
class _Bounds:
    """At `boot_s` the offset lies between these, however long either way took: nothing is answered before it is asked,
    or heard before it is sent."""

    boot_s: float
    least_s: float
    most_s: float


@dataclass(frozen=True, slots=True)
class _Exchange:
    """offset_s: as if both ways had taken as long; half of round_trip_s is what it may be wrong by."""

    boot_s: float
    offset_s: float
    round_trip_s: float


class BootClock:
    """Fed with messages and TIMESYNC exchanges as they come."""

    def __init__(self) -> None:
        self.reboots = 0
        """How often the time since boot went back."""
        self.measured_rate: float | None = None
        """Seconds of the autopilot's clock in one of ours, before the limit; None until it is known."""
        self.rate_is_odd = False
        """Further from ours than is followed: times are not what they seem. See _judge_rate."""
        self._begin()

    def _begin(self) -> None:
        self._points: deque[_Point] = deque()
        self._exchanges: deque[_Exchange] = deque()
        self._best: _Exchange | None = None
        self._round_trips: deque[tuple[float, float]] = deque()
        """(boot time, seconds)"""
        self._bounds: deque[_Bounds] = deque()
        self._ping: tuple[float, float, float] | None = None
        """(sent at, boot time heard before its answer, answer heard at), until the next boot time is heard."""
        self._odd_since_s: float | None = None
        self._seen_slope = 0.0
        """s/s, of the offset over boot time, as the line last had it; not limited."""
        self._slope = 0.0
        self._through: _Point | None = None
        self._boot_s = 0.0
        self._late: list[_Point] = []

    def to_utc(self, boot_s: float, heard_at_s: float) -> float:
        """UTC of the moment `boot_s` after boot, from a message heard at `heard_at_s` (UTC); never later than that."""
        point = _Point(boot_s, heard_at_s - boot_s)
        if boot_s < self._boot_s - _STEP_S:
            self.reboots += 1
            self.measured_rate, self.rate_is_odd = None, False
            self._begin()
        self._boot_s = boot_s
        if self._ping is not None and boot_s > self._ping[1]:
            (sent_at_s, before_s, answered_at_s), self._ping = self._ping, None
            self._bound(_Bounds(before_s, sent_at_s - boot_s, answered_at_s - before_s))
        if self._through is None or point.offset_s <= self._line(boot_s):
            self._through = point
            self._late.clear()
        else:
            self._judge_step(point)
        self._remember(point)
        offset_s = self._least_offset(boot_s) if self._best is None else self._offset_by(self._best, boot_s)
        return boot_s + min(offset_s, point.offset_s)

    def exchanged(self, sent_at_s: float, boot_s: float, heard_at_s: float) -> None:
        """A TIMESYNC: asked at `sent_at_s`, answered by the autopilot at `boot_s`, heard at `heard_at_s` (UTC)."""
        round_trip_s = heard_at_s - sent_at_s
        if not 0.0 <= round_trip_s <= LONGEST_ROUND_TRIP_S or boot_s < self._boot_s - _STEP_S:
            return
        new = _Exchange(boot_s, 0.5 * (sent_at_s + heard_at_s) - boot_s, round_trip_s)
        if self._best is not None and abs(self._offset_by(self._best, boot_s) - new.offset_s) > 0.5 * round_trip_s:
            self._exchanges.clear()  # by the ones before it was answered before it was asked, or after it was heard
        self._exchanges.append(new)
        self._bound(_Bounds(boot_s, sent_at_s - boot_s, heard_at_s - boot_s))
        while boot_s - self._exchanges[0].boot_s > WINDOW_S:
            self._exchanges.popleft()
        self._best = min(self._exchanges, key=lambda one: 0.5 * one.round_trip_s + AGEING * (boot_s - one.boot_s))

    def went_round(self, sent_at_s: float, heard_at_s: float) -> None:
        """A PING: asked at `sent_at_s`, its answer, which tells no time, heard at `heard_at_s` (UTC)."""
        round_trip_s = heard_at_s - sent_at_s
        if 0.0 <= round_trip_s <= LONGEST_ROUND_TRIP_S:
            self._round_trips.append((self._boot_s, round_trip_s))
            self._ping = (sent_at_s, self._boot_s, heard_at_s)

    def _bound(self, new: _Bounds) -> None:
        """The narrowest of each BUCKET_S."""
        bounds = self._bounds
        if not bounds or new.boot_s // BUCKET_S > bounds[-1].boot_s // BUCKET_S:
            bounds.append(new)
        elif new.most_s - new.least_s < bounds[-1].most_s - bounds[-1].least_s:
            bounds[-1] = new
        while new.boot_s - bounds[0].boot_s > WINDOW_S:
            bounds.popleft()

    def _judge_rate(self, boot_s: float) -> None:
        """Odd when the line and the round trips both say so, at once; when only one does, after a whole window: a link
        that holds much up misleads the line, a simulator that stalls for an instant the ends of the round trips."""
        while self._bounds and boot_s - self._bounds[0].boot_s > WINDOW_S:
            self._bounds.popleft()
        sure, line = self._sure_slope(), self._seen_slope
        if abs(line) <= RATE_LIMIT and sure is None:
            self._odd_since_s = None
        elif self._odd_since_s is None:
            self._odd_since_s = boot_s
        lasting = self._odd_since_s is not None and boot_s - self._odd_since_s >= WINDOW_S
        if lasting or (abs(line) > RATE_LIMIT and sure is not None):
            self.rate_is_odd = True
        elif abs(line) <= AGREES_AGAIN * RATE_LIMIT and sure is None:
            self.rate_is_odd = False
        if self.rate_is_odd and sure is not None:
            self.measured_rate = 1.0 / (1.0 + sure)

    def _sure_slope(self) -> float | None:
        """(least_2 - most_1) / (x_2 - x_1) <= slope <= (most_2 - least_1) / (x_2 - x_1), from oldest to latest: the
        middle, when all of that is beyond the limit."""
        if not self._bounds:
            return None
        first, last = self._bounds[0], self._bounds[-1]
        over_s = last.boot_s - first.boot_s
        if over_s < JUDGED_FROM_S:
            return None
        least, most = (last.least_s - first.most_s) / over_s, (last.most_s - first.least_s) / over_s
        return max(0.5 * (least + most), -0.9) if least > RATE_LIMIT or most < -RATE_LIMIT else None

    def _least_offset(self, boot_s: float) -> float:
        """The line, less the least delay."""
        trips = self._round_trips
        while trips and boot_s - trips[0][0] > WINDOW_S:
            trips.popleft()
        return self._line(boot_s) - 0.5 * min((seconds for _, seconds in trips), default=0.0)

    def _offset_by(self, exchange: _Exchange, boot_s: float) -> float:
        return exchange.offset_s + self._slope * (boot_s - exchange.boot_s)

    def _line(self, boot_s: float) -> float:
        assert self._through is not None
        return self._through.offset_s + self._slope * (boot_s - self._through.boot_s)

    def _start_again(self, point: _Point) -> None:
        """From a step on; the rate is that of before."""
        self._points.clear()
        self._exchanges.clear()
        self._round_trips.clear()
        self._best = None
        self._late.clear()
        self._through = point

    def _judge_step(self, point: _Point) -> None:
        if point.offset_s - self._line(point.boot_s) < _STEP_S:
            self._late.clear()
            return
        self._late.append(point)
        if len(self._late) >= _STEP_COUNT:
            self._start_again(min(self._late, key=lambda late: late.offset_s))

    def _remember(self, point: _Point) -> None:
        """The lowest point of each BUCKET_S; a full bucket redraws the line."""
        points = self._points
        if not points or point.boot_s // BUCKET_S > points[-1].boot_s // BUCKET_S:
            if points:
                self._draw()
            points.append(point)
            while point.boot_s - points[0].boot_s > WINDOW_S:
                points.popleft()
        elif point.offset_s < points[-1].offset_s and point.boot_s // BUCKET_S == points[-1].boot_s // BUCKET_S:
            points[-1] = point

    def _draw(self) -> None:
        """The line below all points that is nearest to them (Moon, Skelly and Towsley 1999): an edge of their hull."""
        points = self._points
        if points[-1].boot_s - points[0].boot_s >= RATE_FROM_S:
            before, after = _edge_below(list(points))
            slope = (after.offset_s - before.offset_s) / (after.boot_s - before.boot_s)
            self._seen_slope = max(slope, -0.9)
            self.measured_rate = 1.0 / (1.0 + self._seen_slope)
            self._slope = min(max(slope, -RATE_LIMIT), RATE_LIMIT)
        lowest, here = math.inf, points[-1]
        for point in points:
            height = point.offset_s + self._slope * (here.boot_s - point.boot_s)
            lowest = min(lowest, height)
        self._through = _Point(here.boot_s, lowest)
        self._judge_rate(here.boot_s)


def _edge_below(points: list[_Point]) -> tuple[_Point, _Point]:
    """The edge of the lower convex hull over the mean of the points' boot times. points: at least two, in order."""
    hull: list[_Point] = []
    for point in points:
        while len(hull) >= 2 and _above(hull[-1], hull[-2], point):
            hull.pop()
        hull.append(point)
    mean_s = sum(point.boot_s for point in points) / len(points)
    at = next(k for k, point in enumerate(hull) if k > 0 and point.boot_s >= mean_s)
    return hull[at - 1], hull[at]


def _above(middle: _Point, left: _Point, right: _Point) -> bool:
    """On or above the straight line between the other two."""
    rise = (middle.offset_s - left.offset_s) * (right.boot_s - left.boot_s)
    return rise >= (right.offset_s - left.offset_s) * (middle.boot_s - left.boot_s)
