"""The shapes that a turn is compared with: fields add, priors sum to one, looking down widens the lobe."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hardware.direction_finding.alternatives import (
    ECHO_APART_DEG,
    ECHO_LEVELS_DB,
    ECHO_PHASES_DEG,
    PRIOR,
    Alternatives,
)
from hardware.direction_finding.comparison import beam, known_right
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from tests.benchmarks.pattern_mismatch import deformed

BEAM = beam(60.0)
SHAPES = Alternatives.of(BEAM)
X = np.arange(0.0, 360.0, 2.0)


def test_priors_sum_to_one_by_kind() -> None:
    for kind, share in enumerate(PRIOR):
        assert np.exp(SHAPES.log_prior[SHAPES.kind == kind]).sum() == pytest.approx(share)
    assert sum(PRIOR) == pytest.approx(1.0)


def test_first_shape_is_the_pattern() -> None:
    assert SHAPES.kind[0] == 0
    assert np.allclose(10.0 * np.log10(SHAPES.power[0]), BEAM.gain_at(X))


def test_an_echo_adds_its_field() -> None:
    phase, level, apart = math.radians(ECHO_PHASES_DEG[1]), ECHO_LEVELS_DB[3], 5 * ECHO_APART_DEG
    fields = 10.0 ** (BEAM.gain_at(X) / 20.0) + 10.0 ** (level / 20.0) * np.exp(1j * phase) * 10.0 ** (
        BEAM.gain_at(X + apart) / 20.0
    )
    nearest = np.min(np.max(np.abs(SHAPES.power[SHAPES.kind == 1] - np.abs(fields) ** 2), axis=1))
    assert nearest < 1e-9


def test_looking_down_widens_the_lobe_and_keeps_its_sides() -> None:
    below = SHAPES.power[SHAPES.kind == 2]
    width = (below > 0.5 * below.max(axis=1, keepdims=True)).sum(axis=1)
    assert (np.diff(width) > 0).all()
    assert width[1] > (SHAPES.power[0] > 0.5).sum()
    assert np.allclose(below[:, 1:], below[:, :0:-1])


@pytest.mark.parametrize("left", [0.7, 0.9])
def test_an_unchecked_lobe_may_have_uneven_flanks(left: float) -> None:
    bent = deformed(60.0, left=left, right=2.0 - left).gain_at(X)
    waves = 10.0 * np.log10(SHAPES.power[SHAPES.kind == 0])
    assert np.min(np.max(np.abs(waves - bent), axis=1)) < 0.1


def test_a_checked_pattern_is_as_it_was_measured() -> None:
    assert (Alternatives.of(known_right(BEAM)).kind == 0).sum() == 1


def test_a_bent_lobe_goes_on_around_the_back_of_any_pattern() -> None:
    """Between two places 2 degrees apart its gain changes hardly more than the measured pattern's does anywhere."""
    shapes = Alternatives.of(load_pattern(SMALL_YAGI))
    waves = 10.0 * np.log10(shapes.power[shapes.kind == 0])
    steps = np.max(np.abs(waves - np.roll(waves, 1, axis=1)), axis=1)
    assert (steps < 2.5 * steps[0]).all()
