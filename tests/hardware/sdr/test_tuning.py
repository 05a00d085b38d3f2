"""One centre for several emitters: all inside the band, away from its spike, or named as refused."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.reasons.channels import BandTooNarrow
from hardware.sdr.tuning import SPIKE_CLEAR, Reach, centre_hz, width_hz

RATE_HZ = 250_000.0
REACH_HZ = 3_200.0
BASE_HZ = 868_000_000.0


def wanted(*offsets_hz: float) -> list[Reach]:
    return [Reach(BASE_HZ + offset, REACH_HZ) for offset in offsets_hz]


def test_one_emitter_lies_beside_the_spike() -> None:
    assert centre_hz(wanted(0.0), RATE_HZ) == BASE_HZ + SPIKE_CLEAR * RATE_HZ


@given(st.lists(st.floats(0.0, RATE_HZ - 2.0 * REACH_HZ), min_size=1, max_size=6, unique=True))
def test_what_fits_is_all_inside_the_band(offsets_hz: list[float]) -> None:
    centre = centre_hz(wanted(*offsets_hz), RATE_HZ)
    assert isinstance(centre, float)
    assert all(abs(one.frequency_hz - centre) + REACH_HZ <= RATE_HZ / 2.0 + 1e-3 for one in wanted(*offsets_hz))


@pytest.mark.parametrize("offsets_hz", [(0.0, 40_000.0), (0.0, 200_000.0), (0.0, 60_000.0, 240_000.0)])
def test_no_emitter_lies_on_the_spike_when_there_is_room(offsets_hz: tuple[float, ...]) -> None:
    centre = centre_hz(wanted(*offsets_hz), RATE_HZ)
    assert isinstance(centre, float)
    assert min(abs(one.frequency_hz - centre) for one in wanted(*offsets_hz)) > 2.0 * REACH_HZ


def test_what_does_not_fit_beside_those_asked_for_before_is_named_with_the_rate_that_would_do() -> None:
    asked = wanted(0.0, 1_000_000.0, 100_000.0, -500_000.0)
    needed_hz = width_hz(asked)
    assert needed_hz == 1_506_400.0
    refused_hz = (BASE_HZ + 1_000_000.0, BASE_HZ - 500_000.0)
    assert centre_hz(asked, RATE_HZ) == BandTooNarrow(RATE_HZ, needed_hz, refused_hz)
    assert isinstance(centre_hz(asked, needed_hz), float)
