"""A clock's rate counts as odd only when it stays so."""

from __future__ import annotations

from hardware.autopilot.boot_clock import ODD_LOOKS, LastingOddity


def test_a_clock_that_catches_up_for_some_seconds_is_not_odd() -> None:
    oddity = LastingOddity()
    for _ in range(5):
        assert not any(oddity.look(True) for _ in range(ODD_LOOKS - 1))
        assert not oddity.look(False)


def test_a_clock_that_stays_odd_is_and_agrees_again_at_once() -> None:
    oddity = LastingOddity()
    found = [oddity.look(True) for _ in range(2 * ODD_LOOKS)]
    assert found == [False] * (ODD_LOOKS - 1) + [True] * (ODD_LOOKS + 1)
    assert not oddity.look(False)
