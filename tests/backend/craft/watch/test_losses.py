"""Lost samples are reported once, and again when it gets worse."""

from __future__ import annotations

from backend.craft import inputs
from backend.craft.watch.losses import CALM_S, LossWatch
from hardware.reasons.receiver import ReceiverUnplugged, SamplesLost


def test_losses_are_told_once_and_again_after_worse_trouble() -> None:
    watch = LossWatch()
    assert watch.look(4.0, None, 0.0) == []
    assert watch.look(20.0, None, 1.0) == [inputs.ReceiverLoses(SamplesLost(20.0))]
    assert watch.look(30.0, None, 2.0) == []
    assert watch.look(3.0, None, 90.0) == [], "not told to and fro"
    assert watch.look(0.0, ReceiverUnplugged(), 91.0) == [], "that is what the pilot hears then"
    assert watch.look(30.0, None, 92.0) == [inputs.ReceiverLoses(SamplesLost(30.0))]
    assert watch.look(1.0, None, 93.0) == []
    assert watch.look(1.0, None, 93.0 + CALM_S) == [inputs.ReceiverKeepsUp()]
    assert watch.look(0.0, None, 200.0) == []


def test_a_receiver_that_begins_to_count_anew_has_not_caught_up() -> None:
    """As whenever it is opened for the next of several groups of channels."""
    watch, found = LossWatch(), list[inputs.CraftInput]()
    for tick in range(1500):
        at_s = 0.2 * tick
        counted_s = at_s % 15.0
        found += watch.look(8.0 if counted_s > 3.0 else 0.0, None, at_s)
    assert found == [inputs.ReceiverLoses(SamplesLost(8.0))]
