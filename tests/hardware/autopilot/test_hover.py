from __future__ import annotations

from collections.abc import Iterable

from hardware.autopilot.hover import SETTLED_S, Hover
from hardware.readings import Place

DEG = 1.0 / 111_195.0


def hovers_at(track: Iterable[tuple[float, float]]) -> float | None:
    """track: (metres north, m/s) ten times a second."""
    hover = Hover()
    for number, (north_m, speed_m_s) in enumerate(track):
        if hover.see(Place(47.0 + north_m * DEG, 8.0), speed_m_s, 100.0 + number / 10.0):
            return number / 10.0
    return None


def test_a_vehicle_that_stays_slow_on_its_spot_hovers_after_two_seconds() -> None:
    assert hovers_at([(5.0, 3.0)] * 10 + [(5.0, 0.3)] * 50) == 1.0 + SETTLED_S


def test_the_moment_in_which_it_turns_back_to_its_stop_point_is_no_hover() -> None:
    """At 7 m/s it flies past by 6 m and comes back with up to 2 m/s."""
    past = [(6.0 - 0.05 * k, abs(1.0 - 0.1 * k)) for k in range(20)]  # slow for 1.8 s
    back = [(5.0 - 0.2 * k, 2.0) for k in range(25)]
    there = [(0.0, 0.2)] * 40
    assert hovers_at(past + back + there) == 4.5 + SETTLED_S


def test_a_slow_drift_is_no_hover() -> None:
    assert hovers_at((0.15 * k, 0.9) for k in range(13)) is None
    assert hovers_at((0.25 * k, 0.9) for k in range(100)) is None


def test_a_speed_that_is_not_known_is_no_hover() -> None:
    hover = Hover()
    assert not any(hover.see(Place(47.0, 8.0), None, float(at)) for at in range(10))
