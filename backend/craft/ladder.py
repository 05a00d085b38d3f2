"""An order as a ladder: what is commanded, when it is tried again, and what instead. Pure data and choice.

Stopping comes before the way home, and landing where the vehicle is comes last, after a pause in which a person can
give another order: what is below a vehicle that was not led there is not known.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from backend.reasons import Reason
from backend.reasons.flight import OrderName, Way

BEGINS_AGAIN_S = 10.0
"""After the last rung, the first one again: a vehicle in the air is not given up."""


@dataclass(frozen=True, slots=True)
class Rung:
    """after_s: seconds between the failure before it and this try."""

    way: Way
    after_s: float = 0.0


_LAND_LAST = (Rung("land", 10.0), Rung("land", 2.0))
_RETURN = (Rung("return"), Rung("return", 1.0), Rung("return", 2.0), Rung("hold", 1.0), Rung("return", 10.0))

LADDERS: dict[OrderName, tuple[Rung, ...]] = {
    "hold": (Rung("hold"), Rung("hold", 1.0), Rung("hold", 2.0), Rung("return", 2.0), Rung("return", 2.0), *_LAND_LAST),
    "return": (*_RETURN, *_LAND_LAST),
    "abort": (Rung("hold"), *_RETURN, *_LAND_LAST),
    "land": (Rung("land"), Rung("land", 1.0), Rung("land", 2.0), Rung("return", 2.0), Rung("hold", 1.0)),
}


@dataclass(frozen=True, slots=True)
class Ladder:
    """An order that is being carried out. rung: index in its ladder.

    stage: tried, the vehicle has not confirmed the rung yet; waits, the rung is tried after its pause, or when the
    vehicle is heard again; done, telemetry has confirmed it. because: why the rung before was not done.
    """

    order: OrderName
    rung: int = 0
    stage: Literal["tried", "waits", "done"] = "tried"
    because: Reason | None = None

    @property
    def way(self) -> Way:
        """What this rung tells the vehicle."""
        return self._rungs[self.rung].way

    @property
    def after_s(self) -> float:
        """Before this rung."""
        return BEGINS_AGAIN_S if self.rung == 0 else self._rungs[self.rung].after_s

    @property
    def as_ordered(self) -> bool:
        """This rung is what was asked for, not what is done instead."""
        return self.way == ("return" if self.order == "abort" else self.order)

    @property
    def fulfils(self) -> bool:
        """This rung, once confirmed, ends the order; hovering is an end of nothing but a hold."""
        return self.way != "hold" or self.order == "hold"

    def next(self, because: Reason | None) -> Ladder:
        """The rung after this one, to be tried after its pause."""
        because = self.because if because is None else because
        return replace(self, rung=(self.rung + 1) % len(self._rungs), stage="waits", because=because)

    @property
    def _rungs(self) -> tuple[Rung, ...]:
        return LADDERS[self.order]
