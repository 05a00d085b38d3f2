"""What a silent turn says it listened to: chances by the antenna's heading, and the antenna's pattern."""

from __future__ import annotations

import numpy as np
import pytest

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.silence import SECTORS, chances_by_heading, relative_gain_db
from hardware.readings import HeadingSample

TURN = [HeadingSample(float(s), (350.0 + 30.0 * s) % 360.0) for s in range(13)]
"""Once around in twelve seconds, from ten degrees west of north."""


def test_a_missed_pulse_is_half_a_chance_where_the_antenna_pointed() -> None:
    found = chances_by_heading([1.0 / 3.0, 3.0 + 1.0 / 3.0, 3.0 + 1.0 / 3.0], TURN, 0.0, pulsed=True)
    assert (found[0], found[4]) == (0.5, 1.0)
    assert sum(found) == 1.5
    turned = chances_by_heading([1.0 / 3.0], TURN, 90.0, pulsed=True)
    assert turned[4] == 0.5


def test_a_carrier_gives_one_chance_a_sector_however_long_it_is_listened_to() -> None:
    found = chances_by_heading(np.linspace(0.0, 12.0, 500).tolist(), TURN, 0.0, pulsed=False)
    assert found == [1.0] * SECTORS


def test_what_was_heard_while_no_heading_was_known_is_no_chance() -> None:
    assert sum(chances_by_heading([-3.0, 20.0], TURN, 0.0, pulsed=True)) == 0.0
    assert chances_by_heading([1.0], TURN[:1], 0.0, pulsed=True) == [0.0] * SECTORS


def test_the_gain_is_below_the_maximum_and_turns_clockwise() -> None:
    pattern = AntennaPattern("a", np.array([0.0, 90.0, 180.0, 270.0]), np.array([5.0, 1.0, -15.0, -3.0]))
    gain = relative_gain_db(pattern)
    assert [gain[k] for k in (0, 9, 18, 27)] == pytest.approx([0.0, -4.0, -20.0, -8.0])
    assert max(gain) <= 0.0
