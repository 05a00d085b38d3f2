"""Why the simulated world cannot be entered yet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class HomeNotKnown:
    code: Literal["home_not_known"] = "home_not_known"

    english: ClassVar[Words] = Words(
        "The simulated emitters stand around the vehicle's home, which is not known yet.", "Wait for a GPS fix."
    )


@dataclass(frozen=True, slots=True)
class SimulatorRefused:
    """problem: the simulator's own words."""

    problem: str
    code: Literal["simulator_refused"] = "simulator_refused"

    english: ClassVar[Words] = Words("The simulated autopilot refused: {problem}.")


@dataclass(frozen=True, slots=True)
class SimulatorSilent:
    """order: what it was asked to do."""

    order: str
    waited_s: float
    code: Literal["simulator_silent"] = "simulator_silent"

    english: ClassVar[Words] = Words(
        "The simulated autopilot did not answer to {order} within {waited_s:1}.", "Start it again."
    )


SimulationReason = HomeNotKnown | SimulatorRefused | SimulatorSilent
