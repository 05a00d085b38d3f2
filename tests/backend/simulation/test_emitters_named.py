"""The simulated world as somebody writes it on the command line."""

import pytest

from backend.simulation.emitters import EMITTERS, SimulatedEmitter, read_emitter, world_of


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("150.1", SimulatedEmitter(150_100_000.0)),
        (" 150.1 ", SimulatedEmitter(150_100_000.0)),
        ("150.1/1.5", SimulatedEmitter(150_100_000.0, 1.5)),
        ("150.1/1.5,animal:0.2", SimulatedEmitter(150_100_000.0, 1.5, "animal", 0.2)),
        ("433.92,drifting:1", SimulatedEmitter(433_920_000.0, None, "drifting", 1.0)),
    ],
)
def test_an_emitter_is_read(text: str, wanted: SimulatedEmitter) -> None:
    assert read_emitter(text) == wanted


@pytest.mark.parametrize(
    "text",
    ["", "x", "150.1/", "150.1/x", "-150", "0", "nan", "inf", "1e7", "150.1,", "150.1,running:1", "150.1,animal",
     "150.1,animal:-1", "150.1/0", "150.1,animal:nan", "0.0000001", "150.1/1e-9", "150.1,animal:1e9"],
)  # fmt: skip
def test_what_is_no_emitter_is_refused_with_the_form(text: str) -> None:
    with pytest.raises(ValueError, match="MHZ"):
        read_emitter(text)


def test_the_presets_emitters_stay_but_for_those_named_otherwise() -> None:
    assert world_of(()) == EMITTERS
    moving = world_of(("150.0/1.0,animal:0.2", "150.1"))
    assert len(moving) == len(EMITTERS) + 1
    assert [one.gait for one in moving if one.frequency_hz == 150e6] == ["animal"]


def test_one_frequency_named_twice_is_refused() -> None:
    with pytest.raises(ValueError, match="one frequency"):
        world_of(("150.1", "150.1/1.0"))
