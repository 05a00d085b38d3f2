"""What is learned of wind and battery in flight, and what is not: jumps, silence, swapped batteries."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import pytest

from backend.craft.endurance import unknown
from backend.craft.watch.consumption import Consumption
from hardware.readings import Telemetry

WIND = (0.0, -6.0)
"""(east, north) m/s that it blows towards: from the north."""
HOME_300_M_NORTH, HOME_300_M_SOUTH = [(0.0, 300.0)], [(0.0, -300.0)]


@dataclass
class Flown:
    """A vehicle with a drag and a battery of its own, told of in telemetry."""

    wind: tuple[float, float] = WIND
    leans: bool = True
    consumption: Consumption = field(default_factory=Consumption)
    at_s: float = 1_000.0
    charge: float = 95.0

    def fly(self, velocity: tuple[float, float], seconds: float, **told: object) -> None:
        for _ in range(round(seconds / 0.5)):
            self.at_s += 0.5
            air = velocity[0] - self.wind[0], velocity[1] - self.wind[1]
            speed = math.hypot(*air)
            self.charge -= 0.5 * (0.07 + 7e-5 * speed**3)
            drag = 0.1 + 0.012 * speed
            values: dict[str, object] = {
                "connected": True,
                "at_s": self.at_s,
                "position_at_s": self.at_s,
                "velocity_east_m_s": velocity[0],
                "velocity_north_m_s": velocity[1],
                "push_east_m_s2": drag * air[0] if self.leans else None,
                "push_north_m_s2": drag * air[1] if self.leans else None,
                "battery_percent": float(round(self.charge)),
                "in_air": True,
            }
            self.consumption.update(Telemetry(**(values | told)))  # type: ignore[arg-type]

    def search(self) -> None:
        """Hover, legs in several directions, hover."""
        for velocity in ((0.0, 0.0), (7.0, 0.0), (0.0, 0.0), (0.0, 7.0), (0.0, 0.0), (-5.0, -5.0), (0.0, 0.0)):
            self.fly(velocity, 25.0)

    def takes(self, legs: list[tuple[float, float]]) -> float:
        return self.consumption.endurance.way_percent(legs, 7.0)

    def truly(self, legs: list[tuple[float, float]]) -> float:
        (leg,) = legs
        along = math.copysign(7.0, leg[1])
        hovering = 0.07 + 7e-5 * math.hypot(*self.wind) ** 3
        return 300.0 / 7.0 * (0.07 + 7e-5 * abs(along - self.wind[1]) ** 3) + 8.0 * hovering

    @property
    def wind_believed(self) -> tuple[float, float]:
        e = self.consumption.endurance
        return float(e.weight @ e.wind_east), float(e.weight @ e.wind_north)


@pytest.mark.parametrize("legs", [HOME_300_M_NORTH, HOME_300_M_SOUTH])
def test_the_way_home_is_promised_as_it_is_in_this_wind(legs: list[tuple[float, float]]) -> None:
    flown = Flown()
    flown.search()
    assert flown.wind_believed == pytest.approx(WIND, abs=1.5)
    assert flown.truly(legs) <= flown.takes(legs) <= 1.4 * flown.truly(legs) + 3.0


def test_hovering_shows_where_the_wind_comes_from_and_not_how_strong_it_is() -> None:
    flown = Flown()
    flown.fly((0.0, 0.0), 60.0)
    endurance = flown.consumption.endurance
    towards_south = endurance.weight[(endurance.wind_north < 0) & (abs(endurance.wind_east) < -endurance.wind_north)]
    assert towards_south.sum() > 0.95
    assert flown.takes(HOME_300_M_NORTH) > flown.truly(HOME_300_M_NORTH)
    assert flown.takes(HOME_300_M_NORTH) > 1.5 * flown.takes(HOME_300_M_SOUTH)


def test_a_wind_that_has_turned_is_believed_after_a_while() -> None:
    flown = Flown()
    flown.search()
    flown.wind = (6.0, 0.0)
    for _ in range(3):
        flown.search()
    assert flown.wind_believed == pytest.approx((6.0, 0.0), abs=1.5)


def test_without_attitude_a_strong_wind_is_allowed_for_until_the_battery_tells_it() -> None:
    flown = Flown(leans=False)
    flown.fly((0.0, 0.0), 60.0)
    assert flown.takes(HOME_300_M_SOUTH) > 1.5 * flown.truly(HOME_300_M_SOUTH)
    for _ in range(2):
        flown.search()
    assert flown.takes(HOME_300_M_NORTH) > flown.truly(HOME_300_M_NORTH)
    assert flown.takes(HOME_300_M_NORTH) > flown.takes(HOME_300_M_SOUTH)


def test_nothing_is_learned_while_nothing_is_known() -> None:
    flown = Flown()
    flown.fly((0.0, 0.0), 60.0, velocity_east_m_s=None)
    assert flown.consumption.endurance is unknown()


def test_a_charge_that_jumps_or_vanishes_teaches_nothing() -> None:
    calm, shaken = Flown(), Flown()
    calm.search()
    shaken.fly((0.0, 0.0), 15.0)
    for wrong in (2.0, 100.0, None, 40.0):
        shaken.fly((0.0, 0.0), 2.0, battery_percent=wrong)
        shaken.fly((0.0, 0.0), 12.0)
    shaken.search()
    assert shaken.takes(HOME_300_M_NORTH) == pytest.approx(calm.takes(HOME_300_M_NORTH), rel=0.15)


def test_a_silence_and_a_landing_are_no_flight() -> None:
    calm, silent = Flown(), Flown()
    calm.search()
    calm.search()
    silent.search()
    silent.at_s += 400.0
    silent.charge -= 20.0
    silent.search()
    assert silent.takes(HOME_300_M_NORTH) == pytest.approx(calm.takes(HOME_300_M_NORTH), rel=0.15)
    silent.fly((0.0, 0.0), 5.0, in_air=False)
    silent.charge = 100.0
    silent.fly((0.0, 0.0), 5.0)
    assert np.ptp(silent.consumption.endurance.weight) > 0.0
