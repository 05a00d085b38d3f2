"""Samples that get lost are told once, and again after worse trouble."""

from __future__ import annotations

from backend.craft import inputs
from backend.craft.watch.losses import LossWatch
from hardware.reasons.receiver import ReceiverUnplugged, SamplesLost


def test_losses_are_told_once_and_again_after_worse_trouble() -> None:
    watch = LossWatch()
    assert watch.look(4.0, None) == []
    assert watch.look(20.0, None) == [inputs.ReceiverLoses(SamplesLost(20.0))]
    assert watch.look(30.0, None) == []
    assert watch.look(3.0, None) == [], "not told to and fro"
    assert watch.look(0.0, ReceiverUnplugged()) == [], "that is what is told then"
    assert watch.look(30.0, None) == [inputs.ReceiverLoses(SamplesLost(30.0))]
    assert watch.look(1.0, None) == [inputs.ReceiverKeepsUp()]
    assert watch.look(0.0, None) == []
