from __future__ import annotations

import pytest

from hardware.autopilot.mode_switch import GIVEN_BACK_S, SETTLED_S, ModeSwitch


def switch_at(channel: int | None, *pulses_us: int) -> ModeSwitch:
    """The pulses of channel 5 came a fifth of a second apart from 10 s on."""
    switch = ModeSwitch()
    switch.channel = channel
    for number, pulse_us in enumerate(pulses_us):
        switch.see({"chan5_raw": pulse_us}, 10.0 + 0.2 * number)
    return switch


def test_a_movement_is_told_once_when_it_has_settled() -> None:
    switch = switch_at(5, 1165, 1170, 1815, 1812)

    assert not switch.take_moved(10.4 + 0.9 * SETTLED_S)
    assert switch.take_moved(10.4 + SETTLED_S)
    assert not switch.take_moved(20.0)


@pytest.mark.parametrize("pulses_us", [(1165, 1200, 1140, 1165), (1165, 0, 65535, 1165), (0, 0, 1815)])
def test_noise_and_a_transmitter_that_is_not_heard_are_no_movement(pulses_us: tuple[int, ...]) -> None:
    assert not switch_at(5, *pulses_us).take_moved(20.0)


def test_without_its_channel_nothing_is_known() -> None:
    assert not switch_at(None, 1165, 1815).take_moved(20.0)


def test_the_way_back_to_the_autopilots_mode_takes_nothing() -> None:
    switch = switch_at(5, 1165, 1815)
    switch.taken_back(10.3)
    switch.see({"chan5_raw": 1165}, 10.4)
    assert not switch.take_moved(20.0)

    switch.see({"chan5_raw": 1815}, 10.4 + GIVEN_BACK_S)
    assert switch.take_moved(20.0)
