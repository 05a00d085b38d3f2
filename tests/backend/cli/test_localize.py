"""`crossfix localize` at its edge."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
import typer
import utm
from shapely.geometry import Point, shape
from typer.testing import CliRunner

from backend.cli.localize import localize
from backend.search.source_priors import unknown_errors
from hardware.direction_finding.heading import declination_deg
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.belief.estimate import estimate
from planner.belief.joint import joint_prior, update_joint
from planner.types import Bearing, LinearMotion, Problem
from tests.benchmarks.bearing_files import KINDS, answered

APP = typer.Typer()
APP.command()(localize)
FRAME = LocalFrame(Place(50.6, 7.2))


def bearing_to(x: float, y: float, east: float, north: float) -> float:
    return math.degrees(math.atan2(east - x, north - y)) % 360.0


def written(tmp_path: Path, rows: Sequence[tuple[float, float, float]], sigma: float = 4.0) -> Path:
    """rows: east, north, bearing."""
    lines = ["lat,lon,bearing_deg,sigma_deg"]
    for east, north, bearing in rows:
        place = FRAME.to_geo(east, north)
        lines.append(f"{place.lat},{place.lon},{bearing},{sigma}")
    path = tmp_path / "bearings.csv"
    path.write_text("\n".join(lines))
    return path


def test_crossing_bearings_find_the_emitter(tmp_path: Path) -> None:
    rows = [(x, y, bearing_to(x, y, 120.0, 140.0)) for x, y in ((0, 0), (250, 0), (100, 350), (-80, 150))]
    result = CliRunner().invoke(APP, [str(written(tmp_path, rows)), "--json"])
    answer = json.loads(result.stdout)
    east, north = FRAME.to_enu(Place(answer["estimate"]["lat"], answer["estimate"]["lon"]))
    assert result.exit_code == 0
    assert math.hypot(east - 120.0, north - 140.0) < 6.0
    assert 0.0 < answer["expected_rmse_m"] < 20.0
    assert answer["consistent"] is True
    truth = FRAME.to_geo(120.0, 140.0)
    assert shape(answer["c95"]).contains(Point(truth.lon, truth.lat))


def test_what_a_krakens_page_held_is_read_as_an_import_reads_it(tmp_path: Path) -> None:
    path = tmp_path / "kraken.csv"
    heard = "17000000{at}123, 40, 80.5, -31.2, 868300000, UCA, 412, {station}, 50.6, 7.2, 350.0, 10.0, GPS, R, R, R, R"
    path.write_text(heard.format(at=10, station="roof") + "\n" + heard.format(at=40, station="car"))
    answer = json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout)
    assert answer["bearings"] == 2


def test_each_station_of_a_krakens_log_has_a_compass_of_its_own(tmp_path: Path) -> None:
    heard = "{ms}, {deg}, 80.5, -31.2, 868300000, UCA, 412, {station}, {lat}, {lon}, 0, 0, GPS, R, R, R, R"
    around = [(300 + 600 * math.cos(turn), 400 + 600 * math.sin(turn)) for turn in range(6)]
    off = {"east": (-14.0, around[:3]), "west": (14.0, around[::2])}
    lines: list[str] = []
    for station, (bias, places) in off.items():
        for x, y in places:
            place, deg = FRAME.to_geo(x, y), (bearing_to(x, y, 300.0, 400.0) + bias) % 360.0
            ms = 1_700_000_000_000 + 120_000 * len(lines)
            lines.append(heard.format(ms=ms, deg=deg, station=station, lat=place.lat, lon=place.lon))
    path = tmp_path / "kraken.csv"
    path.write_text("\n".join(lines))
    answer = json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout)
    biases = {one["name"]: one["bias_deg"] for one in answer["sources"]}
    assert biases["west"] > 5.0
    assert biases["east"] < -2.0
    assert "all bearings of west turned clockwise by +" in CliRunner().invoke(APP, [str(path)]).stdout


def test_bearings_on_both_sides_of_the_dateline_cross_there(tmp_path: Path) -> None:
    path = tmp_path / "bearings.csv"
    path.write_text("lat,lon,bearing_deg\n0,179.999,45\n0,-179.995,315\n")
    answer = json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout)
    assert answer["estimate"]["lon"] == pytest.approx(-179.998, abs=1e-3)


def test_bearings_of_a_magnetic_compass_are_made_true(tmp_path: Path) -> None:
    places = ((0, 0), (250, 0), (100, 350), (-80, 150))
    east_deg = declination_deg(FRAME.origin, datetime(2020, 6, 1, tzinfo=UTC).timestamp())
    rows = [(x, y, bearing_to(x, y, 120.0, 140.0) - east_deg) for x, y in places]
    path = written(tmp_path, rows)
    answer = json.loads(CliRunner().invoke(APP, [str(path), "--json", "--magnetic", "2020-06-01"]).stdout)
    true = written(tmp_path, [(x, y, bearing_to(x, y, 120.0, 140.0)) for x, y in places])
    expected = json.loads(CliRunner().invoke(APP, [str(true), "--json"]).stdout)
    assert abs(east_deg) > 2.0
    for axis in ("lat", "lon"):
        assert answer["estimate"][axis] == pytest.approx(expected["estimate"][axis], abs=1e-5)
    refused = CliRunner().invoke(APP, [str(path), "--magnetic", "1999-06-01"])
    assert (refused.exit_code, refused.stdout) == (2, "")
    assert "1999" in refused.stderr


def test_places_in_utm_are_answered_as_those_in_degrees(tmp_path: Path) -> None:
    rows = [(x, y, bearing_to(x, y, 120.0, 140.0)) for x, y in ((0, 0), (250, 0), (100, 350), (-80, 150))]
    degrees, metres = written(tmp_path, rows), tmp_path / "utm.csv"
    lines = ["Easting;Northing;UTM Zone;Azimuth;sigma_deg"]
    for east, north, bearing in rows:
        place = FRAME.to_geo(east, north)
        e, n, zone, _ = utm.from_latlon(place.lat, place.lon)
        lines.append(f"{e:.2f};{n:.2f};{zone}N;{bearing};4".replace(".", ","))
    metres.write_text("\n".join(lines))
    answers = [json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout) for path in (degrees, metres)]
    for axis in ("lat", "lon"):
        assert answers[0]["estimate"][axis] == pytest.approx(answers[1]["estimate"][axis], abs=1e-6)


def test_one_bearing_is_answered_honestly(tmp_path: Path) -> None:
    answer = json.loads(CliRunner().invoke(APP, [str(written(tmp_path, [(0, 0, 45.0)])), "--json"]).stdout)
    assert answer["expected_rmse_m"] > 100.0
    assert answer["localized"] is False
    assert answer["not_yet"]


def test_contradicting_bearings_give_no_estimate(tmp_path: Path) -> None:
    path = written(tmp_path, [(0, 0, 270.0), (300, 0, 90.0)])
    answer = json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout)
    assert answer["consistent"] is False
    assert answer["estimate"] is None
    assert answer["c95"] is None
    assert "contradict" in CliRunner().invoke(APP, [str(path)]).stdout


def test_area_option_bounds_the_estimate(tmp_path: Path) -> None:
    corners = [FRAME.to_geo(x, y) for x, y in ((50, 50), (150, 50), (150, 150), (50, 150), (50, 50))]
    polygon = {"type": "Polygon", "coordinates": [[[p.lon, p.lat] for p in corners]]}
    area = tmp_path / "area.geojson"
    area.write_text(json.dumps({"type": "Feature", "properties": {}, "geometry": polygon}))
    path = written(tmp_path, [(0, 0, 45.0)])
    answer = json.loads(CliRunner().invoke(APP, [str(path), "--area", str(area), "--json"]).stdout)
    place = answer["estimate"]
    assert shape(polygon).buffer(1e-6).contains(Point(place["lon"], place["lat"]))
    assert answer["expected_rmse_m"] < 60.0


@pytest.mark.parametrize("arguments", [["missing.csv"], ["bad.csv"], ["tags.csv"], ["good.csv", "--area", "bad.csv"]])
def test_bad_input_is_one_line_on_stderr_and_exit_code_2(
    tmp_path: Path, arguments: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.csv").write_text("x,y\n1,2\n")
    (tmp_path / "good.csv").write_text("50.1,7.2,10\n")
    (tmp_path / "tags.csv").write_text("2,a,10,0.5,50.1,7.2,10,200,0,1\n3,a,10,0.5,50.1,7.2,10,200,0,1\n")
    result = CliRunner().invoke(APP, [*arguments, "--json"])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert len(result.stderr.strip().splitlines()) == 1


def test_the_answer_is_the_place_with_the_least_expected_error(tmp_path: Path) -> None:
    rows = [(x, y, bearing_to(x, y, 150.0, 90.0)) for x, y in ((0, 0), (60, -20))]
    path = str(written(tmp_path, rows, sigma=7.0))
    plain = json.loads(CliRunner().invoke(APP, [path, "--json"]).stdout)
    others = [
        json.loads(CliRunner().invoke(APP, [path, "--json", "--estimator", name]).stdout)
        for name in ("map", "expected_value")
    ]
    assert plain["estimator"] == "geometric_median"
    assert [o["estimator"] for o in others] == ["map", "expected_value"]
    assert all(plain["expected_rmse_m"] < o["expected_rmse_m"] for o in others)


def test_an_unknown_estimator_is_named_with_the_known_ones(tmp_path: Path) -> None:
    result = CliRunner().invoke(APP, [str(written(tmp_path, [(0, 0, 45.0)])), "--estimator", "mode"])
    assert result.exit_code == 2
    assert '"mode" is no estimator: choose one of map, expected_value, geometric_median' in result.stderr


def test_a_stated_sigma_counts_as_it_does_in_flight(tmp_path: Path) -> None:
    """Of 13 degrees 12 are each bearing's own and 5 the compass', which the joint belief counts once for all."""
    rows = [(x, y, bearing_to(x, y, 120.0, 140.0)) for x, y in ((0, 0), (250, 0), (100, 350), (-80, 150))]
    places = [Bearing(x, y, math.radians(90.0 - bearing), math.radians(12.0)) for x, y, bearing in rows]
    square = np.array([(-300.0, -300.0), (500.0, -300.0), (500.0, 600.0), (-300.0, 600.0)])
    corners = [FRAME.to_geo(x, y) for x, y in (*square, square[0])]
    area = tmp_path / "area.geojson"
    area.write_text(json.dumps({"type": "Polygon", "coordinates": [[[p.lon, p.lat] for p in corners]]}))
    path = str(written(tmp_path, rows, sigma=13.0))
    answer = json.loads(CliRunner().invoke(APP, [path, "--area", str(area), "--json"]).stdout)
    problem = Problem((square,), places[0].sigma, 10.0, 0.0, LinearMotion(1.0), estimator="geometric_median")
    belief = joint_prior(problem, otherwise=unknown_errors(0.1))
    for bearing in places:
        belief = update_joint(belief, bearing)
    stated = estimate(belief, "geometric_median").expected_rmse
    assert answer["expected_rmse_m"] == pytest.approx(stated, rel=0.03)


def test_bearings_whose_stated_errors_are_their_own_hold_the_truth_as_often_as_stated() -> None:
    """24 of these 30 when four fifths of a stated sigma counted as common to all bearings."""
    answers = [answered(KINDS[0], 1, number) for number in range(30)]
    assert sum(answer.held for answer in answers) >= 28


def test_independent_errors_hold_the_truth_as_often_as_stated_too() -> None:
    """26 of these 30 when each cell counted by its centre."""
    answers = [answered(KINDS[1], 7, number, "--errors", "independent") for number in range(30)]
    assert sum(answer.held for answer in answers) >= 28


def test_a_common_offset_of_all_bearings_is_found_and_taken_off(tmp_path: Path) -> None:
    places = ((0, 0), (250, 0), (100, 350), (-80, 150), (260, 300), (120, -60))
    rows = [(x, y, (bearing_to(x, y, 120.0, 140.0) + 9.0) % 360.0) for x, y in places]
    path = str(written(tmp_path, rows, sigma=2.0))
    answer = json.loads(CliRunner().invoke(APP, [path, "--json"]).stdout)
    (source,) = answer["sources"]
    assert source["bias_deg"] == pytest.approx(9.0, abs=2.0)
    found = FRAME.to_enu(Place(answer["estimate"]["lat"], answer["estimate"]["lon"]))
    assert math.dist(found, (120.0, 140.0)) < 5.0
    assert "turned clockwise by +9" in CliRunner().invoke(APP, [path]).stdout
    alone = json.loads(CliRunner().invoke(APP, [path, "--json", "--errors", "independent"]).stdout)
    assert alone["sources"] == []
    wrong = CliRunner().invoke(APP, [path, "--errors", "some"])
    assert wrong.exit_code == 2
    assert "choose one of independent, joint" in wrong.stderr


def test_an_error_of_decimetres_is_told_as_it_is_claimed(tmp_path: Path) -> None:
    """A goal below a metre was told as reached within "0 m"."""
    places = ((0, 0), (75, 0), (30, 105), (-24, 45), (78, 45), (0, 90))
    file = written(tmp_path, [(x, y, bearing_to(x, y, 36.0, 42.0)) for x, y in places], sigma=0.6)
    asked = [str(file), "--range", "150", "--threshold", "0.9"]
    told = json.loads(CliRunner().invoke(APP, [*asked, "--json"]).stdout)["expected_rmse_m"]
    assert told < 0.9
    text = CliRunner().invoke(APP, asked).stdout
    assert f"expected error {told:.1f} m, from 6 bearings" in text


def test_one_bearing_is_told_in_the_singular_and_turned_by_no_minus_zero(tmp_path: Path) -> None:
    text = CliRunner().invoke(APP, [str(written(tmp_path, [(0.0, 0.0, 40.0)]))]).stdout
    assert "from 1 bearing\n" in text
    assert "-0 " not in text


@pytest.mark.parametrize("options", [(), ("--errors", "independent"), ("--errors", "independent", "--outliers", "0.1")])
def test_sharp_bearings_from_near_need_no_range(tmp_path: Path, options: Sequence[str]) -> None:
    """In 2 km, which are taken where nobody says how far it is heard, 483 m were stated; 672 with outliers alone."""
    places = [(60.0, 0.0), (0.0, 60.0), (-60.0, 0.0), (0.0, -60.0), (42.0, 42.0)]
    off = (0.5, -1.0, 1.0, 1.0, -0.5)
    rows = [(x, y, (bearing_to(x, y, 0.0, 0.0) + error) % 360.0) for (x, y), error in zip(places, off, strict=True)]
    answer = json.loads(CliRunner().invoke(APP, [str(written(tmp_path, rows, 2.0)), "--json", *options]).stdout)
    assert answer["localized"]
    assert answer["expected_rmse_m"] < 4.0
    assert math.hypot(*FRAME.to_enu(Place(answer["estimate"]["lat"], answer["estimate"]["lon"]))) < 5.0
