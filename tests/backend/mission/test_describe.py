from __future__ import annotations

import pytest
from missions import PHASES, walk_in

from backend.mission.describe import doing, waits_for


@pytest.mark.parametrize("phase", PHASES)
def test_every_phase_is_said_in_words(phase: str) -> None:
    state = walk_in(phase).state
    assert doing(state)
    assert "_" not in doing(state)


def test_only_what_needs_a_person_waits() -> None:
    waiting = {phase for phase in PHASES if waits_for(walk_in(phase).state) is not None}
    assert waiting == {"draft", "ready", "waiting", "hold", "manual"}
