"""From where an emitter was heard on the way, as places that a claim may rest on (mission rule 6).

A leg is one place, in the middle of its stretches, however long it is: they share their echoes. With f / c of a stretch
at the estimate (planner.on_the_way), the bias, scale and outlier rate e of its source as the belief has them, and
places nearer than its NEAR_M left out, a leg says

    l = sum over its stretches of log((1 - e) f / c + e)

It sees the estimate where l >= TELLS, speaks against it where l <= -TELLS, and says nothing in between: by TELLS the
emitter is e = 2.7 times likelier there than in a direction at random. Legs of a source that took no bearing are no
places: nobody has looked to the other side.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.on_the_way import Stretch, heard, log_ratio

TELLS = 1.0


@dataclass(frozen=True, slots=True)
class SeenFrom:
    """x, y: m ENU, the middle of a leg. said: l, of the estimate."""

    leg: str
    x: float
    y: float
    said: float

    @property
    def sees(self) -> bool:
        """It speaks for the estimate."""
        return self.said >= TELLS

    @property
    def against(self) -> bool:
        """It speaks against it."""
        return self.said <= -TELLS


def seen_on_the_way(belief: GridBelief, x: float, y: float) -> tuple[SeenFrom, ...]:
    """What each leg says of an estimate at (x, y), m ENU, in the order of the legs."""
    if not isinstance(belief, JointBelief):
        return ()
    legs: dict[tuple[str, str], list[Stretch]] = {}
    for stretch in belief.stretches:
        if belief.errors_of(stretch.source) is not None:
            legs.setdefault((stretch.source, stretch.leg), []).append(stretch)
    return tuple(_seen(belief, *leg, stretches, x, y) for leg, stretches in legs.items())


def _seen(belief: JointBelief, source: str, leg: str, stretches: list[Stretch], x: float, y: float) -> SeenFrom:
    errors = belief.errors_of(source)
    assert errors is not None
    scale, rate = np.array([errors.scale]), errors.outlier_rate
    found = heard(stretches, scale)
    at = np.array([x]), np.array([y])
    ratio = np.exp(log_ratio(*at, found, np.array([errors.bias]), scale)).ravel()
    middle = np.mean([(np.mean(one.x), np.mean(one.y)) for one in stretches], axis=0)
    return SeenFrom(leg, float(middle[0]), float(middle[1]), float(np.log((1.0 - rate) * ratio + rate).sum()))
