"""A vehicle is under way when it is seen to close in on its leg, not when it merely moves."""

from __future__ import annotations

import pytest

from backend.craft.under_way import LOOKS, UnderWay
from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry

HERE = Place(50.6, 7.2)
FRAME = LocalFrame(HERE)


def flying(north: float, east: float, down: float = 0.0) -> Telemetry:
    return Telemetry(
        connected=True,
        at_s=0.0,
        position=HERE,
        velocity_north_m_s=north,
        velocity_east_m_s=east,
        velocity_down_m_s=down,
    )


def looks(to: Place | None, telemetry: Telemetry, times: int = LOOKS) -> bool:
    under_way = UnderWay()
    if to is not None:
        under_way.begin(to)
    return [under_way.look(telemetry) for _ in range(times)][-1]


@pytest.mark.parametrize(
    ("to", "telemetry", "expected"),
    [
        ((0.0, 100.0), flying(5.0, 0.0), True),
        ((0.0, 100.0), flying(-7.0, 0.0), False),
        ((0.0, 100.0), flying(0.0, 7.0), False),
        ((0.0, 100.0), flying(0.3, 0.0), False),
        ((0.0, 0.0), flying(0.0, 0.0, -1.5), True),
        ((0.0, 0.0), flying(0.0, 0.0), False),
        (None, flying(5.0, 0.0), False),
    ],
)
def test_it_closes_in_or_climbs_on_the_spot(to, telemetry: Telemetry, expected: bool) -> None:
    place = None if to is None else FRAME.to_geo(*to)
    assert looks(place, telemetry) is expected


def test_one_look_is_not_enough_and_a_leg_that_failed_does_not_count() -> None:
    to = FRAME.to_geo(0.0, 100.0)
    assert not looks(to, flying(5.0, 0.0), LOOKS - 1)
    under_way = UnderWay()
    under_way.begin(to)
    for _ in range(LOOKS - 1):
        under_way.look(flying(5.0, 0.0))
    under_way.end()
    assert not under_way.look(flying(5.0, 0.0))
