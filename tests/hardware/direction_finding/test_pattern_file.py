"""Antenna patterns from files: what is written is read again, what cannot be used is named with its reason."""

from __future__ import annotations

import numpy as np
import pytest

from hardware.direction_finding.pattern_file import SMALL_YAGI, PatternError, load_pattern, parse_pattern, save_pattern

TURNTABLE = "angle_deg, gain_db\n" + "\n".join(f"{a}, {-a / 20}" for a in range(0, 360, 30))


def test_a_saved_pattern_is_read_again(tmp_path):
    yagi = load_pattern(SMALL_YAGI)
    save_pattern(yagi, tmp_path / "yagi.json")
    again = load_pattern(tmp_path / "yagi.json")
    np.testing.assert_allclose(again.gain_db, yagi.gain_db, atol=1e-3)
    assert (again.name, again.frequency_hz) == (yagi.name, yagi.frequency_hz)


def test_a_table_is_known_by_its_name():
    pattern = parse_pattern("mine.csv", TURNTABLE)
    assert (pattern.name, pattern.gain_db[3]) == ("mine", -4.5)
    with pytest.raises(PatternError, match=r"mine.json: is not JSON .* must end in .csv"):
        parse_pattern("mine.json", TURNTABLE)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[" * 100_000, "is not JSON"),
        ("9" * 5000, "is not JSON"),
        ("[]", "is no antenna pattern"),
        ('{"format": "crossfix antenna pattern", "unit": "dB", "gain": [1]}', '"relative_bearing_deg" is missing'),
        (
            '{"format": "crossfix antenna pattern", "unit": "dB", "relative_bearing_deg": [0], "gain": [1'
            + "0" * 400
            + "]}",
            "must be numbers",
        ),
    ],
)
def test_what_is_no_pattern_is_named(text, reason):
    with pytest.raises(PatternError, match=reason):
        parse_pattern("mine.json", text)


def test_a_gain_beyond_belief_is_refused():
    with pytest.raises(PatternError, match="in another unit"):
        parse_pattern("mine.csv", TURNTABLE.replace("30, -1.5", "30, 1e300"))


def test_a_pattern_holds_around_its_frequency_only():
    yagi = load_pattern(SMALL_YAGI)
    assert yagi.other_frequency(868_300_000.0) == yagi.other_frequency(900_000_000.0) == ""
    assert yagi.other_frequency(150_000_000.0).endswith("was measured at 868.3 MHz, not 150.0 MHz")
    assert parse_pattern("mine.csv", TURNTABLE).other_frequency(150_000_000.0) == ""
