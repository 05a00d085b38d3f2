"""`crossfix study run --scenario field-world`: rows of whole searches, mission k in the same world for all planners."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import product
from typing import Any, cast, get_args

import typer

from backend.cli.edge import print_json, remark
from backend.cli.field_gyration import GYRATION
from backend.cli.field_legs import Listens
from backend.cli.field_lessons import taught
from backend.cli.field_missions import AS_FLOWN, PLANNERS, FieldMission, FieldOptions, FieldStudy, Turns
from backend.cli.field_summary import FieldSummary, summary
from backend.simulation.field_world import Antenna
from backend.spec import MissionSpec
from planner.study.errors import StudyError
from planner.study.spread import spread

REMARK_EVERY = 20
COLUMNS = (
    "planner",
    "turns",
    "listens",
    "missions",
    "time, s",
    "90 %",
    "localized",
    "C95 at the claim",
    "false claims",
    "turned",
    "energy",
)


@dataclass(frozen=True, slots=True)
class FieldWays:
    """What the rows differ in: each planner with each way of turning and of listening. turns, listens: where neither is
    named, crossfix does as in new missions."""

    planners: Sequence[str]
    turns: Sequence[str]
    listens: Sequence[str]

    def rows(self) -> Iterator[tuple[str, str, str]]:
        """Planner, turns and listens of each."""
        for planner in self.planners:
            if planner == "crossfix" and not self.turns and not self.listens:
                yield planner, *AS_FLOWN
            elif planner == GYRATION:  # it never stops to turn, and goes round wherever it is: there is one way
                yield planner, "whole", "places"
            else:
                yield from product((planner,), self.turns or ("whole",), self.listens or ("places",))


@dataclass(frozen=True, slots=True)
class FieldSetting:
    """What all rows have in common, as in `FieldOptions`."""

    turn_rate_deg_s: float
    compass_sd_deg: float
    compass_deg: float | None
    antenna: str
    flights: int


def field_rows(
    ways: FieldWays, setting: FieldSetting, runs: int, seed: int, workers: int, scheduler: str | None, json_: bool
) -> None:
    """Flies and prints the rows. seed: of the first mission. workers, scheduler: as in `spread`. Raises StudyError for
    what cannot be flown."""
    if not 5.0 <= setting.turn_rate_deg_s <= 90.0:
        raise StudyError(f"--turn-rate must be 5 to 90 degrees a second, got {setting.turn_rate_deg_s:g}")
    for option, given_deg in (("sd", setting.compass_sd_deg), ("bias", setting.compass_deg)):
        if given_deg is not None and not 0.0 <= given_deg <= 60.0:
            raise StudyError(f"--compass-{option} must be 0 to 60 degrees, got {given_deg:g}")
    for planner in ways.planners:
        if planner not in PLANNERS:
            raise StudyError(f"field-world has no planner {planner!r}: choose one of {', '.join(PLANNERS)}")
    choices = (
        ("turns", ways.turns, Turns),
        ("listens", ways.listens, Listens),
        ("antenna", [setting.antenna], Antenna),
    )
    for option, given, known in choices:
        for way in given:
            if way not in get_args(known):
                raise StudyError(f"--{option} must be one of {', '.join(get_args(known))}, got {way!r}")
    rows = [
        _row(
            FieldOptions(
                planner,
                cast(Turns, turns),
                cast(Listens, listens),
                setting.turn_rate_deg_s,
                setting.compass_sd_deg,
                setting.compass_deg,
                cast(Antenna, setting.antenna),
                flights=setting.flights,
            ),
            runs,
            seed,
            workers,
            scheduler,
        )
        for planner, turns, listens in ways.rows()
    ]
    if json_:
        answers = [row.as_json() for row in rows]
        print_json(answers[0] if len(answers) == 1 else answers)
        return
    typer.echo(" | ".join(COLUMNS))
    for row in rows:
        typer.echo(" | ".join(_cells(row)))


def _row(options: FieldOptions, runs: int, seed: int, workers: int, scheduler: str | None) -> FieldSummary:
    spec = taught(FieldStudy.of(options), options.flights).spec
    flown: list[FieldMission] = []
    for (mission,) in spread(
        partial(_fly, options, spec.model_dump_json()),
        [[number] for number in range(seed, seed + runs)],
        workers,
        scheduler,
    ):
        flown.append(mission)
        if len(flown) % REMARK_EVERY == 0 and len(flown) < runs:
            remark(f"{options.planner}, {options.turns}, {options.listens}: {len(flown)} of {runs} missions")
    return summary(options, sorted(flown, key=lambda mission: mission.seed))


def _fly(options: FieldOptions, spec: str, numbers: list[int]) -> list[FieldMission]:
    study = _prepared(options, spec)
    return [study.fly(number) for number in numbers]


@lru_cache(maxsize=1)
def _prepared(options: FieldOptions, spec: str) -> FieldStudy:
    return FieldStudy.of(options, MissionSpec.model_validate_json(spec))


def _cells(row: FieldSummary) -> tuple[str, ...]:
    facts: dict[str, Any] = row.as_json()

    def percent(name: str) -> str:
        return "none" if facts[name] is None else f"{100.0 * facts[name]:.1f} %"

    return (
        row.options.planner,
        row.options.turns,
        row.options.listens,
        str(row.missions),
        f"{row.time_s:.1f} ± {row.time_ci95_s:.1f}",
        f"{row.time_90_s:.0f}",
        percent("localized"),
        f"{percent('in_c95')} [{percent('in_c95_low')}, {percent('in_c95_high')}]",
        percent("false_claims"),
        f"{row.turned_deg:.0f}°",
        f"{row.energy_kj:.0f} kJ",
    )
