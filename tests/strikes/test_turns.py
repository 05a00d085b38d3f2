"""Each row of the pairs says itself how it turns and listens, whatever the suggestion for new missions is."""

from __future__ import annotations

import pytest

from backend.api.suggestion import SENSOR
from backend.spec import SensorSpec
from tests.strikes.turns import BESIDE, STILL


def flown(said: dict[str, bool]) -> SensorSpec:
    """Merged into the suggestion, as a mission is drafted."""
    return SENSOR.model_copy(update=said)


@pytest.mark.parametrize(
    ("said", "sectors", "swings"),
    [
        (STILL, False, False),
        (BESIDE["sectors"][2], True, False),
        (BESIDE["swings"][2], False, True),
        (BESIDE["new"][2], True, True),
    ],
)
def test_a_row_flies_what_it_is_called(said: dict[str, bool], sectors: bool, swings: bool) -> None:
    sensor = flown(said)

    assert sensor.turns_in_sectors is sectors
    assert (sensor.listen_on_the_way, sensor.swing_on_the_way) == (swings, swings)
    assert not sensor.never_stop


def test_new_is_what_new_missions_fly() -> None:
    assert flown(BESIDE["new"][2]) == SENSOR
