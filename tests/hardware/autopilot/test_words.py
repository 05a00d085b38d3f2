from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hardware.autopilot.words import MOST_CHARACTERS, sanitized


def test_what_is_no_print_is_made_harmless() -> None:
    assert sanitized("Preflight Fail:\tno GPS\r\n") == "Preflight Fail: no GPS"
    assert sanitized("\x1b[31mred\x07\u202egnp.exe") == "[31mred gnp.exe"
    assert sanitized("cut\x00 here") == "cut"
    assert sanitized("ä°C 🚁") == "ä°C 🚁"
    assert sanitized("lone \udc80 half") == "lone \ufffd half"


@given(st.text(alphabet=st.characters(codec=None), max_size=2_000))
def test_any_text_becomes_one_line_that_can_be_stored(text: str) -> None:
    line = sanitized(text)
    assert len(line) <= MOST_CHARACTERS
    assert line == " ".join(line.split())
    assert line.isprintable() or line == "" or all(c.isprintable() for c in line)
    line.encode()
