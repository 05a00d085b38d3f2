"""What names a failsafe: the words of PX4 1.16 and ArduCopter 4.7, as heard from them."""

from __future__ import annotations

import pytest

from hardware.authority import FailsafeCause
from hardware.autopilot.ardupilot import ARDUPILOT
from hardware.autopilot.failsafe_names import ANNOUNCED_S, FailsafeNames
from hardware.autopilot.px4 import PX4

ENTER, ENTER_HOLD, ENTER_GENERIC, HOLD_GENERIC, DISENGAGED = 0x94CA8A, 0xD11DF6, 0xDEDBD0, 0x44B3E0, 0xC2DC72
MODE = (0, 0, 4, 3)


def event(names: FailsafeNames, number: int, *arguments: int, at_s: float = 100.0) -> FailsafeCause | None:
    padded = [*MODE, *arguments, *(0,) * 40][:40]
    return names.event(PX4.failsafe_words, {"id": 1 << 24 | number, "arguments": padded}, at_s)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("Battery Failsafe", "battery"),
        ("Radio Failsafe", "transmitter"),
        ("GCS Failsafe", "silence"),
        ("EKF Failsafe: changed to LAND Mode", "position"),
        ("Dead Reckoning started", "position"),
        ("Failsafe: Terrain data missing", "other"),
        ("Circle fence breached", "fence"),
        ("Max Alt and Polygon fences breached", "fence"),
        ("Battery Failsafe - Continuing Landing", None),
        ("Radio Failsafe - Continuing Guided Mode", None),
        ("Radio Failsafe Cleared", None),
        ("EKF Failsafe Cleared", None),
        ("EKF Failsafe", None),
        ("Battery 1 is low 8.60V used 427 mAh", None),
        ("Polygon fence in 1.9m", None),
        ("Failsafe activated", None),
        ("", None),
    ],
)
def test_arducopters_texts(text: str, cause: FailsafeCause | None) -> None:
    assert FailsafeNames().text(ARDUPILOT.failsafe_words, text, 100.0) == cause


def test_px4_announces_with_an_event_and_acts_with_a_text_and_an_event() -> None:
    names = FailsafeNames()
    assert event(names, ENTER_HOLD, 6, 5, 0, 1) is None
    assert names.text(PX4.failsafe_words, "Failsafe activated: entering Hold for 5 seconds\t", 100.1) is None
    assert names.text(PX4.failsafe_words, "Failsafe activated\t", 105.0) == "transmitter"
    assert event(names, ENTER, 6, 1, at_s=105.1) == "transmitter"


def test_px4s_word_for_an_act_says_nothing_where_it_only_warned() -> None:
    names = FailsafeNames()
    assert names.text(PX4.failsafe_words, "Low battery\t", 100.0) is None
    assert names.text(PX4.failsafe_words, "Failsafe activated\t", 100.1) is None
    event(names, ENTER_HOLD, 6, 5, 0, 4)
    assert names.text(PX4.failsafe_words, "Failsafe activated\t", 100.0 + ANNOUNCED_S) is None


def test_px4_names_the_fence_the_battery_and_the_place_by_what_it_says_beside() -> None:
    names = FailsafeNames()
    names.text(PX4.failsafe_words, "Geofence violation: exceeding maximum distance to ", 100.0)
    event(names, HOLD_GENERIC, 6, 5, 0)
    assert names.text(PX4.failsafe_words, "Failsafe activated\t", 105.0) == "fence"
    assert event(names, ENTER_GENERIC, 6, at_s=105.0) == "fence"
    assert event(names, ENTER_GENERIC, 6, at_s=100.0 + ANNOUNCED_S) == "other"
    assert event(names, DISENGAGED, 8) == "position"
    names.text(PX4.failsafe_words, "Critical battery\t", 100.0)
    assert event(names, ENTER_GENERIC, 7) == "battery"


@pytest.mark.parametrize(("number", "arguments"), [(ENTER, (5, 1)), (DISENGAGED, (3,)), (0x1D3727, (6, 1))])
def test_px4s_other_events_name_nothing(number: int, arguments: tuple[int, ...]) -> None:
    """A failsafe that holds, one that flies on without a position, health reports."""
    assert event(FailsafeNames(), number, *arguments) is None
