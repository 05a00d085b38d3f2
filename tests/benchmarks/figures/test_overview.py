"""The one table: what is not met stands first, what nobody measured is said, and equal records give equal text."""

from __future__ import annotations

from tests.benchmarks.figures.overview import overview
from tests.benchmarks.figures.record import Figure, Load, Record
from tests.benchmarks.figures.wanted import WANTED
from tests.benchmarks.figures.writer import plain, wanted


def record(name: str, *figures: Figure, **more: object) -> Record:
    return Record.model_validate(
        {
            "name": name,
            "title": name.title(),
            "command": f"python -m {name}",
            "commit": None,
            "date": "2026-11-21",
            "machine": None,
            "load": None,
            "figures": figures,
            **more,
        }
    )


ABORT = record("abort", wanted("abort", 57.0, note="load 6"), plain("median", 10.0, "ms", ci95=0.5))
FANOUT = record("fanout", wanted("fanout", 265.0))
PLAN = record("plan", wanted("plan_3600", 23.4), wanted("plan_1000", 15.0))


def rows(page: str) -> list[list[str]]:
    """Cells of the first table, without its head."""
    table = page[: page.index("## ")]
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in table.splitlines() if line.startswith("|")][2:]


def test_not_met_comes_first_then_not_measured_then_met_then_the_rest() -> None:
    found = rows(overview([ABORT, FANOUT, PLAN]))
    standings = [row[0] for row in found]
    tested = sum(bool(want.test) for want in WANTED)
    unmeasured = len(WANTED) - tested - 4
    assert standings == ["**not met**"] * 2 + ["not measured"] * unmeasured + ["met"] * (2 + tested) + [""]
    assert [row[2] for row in found[:2]] == ["23.4 ms", "265 ms"], "in the order of the list of wanted figures"
    assert found[-1][1:4] == ["Abort: median", "10 ± 0.5 ms", ""]


def test_a_figure_stands_beside_its_bound_its_note_and_its_record() -> None:
    found = rows(overview([ABORT]))
    met = next(row for row in found if row[1].startswith("abort, request"))
    assert met[0] == "met"
    assert met[2:] == ["57 ms (load 6)", "at most 100 ms", "6", "[abort](measurements/abort.json)"]
    fanout = next(row for row in found if row[1].startswith("telemetry"))
    assert fanout == ["not measured", fanout[1], "", "at most 100 ms", "7", ""]


def test_what_a_test_asserts_in_every_run_is_met_and_names_it() -> None:
    axe = next(row for row in rows(overview([])) if "axe" in row[1])
    assert (axe[0], axe[2]) == ("met", "[a test](../tests/browser/test_page.py) asserts it")


def test_bounds_in_words() -> None:
    bounds = {row[1]: row[3] for row in rows(overview([]))}
    assert bounds["emitter moving at up to 0.4 m/s: truth in C95"] == "93 to 97 %"
    assert bounds["odd HTTP requests made"] == "at least 100,000"
    assert bounds["beliefs changed by kills"] == "0"


def test_how_many_are_wanted_unmet_and_missing_is_said() -> None:
    head = overview([ABORT, FANOUT, PLAN]).split("\n|")[0]
    missing = sum(not want.test for want in WANTED) - 4
    assert f"Wanted: {len(WANTED)} figures. Of 4 measurements of them 2 are **not met**; {missing} figures" in head


def test_several_records_of_one_wanted_figure_all_stand_there() -> None:
    two = [record(name, wanted("takeover", 0.0, of=name)) for name in ("ardupilot", "px4")]
    found = [row for row in rows(overview(two)) if "pilot took over" in row[1]]
    assert [row[1].rpartition(": ")[2] for row in found] == ["ardupilot", "px4"]


def test_what_was_not_noted_is_said_to_be_so_and_the_page_is_linked() -> None:
    loaded = record("b", plain("x", 1, ""), load=Load(least=8.0, most=16.0), page="kernel.md", date="2026-11-22T00:37Z")
    runs = overview([ABORT, loaded]).split("## How they were taken")[1]
    assert "| `abort`: Abort | `python -m abort` | not noted | 2026-11-21 | not noted | not noted |  |" in runs
    assert "| `b`: [B](kernel.md) | `python -m b` | not noted | 2026-11-22 00:37 | not noted | 8 to 16 |  |" in runs


def test_the_same_records_give_the_same_page() -> None:
    assert overview([ABORT, FANOUT]) == overview([ABORT.model_copy(), FANOUT.model_copy()])


def test_a_bar_in_a_text_does_not_end_its_cell() -> None:
    assert "a \\| b" in overview([record("r", plain("a | b", 1, ""))])
