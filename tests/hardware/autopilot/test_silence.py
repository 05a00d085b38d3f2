from __future__ import annotations

import pytest

from hardware.autopilot.silence import Silence


def test_silence_is_what_was_looked_for_in_vain_and_a_program_that_stood_still_heard_nothing_wrong() -> None:
    silence = Silence()
    for _ in range(20):
        silence.look(0.1)
    assert silence.seconds == pytest.approx(2.0)
    silence.look(60.0)
    assert silence.seconds == pytest.approx(2.5)
    silence.heard()
    assert silence.seconds == 0.0
    silence.look(-1.0)
    assert silence.seconds == 0.0
