"""Antenna patterns from files: what is written is read again, what cannot be used is named with its reason."""

from __future__ import annotations

import numpy as np
import pytest
from refusals import refusing

from hardware.direction_finding.pattern_file import SMALL_YAGI, PatternError, load_pattern, parse_pattern, save_pattern
from hardware.reasons.pattern import (
    ImplausibleGains,
    NotAPattern,
    PatternGap,
    PatternOfOtherFrequency,
    PatternRowUnusable,
    PatternUnitUnknown,
    TooFewPoints,
)
from hardware.reasons.table import FileUnreadable, TooManyCells

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
    with refusing(NotAPattern("mine.json", "json"), PatternError):
        parse_pattern("mine.json", TURNTABLE)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("[" * 100_000, "json"),
        ("9" * 5000, "json"),
        ("[]", "format"),
        ('{"format": "crossfix antenna pattern", "unit": "dB", "gain": [1]}', "relative_bearing_deg"),
        (
            '{"format": "crossfix antenna pattern", "unit": "dB", "relative_bearing_deg": [0], "gain": [1'
            + "0" * 400
            + "]}",
            "numbers",
        ),
    ],
)
def test_what_is_no_pattern_is_named(text, why):
    with refusing(NotAPattern("mine.json", why), PatternError):
        parse_pattern("mine.json", text)


def test_a_gain_beyond_belief_is_refused():
    with refusing(ImplausibleGains("mine", "large", 200.0), PatternError):
        parse_pattern("mine.csv", TURNTABLE.replace("30, -1.5", "30, 1e300"))


def test_a_pattern_holds_around_its_frequency_only():
    yagi = load_pattern(SMALL_YAGI)
    assert yagi.other_frequency(868_300_000.0) is yagi.other_frequency(900_000_000.0) is None
    assert yagi.other_frequency(150e6) == PatternOfOtherFrequency(yagi.name, 868_300_000.0, 150e6)
    assert parse_pattern("mine.csv", TURNTABLE).other_frequency(150e6) is None


@pytest.mark.parametrize("separator", [";", "\t", " ", '","'])
@pytest.mark.parametrize("heading", ["", "Winkel;Gewinn\n", "angle gain\n"])
def test_decimal_commas_are_read_where_no_comma_separates(separator, heading):
    gains = [-4.4 - 0.3 * k for k in range(12)]
    quote = '"' if "," in separator else ""
    german = [f"{30 * k},0{separator}{gain:.1f}".replace(".", ",") for k, gain in enumerate(gains)]
    pattern = parse_pattern("mine.csv", heading + "\n".join(f"{quote}{row}{quote}" for row in german))
    np.testing.assert_allclose(pattern.relative_bearing_deg, np.arange(0.0, 360.0, 30.0))
    np.testing.assert_allclose(pattern.gain_db, gains)


@pytest.mark.parametrize(
    ("rows", "line", "cells"),
    [
        ("angle_deg,gain_db\n0,0,-4,4\n30,0,-5,1\n", 2, 4),
        ("angle_deg,gain_db\n0,-4.4\n30,-5,1\n", 3, 3),
        ("0,0,-4,4\n30,0,-5,1\n60,-5,1\n", 1, 4),
        ("0,-4,4\n30,-5,1\n", 1, 3),
    ],
)
def test_decimal_commas_between_commas_are_not_cut_off(rows, line, cells):
    with refusing(TooManyCells("mine.csv", line, cells, 2), PatternError):
        parse_pattern("mine.csv", rows)


@pytest.mark.parametrize("header", ["Winkel (Grad), Gewinn (dB)", "angle_deg, V-pol gain (dB)", "Yagi, 10 mW at 30 m"])
def test_headers_of_degrees_and_decibels_in_any_words_are_read(header: str) -> None:
    assert parse_pattern("mine.csv", TURNTABLE.replace("angle_deg, gain_db", header)).gain_db[3] == -4.5


def test_columns_beside_angle_and_gain_are_not_read():
    more = (
        TURNTABLE.replace("gain_db", "gain_db, phase_deg").replace("\n", ", 12\n").replace("phase_deg, 12", "phase_deg")
    )
    assert parse_pattern("mine.csv", more).gain_db[3] == -4.5
    assert parse_pattern("mine.csv", TURNTABLE.replace("-1.5", "-1.5, twice")).gain_db[3] == -4.5
    blanks = TURNTABLE.replace(",", "").replace("-1.5", "-1.5 twice")
    assert parse_pattern("mine.csv", blanks).gain_db[1] == -1.5


@pytest.mark.parametrize(
    ("rows", "reason"),
    [
        ("0, x\n10, 2\n", PatternRowUnusable("mine.csv", 1, "0, x")),
        ("angle_deg, gain_db\n", NotAPattern("mine.csv", "rows")),
        ("0, 1\n10, 2\n", TooFewPoints("mine", 2, 8)),
        ("0, 1\n10, x\n", PatternRowUnusable("mine.csv", 2, "10, x")),
        ("0, 1\n10, nan\n" + TURNTABLE[19:], NotAPattern("mine", "numbers")),
        ("inf, 1\n10, 1\n", NotAPattern("mine", "numbers")),
        ("angle_gon, gain_db\n0, 1\n", NotAPattern("mine.csv", "rows")),
        ("angle_deg, gain_linear\n0, 1\n", PatternUnitUnknown("mine.csv", "gain_linear")),
        ("angle_deg, Attenuation (dB)\n0, 1\n", PatternUnitUnknown("mine.csv", "Attenuation (dB)")),
        ("\n".join(f"{a}, {a / 20}" for a in range(0, 280, 30)), PatternGap("mine", 90.0, 270.0, 60.0)),
    ],
)
def test_a_table_that_cannot_be_used_says_why(rows, reason):
    with refusing(reason, PatternError):
        parse_pattern("mine.csv", rows)


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    with refusing(FileUnreadable(str(tmp_path / "gone.json"), "No such file or directory"), PatternError):
        load_pattern(tmp_path / "gone.json")
