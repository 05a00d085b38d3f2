"""What a stretch says is looked up as the readable twin reckons it: near and far, along and across, at any bias."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from planner.belief import compiled_evidence, compiled_way_tables, evidence
from planner.belief.compiled_on_the_way import _spread_out
from planner.belief.compiled_way_tables import middle_of, table_of
from planner.belief.evidence import sightings
from planner.belief.source_errors import FINEST_SPACING, LARGEST_BIAS, ErrorPrior, nodes
from planner.on_the_way import NEAR_M, Stretch
from planner.types import FloatArray

AHEAD = tuple((-np.minimum(12.0 * (((np.arange(36) + 18) % 36 - 18) / 6.5) ** 2, 15.0)).tolist())
SIGMA = math.radians(6.0)
ONE = np.ones(1)


def stretch(along_deg: float = 0.0, bent_deg: float = 0.0, seed: int = 3) -> Stretch:
    """20 m from (10, -5) on, bent in the middle; the antenna turns by 150 degrees, with 2 dB of noise."""
    rng = np.random.default_rng(seed)
    way = np.radians(along_deg + np.where(np.arange(13) < 6, 0.0, bent_deg))
    x, y = (
        np.concatenate([[at], at + np.cumsum(20.0 / 13 * part(way))]) for at, part in ((10.0, np.cos), (-5.0, np.sin))
    )
    front = np.radians(np.linspace(20.0, 170.0, 14))
    relative = np.arctan2(90.0 - y, 80.0 - x) - front
    gain = np.interp(relative / (2.0 * np.pi) % 1.0, np.arange(36) / 36, AHEAD, period=1.0)
    power = gain - 20.0 * np.log10(np.hypot(80.0 - x, 90.0 - y)) + 2.0 * rng.standard_normal(14)
    return Stretch("craft", tuple(x), tuple(y), tuple(front), tuple(power), AHEAD, SIGMA)


def around(one: Stretch, distance: float) -> tuple[FloatArray, FloatArray]:
    middle, angle = middle_of(one), np.radians(np.arange(0.0, 360.0, 7.0))
    return middle.x + distance * np.cos(angle), middle.y + distance * np.sin(angle)


@pytest.mark.parametrize("distance", [NEAR_M + 11.0, 60.0, 150.0, 20_000.0])
@pytest.mark.parametrize(("along", "bent"), [(0.0, 0.0), (50.0, 0.0), (200.0, 90.0)])
def test_a_stretch_says_the_same_near_and_far_on_every_side(distance: float, along: float, bent: float) -> None:
    one = stretch(along, bent)
    x, y = around(one, distance)
    grid = nodes(ErrorPrior(), SIGMA, 4, even=True)
    fast = compiled_evidence.evidence(x, y, sightings([]), grid, [one])
    plain = evidence.evidence(x, y, sightings([]), grid, [one])
    assert np.ptp(plain.log) > 0.5, "the case would show nothing"
    assert fast.log == pytest.approx(plain.log, abs=0.02)
    for ours, theirs in zip(fast[1:], plain[1:], strict=True):
        assert ours == pytest.approx(theirs, abs=0.004)


@pytest.mark.parametrize("bearings", [1, 2, 8, 300])
def test_nodes_of_any_spacing_and_to_the_end_of_their_range_are_looked_up(bearings: int) -> None:
    widest = ErrorPrior(spread=np.radians([30.0]), spread_weight=ONE)
    grid = nodes(widest, SIGMA, bearings, even=True)
    assert grid.bias[-1] >= LARGEST_BIAS
    assert bearings != 300 or grid.spacing == FINEST_SPACING
    x, y = around(stretch(), 90.0)
    fast = compiled_evidence.node_evidence(x, y, np.zeros(len(x)), sightings([]), grid, [stretch()])
    plain = evidence.node_evidence(x, y, np.zeros(len(x)), sightings([]), grid, [stretch()])
    assert fast == pytest.approx(plain, abs=0.01)
    for one_x, one_y in zip(x, y, strict=True):
        place = np.array([one_x]), np.array([one_y]), np.zeros(1)
        fast = compiled_evidence.node_evidence(*place, sightings([]), grid, [stretch()])
        plain = evidence.node_evidence(*place, sightings([]), grid, [stretch()])
        assert fast == pytest.approx(plain, abs=0.08)


def test_nodes_between_which_no_table_has_columns_are_refused() -> None:
    with pytest.raises(ValueError, match="even"):
        compiled_evidence.Weigher(sightings([]), nodes(ErrorPrior(), SIGMA, 4), [stretch()])


@pytest.mark.parametrize(("step_deg", "side", "why"), [(2.0, 13, "even"), (4.0, 6, "even"), (1.0, 40, "tabulated")])
def test_nodes_farther_apart_or_beyond_the_table_are_refused(step_deg: float, side: int, why: str) -> None:
    """A power of two of degrees is a whole number of steps, too; beyond its end a table is read from other memory."""
    bias = np.radians(step_deg) * np.arange(-side, side + 1)
    some = nodes(ErrorPrior(), SIGMA, 4, even=True)
    grid = replace(some, bias=bias, bias_weight=np.full(len(bias), 1.0 / len(bias)), spacing=math.radians(step_deg))
    with pytest.raises(ValueError, match=why):
        compiled_evidence.Weigher(sightings([]), grid, [stretch()])


@pytest.mark.parametrize(
    ("sigma_deg", "bearings", "spacing"), [(30.0, 1, 1.0), (6.0, 12, 1.0), (6.0, 60, 0.5), (2.0, 30, 0.25)]
)
def test_even_nodes_are_as_fine_as_the_bearings_ask_for(sigma_deg: float, bearings: int, spacing: float) -> None:
    even, free = (nodes(ErrorPrior(), math.radians(sigma_deg), bearings, even=one) for one in (True, False))
    assert math.degrees(even.spacing) == pytest.approx(spacing)
    assert even.spacing <= free.spacing + 1e-12


@pytest.mark.parametrize("halvings", [1, 2])
@pytest.mark.parametrize("least", [1.0, 1e-45, 1e-250])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 30, 31, 32, 33])
def test_what_is_weighed_at_even_steps_is_spread_out_evenly_however_small_it_is(
    count: int, least: float, halvings: int
) -> None:
    """Fifteen stretches that a place contradicts leave all of its nodes below the numbers of 32 bits."""
    log = np.log(least) + np.sin(np.arange(((count - 1) >> halvings) + 2))
    row = np.ones(count)
    _spread_out(row, np.exp(log), np.empty(len(log) - 1, dtype=np.float32), halvings)
    assert np.log(row) == pytest.approx(np.interp(np.arange(count) / 2**halvings, np.arange(len(log)), log), abs=1e-5)


def test_the_middle_of_a_stretch_lies_along_it() -> None:
    middle = middle_of(stretch(along_deg=50.0))
    assert abs(middle.along[0] * math.sin(math.radians(50.0)) - middle.along[1] * math.cos(math.radians(50.0))) < 1e-9
    assert middle.reach == pytest.approx(10.0, abs=0.1)


def test_readings_that_no_craft_took_leave_numbers() -> None:
    """An imported file may hold any: far apart, all in one place, as loud as no transmitter."""
    one = stretch()
    wild = [
        replace(one, x=tuple(36.0 * k for k in range(14)), y=(0.0,) * 14),
        replace(one, x=(0.0,) * 14, y=(0.0,) * 14),
        replace(one, power_db=tuple(1e9 * math.sin(k) for k in range(14))),
        replace(one, gain_db=tuple(-1e4 * (k % 2) for k in range(36))),
    ]
    x, y = np.meshgrid(np.linspace(-500.0, 500.0, 41), np.linspace(-500.0, 500.0, 41))
    grid = nodes(ErrorPrior(), SIGMA, 4, even=True)
    for some in wild:
        found = compiled_evidence.evidence(x.ravel(), y.ravel(), sightings([]), grid, [some] * 20)
        assert all(np.isfinite(part).all() for part in found)


def test_a_table_is_made_once_for_all_beliefs(monkeypatch: pytest.MonkeyPatch) -> None:
    scale = (0.7, 1.0, 1.45)
    first = table_of(stretch(seed=11), scale)
    monkeypatch.setattr(compiled_way_tables, "_tabulate", None)
    assert table_of(stretch(seed=11), scale) is first


def test_more_tables_than_are_kept_leave_most_of_them_to_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Stretch] = []
    monkeypatch.setattr(compiled_way_tables, "_kept", {})
    monkeypatch.setattr(compiled_way_tables, "KEPT", 20)
    monkeypatch.setattr(compiled_way_tables, "_tabulated", lambda one, scale: made.append(one) or np.zeros(1))
    mission = [stretch(seed=k) for k in range(22)]
    for _ in range(10):
        for one in mission:
            table_of(one, (1.0,))
    assert len(compiled_way_tables._kept) == 20
    assert 22 < len(made) < 110
