"""Whole searches in the field world, all rows in the same worlds, mission by mission (figures 24).

    python -m tests.benchmarks.field_world --missions 100 --seed 1 --pieces FOLDER
    python -m tests.benchmarks.field_world --missions 2 --rows whole,sector        a short look
    python -m tests.benchmarks.field_world --missions 60 --claims 240 --compass 0,8 --antennas yagi,wide --pieces FOLDER

Mission k of every row has the same world and the same chance. Each is kept as a line of FOLDER as soon as it was flown,
so that a study that was broken off tells what it has, in pairs, and goes on from there; --told reads what FOLDER has
and flies nothing.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np

from backend.cli.field_lessons import taught
from backend.cli.field_missions import LATE_S, FieldMission, FieldOptions, FieldStudy
from backend.cli.field_summary import FieldSummary, summary
from backend.simulation.field_world import Antenna
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

ROWS: Mapping[str, FieldOptions] = {
    "whole": FieldOptions(),
    "sector": FieldOptions(turns="sector"),
    "swings": FieldOptions(turns="sector", listens="way_swinging"),
    "swings_whole": FieldOptions(listens="way_swinging"),
    "never_stopping": FieldOptions(listens="never_stopping"),
    "wedge": FieldOptions(errors="independent"),
    "widened": FieldOptions(errors="independent"),
    "fisher": FieldOptions("fisher"),
    "entpp": FieldOptions("entpp"),
    "entropy_of_nine": FieldOptions("entropy_of_nine"),
    "random_walk": FieldOptions("random_walk"),
    "gyration": FieldOptions("gyration"),
    "taught": FieldOptions(flights=30),
    "taught_sector": FieldOptions(turns="sector", flights=30),
    "taught_swings": FieldOptions(turns="sector", listens="way_swinging", flights=30),
}
"""taught: after thirty flights of the craft, which its bearings are learned from. wedge: each bearing by itself, as
before errors were estimated with the place; widened: its sigmas multiplied by what `WIDENINGS` has for the setting.
wedge*1.5 is a row, too: multiplied by that."""
WIDENINGS = Path(__file__).parents[2] / "docs" / "measurements" / "study_field_widening.json"
"""How much wider a wedge has to be, for C95 at the claim to hold the truth as often as it says: as
tests.benchmarks.field_widening found it, on seeds on which no row is flown."""
WIDENING = "sigma times, "
AGAINST, WIDE = "whole", "widened"
JUDGED = {"sector": "adaptive_turns", "swings": "listening"}
"""Ahead of the widened wedge."""
NEW = "swings"
"""What new missions do."""
COLUMNS = (
    Column(name="compass off, degrees"),
    Column(name="antenna"),
    Column(name="row"),
    Column(name="missions"),
    Column(name="time, s", decimals=0),
    Column(name=f"longer than {AGAINST}, s", decimals=0),
    Column(name=f"longer than {WIDE}, s", decimals=0),
    Column(name="90 %, s", decimals=0),
    Column(name=f"localized in {LATE_S:.0f} s, %", decimals=0),
    Column(name="truth in C95 at the claim, %", decimals=0),
    Column(name="its 95 % interval"),
    Column(name="beyond 3 x stated, %", decimals=1),
    Column(name="turned, degrees", decimals=0),
    Column(name="energy, kJ", decimals=0),
    Column(name="bearings", decimals=1),
)


@dataclass(frozen=True, slots=True)
class Setting:
    """What a row is flown with. compass_deg: to either side; None: another in each mission, sd 4 degrees."""

    compass_deg: float | None = None
    antenna: Antenna = "yagi"

    @property
    def name(self) -> str:
        """As its missions are kept."""
        return f"{self.antenna}, {'compass sd 4' if self.compass_deg is None else f'compass {self.compass_deg:g}'}"

    def options(self, row: str) -> FieldOptions:
        """Of a row flown so. ValueError for a widened wedge where nobody found how wide."""
        base, _, factor = row.partition("*")
        widened = float(factor) if factor else widening_in(self) if row == WIDE else 1.0
        return replace(ROWS[base], compass_deg=self.compass_deg, antenna=self.antenna, sigma_factor=widened)


def widening_in(setting: Setting) -> float:
    """As recorded; ValueError when it is not."""
    told = json.loads(WIDENINGS.read_text())["figures"] if WIDENINGS.exists() else []
    found = {one["name"].partition(WIDENING)[2]: one["value"] for one in told}
    if setting.name not in found:
        raise ValueError(f"no wedge as wide as true is recorded for {setting.name}: field_widening finds it")
    return float(found[setting.name])


Flown = Mapping[str, Mapping[int, FieldMission]]
"""By row and seed, in one setting."""


def flown(
    names: Sequence[str], settings: Sequence[Setting], seeds: range, kept: Path | None, told: bool = False
) -> dict[Setting, dict[str, dict[int, FieldMission]]]:
    """kept: folder of what was flown before, and of what is. told: nothing is flown; each setting has the seeds that
    all of its rows have."""
    found = {one: {name: _kept(kept, one, name) for name in names if _known(one, name)} for one in settings}
    studies = dict[tuple[Setting, str], FieldStudy]()
    for seed, one, name in product(() if told else seeds, settings, names):
        missions = found[one].get(name)
        if missions is None or seed in missions:
            continue
        if (one, name) not in studies:
            options = one.options(name)
            studies[one, name] = taught(FieldStudy.of(options), options.flights)
        missions[seed] = studies[one, name].fly(seed)
        _keep(kept, one, name, missions[seed])
        print(f"{one.name}, {name}, {seed}: {missions[seed].time_s:.0f} s", file=sys.stderr, flush=True)
    return {one: _common(rows, seeds) for one, rows in found.items()}


def _known(setting: Setting, name: str) -> bool:
    try:
        setting.options(name)
    except ValueError as error:
        print(f"{name} is left out: {error}", file=sys.stderr)
        return False
    return True


def _common(rows: Flown, seeds: range) -> dict[str, dict[int, FieldMission]]:
    """Rows of the seeds that all of those have that have any."""
    begun = {name: missions for name, missions in rows.items() if any(seed in missions for seed in seeds)}
    common = [seed for seed in seeds if all(seed in missions for missions in begun.values())]
    return {name: {seed: missions[seed] for seed in common} for name, missions in begun.items() if common}


def _path(folder: Path, setting: Setting, name: str) -> Path:
    name = f"wedge*{widening_in(setting):g}" if name == WIDE else name  # another factor is another row
    return folder / f"{name}, {setting.name}.jsonl".replace(", ", "-").replace(" ", "_")


def _kept(folder: Path | None, setting: Setting, name: str) -> dict[int, FieldMission]:
    if folder is None or not (path := _path(folder, setting, name)).exists():
        return {}
    told = [json.loads(line) for line in path.read_text().splitlines()]
    return {one["seed"]: _mission(**one) for one in told}


def _mission(
    *, off_deg: list[float], foretold: Sequence[tuple[int, float, float, float]] = (), **rest: Any
) -> FieldMission:
    plans = tuple((bearings, at_s, mean_s, in_90_s) for bearings, at_s, mean_s, in_90_s in foretold)
    return FieldMission(off_deg=tuple(off_deg), foretold=plans, **rest)


def _keep(folder: Path | None, setting: Setting, name: str, mission: FieldMission) -> None:
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        with _path(folder, setting, name).open("a") as file:
            file.write(json.dumps(asdict(mission)) + "\n")


def paired(missions: Mapping[int, FieldMission], against: Mapping[int, FieldMission]) -> tuple[float, float]:
    """Mean seconds longer than the other row on the same seeds, and half the 95 % interval; at least two missions."""
    longer = np.array([missions[seed].time_s - against[seed].time_s for seed in missions])
    return float(longer.mean()), float(1.96 * longer.std(ddof=1) / math.sqrt(len(longer)))


def row(setting: Setting, name: str, found: Flown) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    missions = list(found[name].values())
    told = summary(setting.options(name), missions)
    claimed = not math.isnan(told.in_c95)
    return (
        "sd 4" if setting.compass_deg is None else f"{setting.compass_deg:g}",
        setting.antenna,
        name,
        told.missions,
        (told.time_s, told.time_ci95_s),
        *(
            None if other not in found or other == name else paired(found[name], found[other])
            for other in (AGAINST, WIDE)
        ),
        told.time_90_s,
        100.0 * told.localized_in_time,
        100.0 * told.in_c95 if claimed else None,
        f"{100.0 * told.in_c95_low:.0f} to {100.0 * told.in_c95_high:.0f}" if claimed else None,
        100.0 * told.false_claims if claimed else None,
        told.turned_deg,
        told.energy_kj,
        told.bearings,
    )


def figures(settings: Mapping[Setting, Flown], claims: Mapping[Setting, Flown]) -> list[Figure]:
    """How far each way of turning is ahead, whatever its coverage: the table says that beside it. claims: with the row
    of new missions, flown on more seeds than what is compared."""
    made = list[Figure]()
    for setting, found in settings.items():
        for name, missions in found.items():
            told, note = summary(setting.options(name), list(missions.values())), f"{len(missions)} missions"
            half = round(told.time_ci95_s, 1)
            of = f"{name}, {setting.name}"
            made.append(plain(f"time until the claim, {of}", round(told.time_s), "s", ci95=half, note=note))
            if name in JUDGED and WIDE in found:
                longer, half = paired(missions, found[WIDE])
                note = f"{len(missions)} pairs"
                made.append(wanted(JUDGED[name], round(-longer, 1), of=setting.name, ci95=round(half, 1), note=note))
            if name == NEW and NEW in (of_new := claims.get(setting, {})):
                made += _how_true(summary(setting.options(NEW), list(of_new[NEW].values())), setting)
    return made


def _how_true(told: FieldSummary, setting: Setting) -> list[Figure]:
    low, high = 100.0 * told.in_c95_low, 100.0 * told.in_c95_high
    note = f"{told.missions} missions"
    return [
        wanted("field_claims", round(100.0 * told.localized_in_time, 1), of=setting.name, note=note),
        wanted("field_truth", round(100.0 * told.in_c95, 1), of=setting.name, note=f"{note}: {low:.0f} to {high:.0f}"),
        wanted("field_beyond", round(100.0 * told.false_claims, 1), of=setting.name, note=note),
    ]


def settings_of(compasses: str, antennas: str) -> list[Setting]:
    """compasses: degrees or `sd`, antennas: names; each with commas between."""
    named = [name for name in antennas.split(",") if name in get_args(Antenna)]
    off = [None if one == "sd" else float(one) for one in compasses.split(",")]
    return [Setting(compass_deg, cast(Antenna, antenna)) for antenna in named for compass_deg in off]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=100, help="at least 2")
    parser.add_argument("--seed", type=int, default=1, help="of the first mission")
    parser.add_argument("--claims", type=int, default=0, help="of new missions, for what they claim; if more")
    parser.add_argument("--rows", default=",".join(ROWS))
    parser.add_argument(
        "--compass", default="sd", help="how far it is off, degrees, or sd: 4 degrees in the mean square"
    )
    parser.add_argument("--antennas", default="yagi", help="yagi, wide")
    parser.add_argument("--pieces", type=Path, help="folder that keeps each mission, to go on from")
    parser.add_argument("--told", action="store_true", help="fly nothing")
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    seeds = range(arguments.seed, arguments.seed + arguments.missions)
    settings = settings_of(arguments.compass, arguments.antennas)
    names = arguments.rows.split(",")
    found = flown(names, settings, seeds, arguments.pieces, arguments.told)
    more = range(arguments.seed, arguments.seed + max(arguments.missions, arguments.claims))
    claims = flown([NEW] if NEW in names else [], settings, more, arguments.pieces, arguments.told)
    rows = tuple(row(setting, name, rows) for setting, rows in found.items() for name in rows)
    table = Table(name="rows", columns=COLUMNS, rows=rows)
    print(markdown(table))
    title = "The field world, in pairs"
    write(
        arguments.out,
        "study_field_world",
        title,
        begun,
        figures(found, claims),
        tables=[table],
        page="planner-studies.md",
    )


if __name__ == "__main__":
    main()
