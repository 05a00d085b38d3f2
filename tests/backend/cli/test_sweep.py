"""`crossfix sweep` at its edge: one JSON value on stdout, one clear line and exit code 2 for bad input."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from backend.cli.sweep import sweep
from hardware.direction_finding.heading import declination_deg
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.readings import Place
from hardware.sdr.sigmf_file import Azimuth, write_sigmf

APP = typer.Typer()
APP.command()(sweep)


def recording(tmp_path: Path, bearing_deg: float, rotations: int = 1) -> Path:
    pattern = load_pattern(SMALL_YAGI)
    lines = []
    for k in range(rotations):
        lines.append("10,50.1,7.2,300")
        for heading in np.arange(0.0, 360.0, 5.0):
            snr = 60.0 + pattern.gain_at(np.array([bearing_deg + 30.0 * k - heading]))[0]
            lines.append(f"7,3,148e6,1,2,{snr},1,1,1,50,1.0,1,1,50.1,7.2,8,0,0,{heading},0,0")
        lines.append("11,50.1,7.2,300")
    path = tmp_path / "rotation.csv"
    path.write_text("\n".join(lines))
    return path


def test_one_rotation_prints_one_object(tmp_path: Path) -> None:
    result = CliRunner().invoke(APP, [str(recording(tmp_path, 120.0)), "--json"])
    answer = json.loads(result.stdout)
    assert result.exit_code == 0
    assert answer["bearing_deg"] == pytest.approx(120.0, abs=0.3)
    assert answer["sigma_deg"] > 0
    assert answer["quality"] > 0.95
    assert (answer["tag"], answer["lat"], answer["lon"]) == ("3", 50.1, 7.2)


def test_several_rotations_print_one_array(tmp_path: Path) -> None:
    answers = json.loads(CliRunner().invoke(APP, [str(recording(tmp_path, 120.0, rotations=3)), "--json"]).stdout)
    assert [answer["bearing_deg"] for answer in answers] == pytest.approx([120.0, 150.0, 180.0], abs=0.3)


def test_offset_option_turns_the_answer_and_text_is_a_sentence(tmp_path: Path) -> None:
    result = CliRunner().invoke(APP, [str(recording(tmp_path, 120.0)), "--offset", "-20"])
    assert "bearing 100.0" in result.stdout


def test_magnetic_headings_are_made_true_where_and_when_they_were_taken(tmp_path: Path) -> None:
    file = recording(tmp_path, 120.0)
    result = CliRunner().invoke(APP, [str(file), "--magnetic", "2026-05-01", "--json"])
    east = declination_deg(Place(50.1, 7.2), datetime(2026, 5, 1, tzinfo=UTC).timestamp())
    assert 2.0 < east < 5.0
    assert json.loads(result.stdout)["bearing_deg"] == pytest.approx(120.0 + east, abs=0.3)

    nowhere = tmp_path / "nowhere.csv"
    nowhere.write_text("\n".join(f"{heading},-60" for heading in range(0, 360, 5)))
    for arguments, said in (
        ([str(nowhere), "--magnetic", "2026-05-01"], "--at"),
        ([str(file), "--magnetic", "1999-05-01"], "1999"),
    ):
        refused = CliRunner().invoke(APP, arguments)
        assert refused.exit_code == 2
        assert said in refused.stderr
        assert len(refused.stderr.splitlines()) == 1


def test_plain_csv_takes_its_place_from_the_option(tmp_path: Path) -> None:
    pattern = load_pattern(SMALL_YAGI)
    heading = np.arange(0.0, 360.0, 5.0)
    path = tmp_path / "plain.csv"
    path.write_text("\n".join(f"{h},{p}" for h, p in zip(heading, pattern.gain_at(33.0 - heading), strict=True)))
    unknown = json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout)
    known = json.loads(CliRunner().invoke(APP, [str(path), "--json", "--at", "50.5,7.5"]).stdout)
    assert (unknown["lat"], unknown["lon"]) == (None, None)
    assert (known["lat"], known["lon"]) == (50.5, 7.5)
    assert known["bearing_deg"] == pytest.approx(33.0, abs=0.3)


def test_a_plain_table_of_several_turns_and_tags_prints_an_array_of_the_tag_that_is_named(tmp_path: Path) -> None:
    pattern = load_pattern(SMALL_YAGI)
    heading = np.arange(0.0, 360.0, 5.0)
    rows = [
        f"{turn},{tag},{h},{power}"
        for turn, tag, bearing in ((1, "A", 33.0), (1, "B", 80.0), (2, "A", 200.0), (2, "B", 290.0))
        for h, power in zip(heading, pattern.gain_at(bearing - heading) - 60.0, strict=True)
    ]
    path = tmp_path / "plain.csv"
    path.write_text("\n".join(["sweep,tag,Heading (deg),Power (dBm)", *rows]))
    answers = json.loads(CliRunner().invoke(APP, [str(path), "--tag", "B", "--json"]).stdout)
    assert [(answer["tag"], answer["samples"]) for answer in answers] == [("B", 72), ("B", 72)]
    assert [answer["bearing_deg"] for answer in answers] == pytest.approx([80.0, 290.0], abs=0.3)
    refused = CliRunner().invoke(APP, [str(path), "--tag", "C", "--json"])
    assert refused.exit_code == 2
    assert "Tag C was not heard" in refused.stderr
    assert "A, B" in refused.stderr


def test_a_turn_heard_in_part_may_have_been_a_whole_one_of_which_only_strong_pulses_were_heard(tmp_path: Path) -> None:
    path = tmp_path / "plain.csv"
    path.write_text("\n".join(f"{heading},{-60 - abs(heading - 50) / 10}" for heading in range(0, 91, 5)))
    answer = json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout)
    assert not answer["accepted"]
    assert "only 90 degrees of the turn" in answer["reason"]
    assert "or nearer to the emitter" in answer["reason"]


@pytest.mark.parametrize("first_deg", [0.0, 100.0, 215.0])
def test_a_turn_of_270_degrees_gives_the_bearing_wherever_the_gap_lies(tmp_path: Path, first_deg: float) -> None:
    """Within two of its sigmas, and into the gap no sharper than outside it."""
    pattern = load_pattern(SMALL_YAGI)
    heading = (first_deg + np.arange(0.0, 271.0, 5.0)) % 360.0
    sigmas: dict[bool, list[float]] = {True: [], False: []}
    for bearing in np.arange(10.0, 360.0, 50.0):
        path = tmp_path / "turn.csv"
        rows = zip(heading, pattern.gain_at(bearing - heading), strict=True)
        path.write_text("\n".join(f"{h},{p}" for h, p in rows))
        answer = json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout)
        off = (answer["bearing_deg"] - bearing + 180.0) % 360.0 - 180.0
        assert answer["accepted"], answer["reason"]
        assert abs(off) < 2.0 * answer["sigma_deg"]
        sigmas[bool((bearing - first_deg) % 360.0 > 270.0)].append(answer["sigma_deg"])
    assert min(sigmas[True]) >= min(sigmas[False])


@pytest.mark.parametrize(
    "arguments",
    [
        ["missing.csv"],
        ["bad.csv"],
        ["good.csv", "--pattern", "missing.json"],
        ["good.csv", "--pattern", "bad.csv"],
        ["good.csv", "--at", "somewhere"],
        ["good.csv", "--tag", "99"],
    ],
)
def test_bad_input_is_one_line_on_stderr_and_exit_code_2(
    tmp_path: Path, arguments: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    recording(tmp_path, 10.0).rename(tmp_path / "good.csv")
    (tmp_path / "bad.csv").write_text("this,is,no\nrecording,at,all\n")
    result = CliRunner().invoke(APP, [*arguments, "--json"])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert len(result.stderr.strip().splitlines()) == 1
    assert "Traceback" not in result.stderr


def test_a_turn_recorded_as_sigmf_prints_the_same_object(tmp_path: Path) -> None:
    rate_hz, centre_hz = 8000.0, 148.5e6
    t = np.arange(int(12.0 * rate_hz)) / rate_hz
    gain_db = load_pattern(SMALL_YAGI).gain_at(300.0 - 30.0 * t)
    noise = np.random.default_rng(1).normal(size=(2, t.size)) * 1e-4
    iq = 10.0 ** (gain_db / 20.0 - 1.0) * np.exp(2j * np.pi * 900.0 * t) + noise[0] + 1j * noise[1]
    azimuths = [Azimuth(int(s * rate_hz), 0, 30.0 * s % 360.0) for s in np.arange(0.0, 12.0, 0.1)]
    place = Place(50.5, 7.5)
    path = write_sigmf(tmp_path / "turn", iq.astype(np.complex64), rate_hz, centre_hz, 1.78e9, azimuths, place)
    result = CliRunner().invoke(APP, [str(path), "--json"])
    answer = json.loads(result.stdout)
    assert answer.keys() == json.loads(CliRunner().invoke(APP, [str(recording(tmp_path, 0.0)), "--json"]).stdout).keys()
    assert answer["bearing_deg"] == pytest.approx(300.0, abs=1.0)
    assert (answer["lat"], answer["lon"], answer["accepted"]) == (50.5, 7.5, True)
    assert "The strongest signal" in result.stderr
    headings = tmp_path / "nose.csv"
    headings.write_text("\n".join(f"{s},{(30.0 * s - 40.0) % 360.0}" for s in np.arange(0.0, 12.1, 0.1)))
    given = ["--headings", str(headings), "--offset", "40", "--frequency-hz", str(centre_hz + 900.0), "--json"]
    turned = json.loads(CliRunner().invoke(APP, [str(path), *given]).stdout)
    assert turned["bearing_deg"] == pytest.approx(300.0, abs=1.0)
    path.with_suffix(".sigmf-data").unlink()
    gone = CliRunner().invoke(APP, [str(path)])
    assert gone.exit_code == 2
    assert "lacks its file turn.sigmf-data" in gone.stderr
