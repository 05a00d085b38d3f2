"""A record cannot contradict itself, survives its file, and a broken file is named with its field."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from tests.benchmarks.figures import circumstances
from tests.benchmarks.figures.circumstances import begin, command_line
from tests.benchmarks.figures.reader import BrokenRecord, read, read_all
from tests.benchmarks.figures.record import Bound, Column, Figure, Table
from tests.benchmarks.figures.wanted import BY_KEY, WANTED, Wanted
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

TABLE = Table(name="rows", columns=(Column(name="what"), Column(name="s", decimals=2)), rows=(("a", (1.0, 0.25)),))


def written(folder: Path, **changes: Any) -> Path:
    figures = [wanted("abort", 57.0, note="load 6"), plain("viewers", 50, "", ci95=0.5)]
    path = write(folder, "live_abort", "Abort", begin(__file__), figures, tables=[TABLE])
    assert path is not None
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))
    return path


def test_a_written_record_is_read_back_with_its_circumstances(tmp_path: Path) -> None:
    record = read(written(tmp_path))
    assert record.name == "live_abort"
    assert (record.command or "").startswith("python -m tests.benchmarks.figures.test_record")
    assert record.machine is not None
    assert "cores" in record.machine
    assert record.load is not None
    assert record.load.least <= record.load.most
    assert record.figures[0] == wanted("abort", 57.0, note="load 6")
    assert record.figures[0].met is True
    assert record.figures[1].met is None
    assert record.tables == (TABLE,)


def test_nothing_is_written_without_out(tmp_path: Path) -> None:
    assert write(None, "live_abort", "Abort", begin(__file__), [plain("a", 1, "")]) is None


def test_each_figure_and_row_has_a_line_of_its_own(tmp_path: Path) -> None:
    path = write(tmp_path, "one", "One", begin(__file__), [plain("a", 1, "s"), plain("b", 2.5, "s")], tables=[TABLE])
    assert path is not None
    lines = path.read_text().splitlines()
    assert '    {"name": "a", "value": 1, "unit": "s"},' in lines
    assert '        ["a", [1.0, 0.25]]' in lines


@pytest.mark.parametrize(("value", "met"), [(19.9, True), (20.0, True), (20.1, False)])
def test_met_is_judged_by_the_value(value: float, met: bool) -> None:
    assert wanted("plan_1000", value, ci95=5.0).met is met


def test_between_two_limits_both_count() -> None:
    assert [wanted("moving", value).met for value in (92.9, 93.0, 97.0, 97.1)] == [False, True, True, False]


def test_a_figure_cannot_claim_what_its_value_denies() -> None:
    with pytest.raises(ValidationError, match="met must be False"):
        Figure(name="a", value=3.0, unit="s", wanted=Bound(key="abort", at_most=2.0), met=True)
    with pytest.raises(ValidationError, match="met must be None"):
        Figure(name="a", value=3.0, unit="s", met=True)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"figures": []}, "live_abort.json: figures: "),
        ({"author": "me"}, "live_abort.json: author: "),
        ({"date": "yesterday"}, "live_abort.json: date: "),
        ({"commit": "HEAD"}, "live_abort.json: commit: "),
        ({"load": 3}, "live_abort.json: load: "),
        ({"name": "abort"}, "its name is abort"),
        ({"figures": [{"name": "a", "value": "1", "unit": ""}]}, "live_abort.json: figures.0.value"),
        ({"figures": [{"name": "a", "value": 1, "unit": ""}] * 2}, "more than one figure is named a"),
        ({"tables": [{"name": "t", "columns": [{"name": "x"}], "rows": [[1, 2]]}]}, "row 1 of table"),
        (
            {
                "figures": [
                    {"name": "a", "value": 1, "unit": "ms", "wanted": {"key": "abort", "at_most": 7}, "met": True}
                ]
            },
            "bound or unit",
        ),
        (
            {"figures": [{"name": "a", "value": 1, "unit": "ms", "wanted": {"key": "no", "at_most": 7}, "met": True}]},
            'nothing is wanted under "no"',
        ),
    ],
)
def test_a_broken_file_is_named_with_what_is_wrong(tmp_path: Path, changes: dict[str, Any], said: str) -> None:
    written(tmp_path, **changes)
    with pytest.raises(BrokenRecord) as broken:
        read_all(tmp_path)
    assert said in str(broken.value)


def test_a_file_that_is_no_json_is_named(tmp_path: Path) -> None:
    (tmp_path / "cut.json").write_text('{"name": "cut"')
    with pytest.raises(BrokenRecord, match=r"cut\.json: the file: Invalid JSON"):
        read_all(tmp_path)


def test_the_command_is_told_without_where_its_record_went() -> None:
    arguments = ["abort", "--out", "somewhere", "--times", "3", "--out=elsewhere"]
    assert command_line("tests.benchmarks.live_load", arguments) == (
        "python -m tests.benchmarks.live_load abort --times 3"
    )
    folder = ["--pieces", "/somewhere/here", "--only", "a/b"]
    assert command_line("m", folder) == "python -m m --pieces FOLDER --only a/b"


def test_a_checkout_with_changes_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    answers = {"rev-parse": "0123456789", "status": " M planner/plan.py"}
    monkeypatch.setattr(circumstances, "_git", lambda verb, *rest: answers[verb])
    assert circumstances.commit() == "0123456789-dirty"
    answers["status"] = ""
    assert circumstances.commit() == "0123456789"


def test_out_is_a_folder_and_may_be_left_out() -> None:
    parser = argparse.ArgumentParser()
    add_out(parser)
    assert parser.parse_args([]).out is None
    assert parser.parse_args(["--out", "docs/measurements"]).out == Path("docs/measurements")


def test_what_is_wanted_has_one_key_and_one_name_each() -> None:
    assert len(BY_KEY) == len(WANTED) == len({want.what for want in WANTED})
    assert {want.number for want in WANTED} == set(range(1, 30))
    assert all(want.bound() for want in WANTED)


@pytest.mark.parametrize("want", [want for want in WANTED if want.test], ids=lambda want: want.key)
def test_a_test_that_stands_for_a_figure_exists(want: Wanted) -> None:
    file, _, name = want.test.partition("::")
    assert f"def {name}(" in (circumstances.ROOT / file).read_text()
