"""`crossfix study truth`: is what a search claims true, in worlds whose errors know nothing of the belief's model?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Annotated

import typer

from backend.api.suggestion import suggested_mission
from backend.cli.edge import print_json, remark, stop
from backend.search.localization import localization
from backend.search.source_priors import unknown_craft
from hardware.readings import Place
from planner.study.error_worlds import ROWS
from planner.study.errors import StudyError
from planner.study.moving import SPEEDS, moving_missions
from planner.study.tags import TAGS, tags_missions
from planner.study.truth import TOLD, UNKNOWN, Claim, Model, Search, Truth, learn, missions, row_named, truth_of
from planner.study.truth import told as true_errors
from planner.study.truth_planners import TruthPlanner, truth_planner

HOME = Place(50.6234, 7.2046)
"""Anywhere: the worlds are flat."""
MEASUREMENT_S = 30.0
"""Of a bearing, as in the field scenario, so that times stay comparable with what is wanted of them."""
MODELS: tuple[Model, ...] = ("joint", "independent")
REMARK_EVERY = 50
FIRST_LESSON = 1_000_000
"""Seed of the first flight that is only learned from."""


def truth(
    row: Annotated[
        str,
        typer.Option(
            help="independent, scattered, bias5, bias10, bias5_outliers8, bias5_outliers20, bias10_outliers8, right, "
            "walls, walls_bias5, squinted, uneven, foreign, creeping, jumping or two_sources: how the bearings are "
            "wrong (degrees of compass bias, percent of outliers); tags_4 or tags_8: four or eight tags in the field "
            "scenario, each a claim (tags_4_bias5, tags_8_bias5: with a wrong compass, one for all tags; tags_4_first, "
            "tags_8_first: the first tag is the most important, in the same worlds); moving_0.1, "
            "moving_0.2 or moving_0.4: an emitter that walks or drifts at that speed, in m/s."
        ),
    ],
    missions_: Annotated[int, typer.Option("--missions", help="Simulated missions.")] = 1000,
    model: Annotated[
        str, typer.Option(help="What the search believes of the errors: joint (new missions) or independent.")
    ] = "joint",
    flights: Annotated[
        int,
        typer.Option(
            min=0,
            help="joint: flights before these, of the same sensor, from whose bearings alone it learns.",
        ),
    ] = 0,
    told: Annotated[
        bool, typer.Option("--told", help="joint: the search knows the true errors of the row, to compare with.")
    ] = False,
    planner: Annotated[
        str,
        typer.Option(help="Who chooses the places: fisher (information alone) or crossfix (the suggested mission's)."),
    ] = "fisher",
    shared: Annotated[
        bool,
        typer.Option("--shared-errors", help="tags: what one tag's bearings tell of the compass counts for all."),
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the first mission; mission k has the same world for all.")] = 1,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Fly the suggested mission in a world of errors and count what the claims were worth.

    Example: crossfix study truth --row bias5 --missions 200 --json
    """
    try:
        found = study_row(row, missions_, model, seed, flights, told, planner, shared)
    except StudyError as error:
        if json_:
            print_json({"error": str(error)})
        stop(error)
    if json_:
        print_json(found.as_json())
    else:
        typer.echo(sentence(found))


def study_row(
    row: str,
    count: int,
    model: str = "joint",
    first_seed: int = 1,
    flights: int = 0,
    told: bool = False,
    planner: str = "fisher",
    shared: bool = False,
) -> Truth:
    """Raises StudyError for names and numbers that make no sense. flights: that teach the sensor's errors before. told:
    the joint model knows the row's true errors. shared: all tags' bearings tell it of the compass."""
    known = known_model(model)
    if count < 1:
        raise StudyError(f"--missions must be 1 or more, got {count}")
    claims, knows = row_claims(row, range(first_seed, first_seed + count), known, flights, told, planner, shared)
    return replace(truth_of(row, known, claims, knows), planner=truth_planner(planner), shared=shared)


def row_claims(
    row: str,
    seeds: Sequence[int],
    model: Model = "joint",
    flights: int = 0,
    told: bool = False,
    planner: str = "fisher",
    shared: bool = False,
) -> tuple[list[Claim], str]:
    """Mission by mission of a row, every tag's where it has several, and what was known of the sensor before; arguments
    and errors as of `study_row`."""
    places = _check(row, model, flights, told, planner, shared)
    wanted = None if row in SPEEDS or row in TAGS else row_named(row)
    mission = suggested_mission(HOME)
    prior, knows = unknown_craft(mission.sensor.outlier_probability), UNKNOWN
    task = localization(mission, HOME)
    problem = replace(task.problem, measurement_time=MEASUREMENT_S)
    search = Search(problem, task.rule, (0.0, 0.0), mission.localization.maximum_bearings, places)
    if told and wanted is None:
        raise StudyError(f"{row}: --told goes with an emitter that stays where it is")
    if wanted is not None and told:
        prior, knows = true_errors(wanted), TOLD
    if wanted is not None and flights and model == "joint":
        prior = learn(search, wanted, range(FIRST_LESSON, FIRST_LESSON + flights), prior)
        knows = f"{flights} flights"
        remark(f"{row}: learned from {knows}")
    claims: list[Claim] = []
    flown: Iterator[list[Claim]]
    if row in TAGS:
        flown = tags_missions(row, seeds, model, shared=shared, prior=prior)
    elif wanted is None:
        flown = ([claim] for claim in moving_missions(search, row, seeds, model, prior))
    else:
        flown = ([claim] for claim in missions(search, wanted, seeds, model, prior))
    for number, found in enumerate(flown, start=1):
        claims.extend(found)
        if number % REMARK_EVERY == 0 and number < len(seeds):
            remark(f"{row}: {number} of {len(seeds)} missions")
    return claims, knows


def _check(row: str, model: Model, flights: int, told: bool, planner: str, shared: bool) -> TruthPlanner:
    """The planner's name, known. StudyError for options that do not go together."""
    if row not in (known := (*ROWS.by_name, *TAGS, *SPEEDS)):
        raise StudyError(f"there is no row {row!r}: choose one of {', '.join(known)}")
    if flights and (model != "joint" or row in TAGS or row in SPEEDS):
        raise StudyError("--flights goes with the joint model of one emitter that stays where it is")
    if told and (model != "joint" or flights or row in TAGS):
        raise StudyError("--told goes with the joint model of one emitter, and without --flights")
    places = truth_planner(planner)
    if places != "fisher" and (row in TAGS or row in SPEEDS):
        raise StudyError(f"--planner goes with one emitter that stays where it is, not with {row}")
    if shared and (row not in TAGS or model != "joint"):
        raise StudyError("--shared-errors goes with the joint model of several tags")
    return places


def known_model(name: str) -> Model:
    """StudyError for a name that is not known."""
    for one in MODELS:
        if one == name:
            return one
    raise StudyError(f"there is no model {name!r}: choose one of {', '.join(MODELS)}")


def sentence(found: Truth) -> str:
    """For a terminal."""
    if not found.claimed:
        return f"{found.row}: none of {found.missions} missions said localized"
    known = "" if found.prior == UNKNOWN else f", {found.prior} known before"
    known += ", shared by all tags" if found.shared else ""
    known += "" if found.first_s is None else f", the first tag after {found.first_s:.0f} s"
    known += "" if found.planner == "fisher" else f", planned by {found.planner}"
    return (
        f"{found.row}, {found.model} errors{known}: {found.missions} missions, "
        f"{found.claimed:.1%} localized in {found.mean_s:.0f} s with {found.bearings_mean:.1f} bearings; "
        f"truth in C95 {found.in_c95:.1%} [{found.in_c95_low:.1%}, {found.in_c95_high:.1%}], beyond three times stated "
        f"{found.beyond_3x:.1%} [{found.beyond_low:.1%}, {found.beyond_high:.1%}], by the beliefs themselves "
        f"{found.beyond_believed:.1%} (error {found.error_mean_m:.1f} m, stated {found.stated_mean_m:.1f} m)"
    )
