"""Where stretches of way make cells dear, half as many across the belief say the same."""

from __future__ import annotations

import numpy as np
import pytest

from planner.belief import joint
from planner.belief.joint import JointBelief
from tests.planner.belief.test_still_possible import around, believed


def spread(belief: JointBelief) -> tuple[float, float, float]:
    """Mean place and its root mean square, m."""
    x, y = np.meshgrid(*belief.centres())
    at_x, at_y = float((belief.density * x).sum()), float((belief.density * y).sum())
    return at_x, at_y, float(np.sqrt((belief.density * ((x - at_x) ** 2 + (y - at_y) ** 2)).sum()))


@pytest.mark.parametrize("errors_deg", [(6.0, 7.0, 4.0, 8.0, 6.0, 5.0), (1.0, -60.0, 2.0, -1.0, 140.0, 0.0, -2.0, 1.0)])
def test_half_as_fine_cells_say_the_same(errors_deg: tuple[float, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    _, dear = believed(around(errors_deg))
    monkeypatch.setattr(joint, "FEWEST_DEAR_CELLS", joint.COARSE_CELLS)
    _, fine = believed(around(errors_deg))
    assert dear.h == 2.0 * fine.h
    (x, y, rms), (fine_x, fine_y, fine_rms) = spread(dear), spread(fine)
    assert np.hypot(x - fine_x, y - fine_y) < 0.005 * fine_rms
    assert rms == pytest.approx(fine_rms, rel=0.005)
