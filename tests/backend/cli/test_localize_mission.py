"""`crossfix localize mission.json`: what the flight said, to the last digit."""

from __future__ import annotations

import json
import math
import os
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
import typer
from facts import bearing
from typer.testing import CliRunner

from backend.cli.localize import localize
from backend.events import BearingMeasured, CraftSource, MissionDrafted, MissionStarted, PersonSource, Recorded
from backend.search.localization import localization
from backend.spec import EmitterSpec, MissionSpec, Place, Polygon, SensorSpec
from backend.wire.export import journal_json
from hardware.frame import LocalFrame

APP = typer.Typer()
APP.command()(localize)
HOME = Place(lat=50.6, lon=7.2)
FRAME = LocalFrame(HOME)
EMITTER = (30.0, 120.0)
CORNERS = [FRAME.to_geo(x, y) for x, y in ((-150, 0), (150, 0), (150, 200), (-150, 200), (-150, 0))]
RING = [(place.lon, place.lat) for place in CORNERS]
SPEC = MissionSpec(name="m", area=Polygon(coordinates=[RING]), sensor=SensorSpec(bearing_errors="joint"))


def taken(number: int, x: float, y: float, by: CraftSource | PersonSource, off_deg: float) -> BearingMeasured:
    told = {
        "sweep_id": None,
        "place": FRAME.to_geo(x, y),
        "bearing_deg": (math.degrees(math.atan2(EMITTER[0] - x, EMITTER[1] - y)) + off_deg) % 360,
        "sigma_deg": 6.0,
        "heading_sigma_deg": 4.0,
    }
    return bearing(number, "emitter-1", by).model_copy(update=told)


CRAFT, ANNA = CraftSource(craft_id="craft-1"), PersonSource(name="anna")
BEARINGS = [
    taken(1, 0, 0, CRAFT, 2.0),
    taken(2, 140, 60, ANNA, -9.0),
    taken(3, -100, 150, CRAFT, 2.0),
    taken(4, 60, 190, ANNA, -9.0),
]


def exported(tmp_path: Path, spec: MissionSpec = SPEC) -> str:
    drafted = MissionDrafted(spec=spec)
    started = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
    at = datetime(2026, 11, 30, tzinfo=UTC)
    recorded = [
        Recorded(seq=seq, mission_id="m", at_utc=at + timedelta(seconds=seq), event=event)
        for seq, event in enumerate([drafted, started, *BEARINGS], start=1)
    ]
    path = tmp_path / "mission.json"
    path.write_text(journal_json(recorded, {}))
    return str(path)


def test_a_mission_is_believed_as_in_flight(tmp_path: Path) -> None:
    fact, _ = localization(SPEC, HOME).belief_fact(BEARINGS)
    path = exported(tmp_path)
    answer = json.loads(CliRunner().invoke(APP, [path, "--json"]).stdout)
    assert fact.estimate is not None
    assert answer["expected_rmse_m"] == fact.estimate.expected_rmse_m
    assert answer["estimate"] == {"lat": fact.estimate.lat, "lon": fact.estimate.lon}
    assert [one["name"] for one in answer["sources"]] == ["craft-1", "anna"]
    assert [one["bias_deg"] for one in answer["sources"]] == [one.bias_deg for one in fact.sources]
    assert answer["localized"] == fact.localized
    assert "all bearings of anna turned clockwise by -" in CliRunner().invoke(APP, [path]).stdout


def test_one_of_several_emitters_is_named(tmp_path: Path) -> None:
    (first,) = SPEC.emitters
    other = EmitterSpec(emitter_id="other", label="vixen", frequency_hz=1e8)
    path = exported(tmp_path, SPEC.model_copy(update={"emitters": [first, other]}))
    refused = CliRunner().invoke(APP, [path])
    assert refused.exit_code == 2
    assert "vixen: choose one with --tag" in refused.stderr
    assert json.loads(CliRunner().invoke(APP, [path, "--tag", "1", "--json"]).stdout)["bearings"] == 4
    assert json.loads(CliRunner().invoke(APP, [path, "--tag", "vixen", "--json"]).stdout)["bearings"] == 0


@pytest.mark.parametrize("option", [("--sigma", "5"), ("--errors", "independent"), ("--threshold", "5")])
def test_what_a_mission_says_itself_is_not_asked_otherwise(tmp_path: Path, option: tuple[str, str]) -> None:
    refused = CliRunner().invoke(APP, [exported(tmp_path), *option])
    assert refused.exit_code == 2
    assert "a mission says itself what it searches with" in refused.stderr


def test_other_json_is_named_as_no_mission(tmp_path: Path) -> None:
    path = tmp_path / "mission.geojson"
    path.write_text('{"type": "FeatureCollection", "features": []}')
    refused = CliRunner().invoke(APP, [str(path)])
    assert refused.exit_code == 2
    assert "take the journal (JSON) or the CSV" in refused.stderr


def test_a_label_goes_before_a_number_and_two_of_one_label_are_told_apart(tmp_path: Path) -> None:
    """`--tag 1` gave the first emitter, though a collar is called that."""

    def answered(*labels: str, tag: str) -> int | str:
        emitters = [EmitterSpec(emitter_id=f"emitter-{n}", label=one) for n, one in enumerate(labels, start=1)]
        path = exported(tmp_path, SPEC.model_copy(update={"emitters": emitters}))
        ran = CliRunner().invoke(APP, [path, "--tag", tag, "--json"])
        return ran.stderr if ran.exit_code else json.loads(ran.stdout)["bearings"]

    assert answered("2", "1", tag="1") == 0
    assert answered("2", "1", tag="2") == len(BEARINGS)
    assert "looks for fox 1, fox 2: choose one" in str(answered("fox", "fox", tag="fox"))
    assert answered("fox", "fox", tag="fox 2") == 0


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_mission_is_read_as_an_editor_saves_it(tmp_path: Path, encoding: str) -> None:
    path = Path(exported(tmp_path))
    path.write_text(path.read_text(), encoding=encoding)
    assert json.loads(CliRunner().invoke(APP, [str(path), "--json"]).stdout)["bearings"] == len(BEARINGS)


def test_a_mission_of_a_later_crossfix_is_named_so(tmp_path: Path) -> None:
    path = Path(exported(tmp_path))
    path.write_text(json.dumps(json.loads(path.read_text()) | {"form": 99}))
    assert "a later Crossfix exported it" in CliRunner().invoke(APP, [str(path)]).stderr


def test_bearings_that_come_through_a_pipe_are_read_once() -> None:
    """As of `crossfix localize <(...)`: "holds no rows of data" was said of it."""
    pipe, end = os.pipe()
    os.write(end, b"lat,lon,bearing_deg\n0,179.999,45\n0,-179.995,315\n")
    os.close(end)
    answer = json.loads(CliRunner().invoke(APP, [f"/dev/fd/{pipe}", "--json"]).stdout)
    os.close(pipe)
    assert answer["bearings"] == 2


@pytest.mark.parametrize(("sigma_deg", "said"), [(1e200, "no bearings that are read"), (-6.0, "event 3 is none")])
def test_an_uncertainty_that_no_flight_tells_is_refused(tmp_path: Path, sigma_deg: float, said: str) -> None:
    """It ended with a traceback, or localized within ten metres."""
    path = Path(exported(tmp_path))
    journal = json.loads(path.read_text())
    journal["events"][2]["event"]["sigma_deg"] = sigma_deg
    path.write_text(json.dumps(journal))
    refused = CliRunner().invoke(APP, [str(path)])
    assert refused.exit_code == 2
    assert said in refused.stderr
