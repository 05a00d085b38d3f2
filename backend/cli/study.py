"""`crossfix study`: Monte Carlo studies of the planners, beside the figures of the thesis."""

from __future__ import annotations

import sys
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from backend.cli.edge import print_json, remark, stop, words_of
from backend.cli.field_study import FieldSetting, FieldWays, field_rows
from backend.cli.truth import truth
from planner.options import STUDY
from planner.study.errors import StudyError
from planner.types import PlannerError

if TYPE_CHECKING:
    from planner.study.cell import Cell
    from planner.study.table import Summary

app = typer.Typer(
    name="study",
    help="Fly simulated missions by the thousand: compare planners, scenarios and settings, with 95 % intervals.",
    no_args_is_help=True,
)

FIELD_WORLD = "field-world"
FIELD_OPTIONS = ("listens", "turns", "turn_rate", "compass_sd", "compass_bias", "antenna", "flights")
CELL_OPTIONS = (
    "config",
    "selection",
    "sampling",
    "budget",
    "actions",
    "estimator",
    "base_policy",
    "measurement_time",
    "results",
)
"""Of all scenarios but that."""
DEFAULT_DIRECTORY = Path("study-results")

Directory = Annotated[
    Path, typer.Option("--results", help="Where results are kept (Parquet); a study broken off goes on from there.")
]


@app.command()
def run(
    context: typer.Context,
    scenario: Annotated[
        list[str] | None,
        typer.Option(
            help="1: uniform prior, eleven targets in a row. 2: Gaussian prior. 3: ring around the start. "
            "field: the flown system's area. May be repeated, like --config, --planner and --seed. field-world: whole "
            "searches from simulated sweeps, with echoes, shadows and a wrong compass; by itself.",
        ),
    ] = None,
    config: Annotated[
        list[str] | None, typer.Option(help="fast, medium or slow: a bearing takes 2, 10 or 40 s.")
    ] = None,
    planner: Annotated[
        list[str] | None,
        typer.Option(
            help="base, fisher, entpp, entpp8, sopt, vander_hook, tokekar_subset, tokekar_worst_case, tokekar_tree, "
            "lookahead, lookahead_myopic, dynamic_program, rollout, or crossfix: rollouts on the dynamic program. "
            "field-world: crossfix, rollout, fisher, entpp, entropy_of_nine, random_walk or gyration.",
        ),
    ] = None,
    selection: Annotated[
        str, typer.Option(help="rollout: sequential_halving, uniform, quadrant, sgd or bfgs.")
    ] = STUDY.selection,
    sampling: Annotated[
        str,
        typer.Option(help="rollout: crn (common random numbers), quasi_random, pmc (independent) or deterministic."),
    ] = STUDY.sampling,
    budget: Annotated[int, typer.Option(help="rollout: simulated flights a decision.")] = STUDY.budget,
    actions: Annotated[
        str | None, typer.Option(help="Grid of places compared, columns x rows. Default: the scenario's, 20x20.")
    ] = None,
    estimator: Annotated[
        str | None, typer.Option(help="map, expected_value or geometric_median. Default: the scenario's.")
    ] = None,
    base_policy: Annotated[
        str | None,
        typer.Option(
            help="rollout: followed after the first place; ellipse, fisher (field's default) or dynamic_program."
        ),
    ] = None,
    measurement_time: Annotated[
        float | None, typer.Option(help="Seconds a bearing takes, instead of the configuration's.")
    ] = None,
    runs: Annotated[int, typer.Option(help="Missions for each cell of the table.")] = 1000,
    seed: Annotated[
        list[int] | None, typer.Option(help="Mission k has the same target and noise for all planners. Default: 1.")
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes on this machine.")] = 2,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler to fly on instead, for instance tcp://host:8786.")
    ] = None,
    listens: Annotated[
        list[str] | None,
        typer.Option(
            help="field-world: places; way, between them too; way_swinging, the nose swinging; or never_stopping, "
            "turning only where the way told little. Without it and --turns crossfix does as in new missions, the "
            "others turn once around and listen there."
        ),
    ] = None,
    turns: Annotated[
        list[str] | None,
        typer.Option(help="field-world: whole, or sector: only as far as needed. May be repeated: a row each."),
    ] = None,
    turn_rate: Annotated[float, typer.Option(help="field-world: of a sweep, degrees a second.")] = 30.0,
    compass_sd: Annotated[
        float, typer.Option(help="field-world: standard deviation of the flights' compass errors, degrees.")
    ] = 4.0,
    compass_bias: Annotated[
        float | None, typer.Option(help="field-world: the compass' error instead, degrees to either side.")
    ] = None,
    antenna: Annotated[str, typer.Option(help="field-world: yagi, or wide: a beam of 86 degrees, not 68.")] = "yagi",
    flights: Annotated[
        int, typer.Option(min=0, help="field-world: of the craft before these, from whose bearings alone it learns.")
    ] = 0,
    results: Directory = DEFAULT_DIRECTORY,
    json_: Annotated[
        bool, typer.Option("--json", help="Print one JSON object; a list of them when several cells were asked for.")
    ] = False,
) -> None:
    """Fly missions and print the mean time until localization beside the thesis' figure.

    Example: crossfix study run --scenario 2 --planner base --planner entpp --config medium --runs 1000
    """
    if scenario is not None and FIELD_WORLD in scenario:
        if foreign := [name for name in CELL_OPTIONS if _is_given(context, name)]:
            _refuse(f"--{foreign[0].replace('_', '-')} means nothing to {FIELD_WORLD}: leave it out", json_)
        if compass_bias is not None and _is_given(context, "compass_sd"):
            _refuse("--compass-bias is every flight's error instead of --compass-sd: give one of them", json_)
        try:
            ways = FieldWays(planner or ["crossfix"], turns or (), listens or ())
            setting = FieldSetting(turn_rate, compass_sd, compass_bias, antenna, flights)
            field_rows(ways, setting, runs, _field_seed(scenario, runs, workers, seed), workers, scheduler, json_)
        except (PlannerError, StudyError) as error:
            _refuse(error, json_)
        except KeyboardInterrupt:
            remark(f"stopped; nothing is kept of {FIELD_WORLD}, the same command begins again")
            raise typer.Exit(130) from None
        return
    given = [name for name in FIELD_OPTIONS if _is_given(context, name)]
    if given:
        option = given[0].replace("_", "-")
        _refuse(f"--{option} is of the field world: add --scenario {FIELD_WORLD}, or leave it out", json_)
    study = _modules()
    if unknown := [name for name in scenario or () if name not in study.scenarios]:
        _refuse(f"there is no scenario {unknown[0]!r}: choose one of {', '.join(study.scenarios)}", json_)
    try:
        cells = [
            study.Cell(
                scenario=s,
                config=c,
                planner=p,
                selection=selection,
                sampling=sampling,
                budget=budget,
                actions=actions,
                estimator=estimator,
                base_policy=base_policy,
                measurement_time=measurement_time,
                seed=number,
            )
            for s, p, c, number in product(
                scenario or ["2"], planner or ["base"], config or ["medium"], seed if seed else [1]
            )
        ]
        if runs < 1 or workers < 1:
            raise StudyError(f"--runs and --workers must be 1 or more, got {runs} and {workers}")
        if "rollout" not in (planner or ()):
            for name in study.rollout_only:
                if _is_given(context, name):
                    remark(f"--{name.replace('_', '-')} is of --planner rollout and changes nothing here")
        summaries = _fly(study, cells, runs, results, workers, scheduler)
    except (PlannerError, StudyError) as error:
        _refuse(error, json_)
    except KeyboardInterrupt:
        remark(f"broken off; what was flown is in {results}, the same command goes on from there")
        raise typer.Exit(130) from None
    if json_:
        answers = [summary.json() for summary in summaries]
        print_json(answers[0] if len(answers) == 1 else answers)
    else:
        _print_table(study, summaries)


@app.command()
def report(
    results: Annotated[Path, typer.Argument(help="Directory that `crossfix study run --results` filled.")],
    figures: Annotated[Path, typer.Option(help="Directory for the drawings (PNG).")] = Path("study-figures"),
    markdown: Annotated[Path | None, typer.Option(help="Also write the table to this Markdown file.")] = None,
    paths: Annotated[int, typer.Option(help="Sample paths on which first actions are valued.")] = 1000,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object: cells and files drawn.")] = False,
) -> None:
    """Draw the thesis' figures from stored results and print the table beside the thesis.

    Example: crossfix study report study-results --figures study-figures
    """
    study = _modules()
    try:
        summaries, drawn = study.report(results, figures, remark, paths)
        if markdown is not None:
            markdown.write_text(study.table.markdown(summaries) + "\n", encoding="utf-8")
    except (PlannerError, StudyError) as error:
        _refuse(error, json_)
    except OSError as error:
        _refuse(f"{error.filename}: {error.strerror}", json_)
    if json_:
        print_json({"cells": [s.json() for s in summaries], "figures": [str(path) for path in drawn]})
        return
    _print_table(study, summaries)
    for path in drawn:
        typer.echo(f"drew {path}", err=True)


app.command()(truth)


def _is_given(context: typer.Context, name: str) -> bool:
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


def _field_seed(scenario: list[str], runs: int, workers: int, seed: list[int] | None) -> int:
    """Of the first mission."""
    seeds = seed or [1]
    if len(scenario) > 1 or len(seeds) > 1:
        raise StudyError("field-world is flown by itself, from one --seed on: give --scenario and --seed once")
    if runs < 1 or workers < 1 or seeds[0] < 0:
        raise StudyError(
            f"--runs and --workers must be 1 or more and --seed 0 or more, got {runs}, {workers} and {seeds[0]}"
        )
    return seeds[0]


def _refuse(error: object, json_: bool) -> NoReturn:
    """One line on stderr; for programs an object on stdout as well."""
    if json_:
        print_json({"error": words_of(error)})
    stop(error)


class _Study:
    """The study's modules, imported when they are needed: they bring pandas, and drawing brings matplotlib."""

    def __init__(self) -> None:
        from planner.study import cell, runner, table
        from planner.study.report import report
        from planner.study.scenarios import SCENARIOS

        self.scenarios, self.rollout_only = (*SCENARIOS, FIELD_WORLD), cell.ROLLOUT_ONLY
        self.Cell, self.run_cell, self.table, self.report = cell.Cell, runner.run_cell, table, report


def _modules() -> _Study:
    try:
        return _Study()
    except ImportError as error:
        stop(f"studies need more packages ({error}): pip install 'crossfix[study]'")


def _fly(
    study: _Study, cells: list[Cell], runs: int, results: Path, workers: int, scheduler: str | None
) -> list[Summary]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    summaries: list[Summary] = []
    with Progress(*columns, console=Console(file=sys.stderr)) as bars:
        for cell in cells:
            fields = cell.fields()
            task = bars.add_task(f"{fields['scenario']} {fields['config']} {study.table.label(fields)}", total=runs)
            missions = study.run_cell(
                cell,
                runs,
                results,
                workers=workers,
                scheduler=scheduler,
                progress=lambda done, task=task: bars.advance(task, done),
                remark=remark,
            )
            summaries.append(study.table.summarize(cell, missions))
    return summaries


def _print_table(study: _Study, summaries: list[Summary]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(*study.table.HEADER)
    for summary in summaries:
        table.add_row(*study.table.row(summary))
    console = Console(width=None if sys.stdout.isatty() else 160)
    console.print(table)
    if any(summary.within is False for summary in summaries):
        console.print(study.table.FOOTNOTE)
