from __future__ import annotations

from pathlib import Path

import pytest

from backend.settings import Settings
from backend.wiring import open_simulation
from hardware.direction_finding.pattern_file import PatternError
from hardware.ports import ReceiverError
from hardware.reasons.payload import PayloadTokensMissing
from hardware.reasons.receiver import ReceiverMisnamed
from hardware.reasons.table import FileUnreadable
from planner.reason import Reason, ReasonedError


@pytest.mark.parametrize(
    ("given_settings", "error", "reason"),
    [
        ({"receiver": "nonsense", "vehicle_url": "udpin://127.0.0.1:1"}, ReceiverError, ReceiverMisnamed),
        ({"receiver": "payload", "vehicle_url": "udpin://127.0.0.1:1"}, ReceiverError, PayloadTokensMissing),
        ({"antenna_pattern": "/nowhere/pattern.json"}, PatternError, FileUnreadable),
    ],
)
async def test_settings_that_name_nothing_are_refused_with_a_reason(
    tmp_path: Path, given_settings: dict[str, str], error: type[ReasonedError], reason: type[Reason]
) -> None:
    with pytest.raises(error) as refused:
        async with open_simulation(Settings(data_dir=tmp_path, **given_settings)):  # type: ignore[arg-type]
            pass
    assert isinstance(refused.value.reason, reason)


async def test_an_address_of_no_vehicle_is_refused_with_the_forms_there_are(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="udpin://"):
        async with open_simulation(Settings(data_dir=tmp_path, vehicle_url="nonsense")):
            pass
