"""Whole searches in the field world, all rows in the same worlds, mission by mission (figures 24).

    python -m tests.benchmarks.field_world --missions 100 --seed 1 --kept FOLDER
    python -m tests.benchmarks.field_world --missions 2 --rows whole,sector        a short look

Mission k of every row has the same world and the same chance. Each is kept as a line of FOLDER as soon as it was flown,
so that a study that was broken off tells what it has, in pairs, and goes on from there.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from backend.cli.field_missions import FieldMission, FieldOptions, FieldStudy, summary
from backend.cli.field_study import HEADING_SIGMA_DEG
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

ROWS: Mapping[str, FieldOptions] = {
    "whole": FieldOptions(),
    "sector": FieldOptions(turns="sector"),
    "swings": FieldOptions(turns="sector", listens="way_swinging"),
    "fisher": FieldOptions("fisher"),
    "entpp": FieldOptions("entpp"),
    "entropy_of_nine": FieldOptions("entropy_of_nine"),
    "random_walk": FieldOptions("random_walk"),
}
"""The first is what the others are compared with."""
AGAINST = "whole"
JUDGED = {"sector": "adaptive_turns", "swings": "listening"}
LATE_S = 400.0
COLUMNS = (
    Column(name="row"),
    Column(name="missions"),
    Column(name="time, s", decimals=0),
    Column(name=f"longer than {AGAINST}, s", decimals=0),
    Column(name="90 %, s", decimals=0),
    Column(name=f"localized in {LATE_S:.0f} s, %", decimals=0),
    Column(name="truth in C95 at the claim, %", decimals=0),
    Column(name="its 95 % interval"),
    Column(name="beyond 3 x stated, %", decimals=1),
    Column(name="turned, degrees", decimals=0),
    Column(name="energy, kJ", decimals=0),
    Column(name="bearings", decimals=1),
)


def flown(names: Sequence[str], seeds: range, kept: Path | None) -> dict[str, dict[int, FieldMission]]:
    """By row and seed. kept: folder of what was flown before, and of what is."""
    found = {name: _kept(kept, name) for name in names}
    studies = dict[str, FieldStudy]()
    for seed in seeds:
        for name in names:
            if seed not in found[name]:
                if name not in studies:
                    studies[name] = FieldStudy.of(ROWS[name], HEADING_SIGMA_DEG)
                found[name][seed] = studies[name].fly(seed)
                _keep(kept, name, found[name][seed])
                print(f"{name} {seed}: {found[name][seed].time_s:.0f} s", file=sys.stderr, flush=True)
    return {name: {seed: found[name][seed] for seed in seeds} for name in names}


def _kept(folder: Path | None, name: str) -> dict[int, FieldMission]:
    path = None if folder is None else folder / f"{name}.jsonl"
    if path is None or not path.exists():
        return {}
    told = [json.loads(line) for line in path.read_text().splitlines()]
    return {one["seed"]: FieldMission(**{**one, "off_deg": tuple(one["off_deg"])}) for one in told}


def _keep(folder: Path | None, name: str, mission: FieldMission) -> None:
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        with (folder / f"{name}.jsonl").open("a") as file:
            file.write(json.dumps(asdict(mission)) + "\n")


def paired(missions: Mapping[int, FieldMission], against: Mapping[int, FieldMission]) -> tuple[float, float]:
    """Mean seconds longer than the other row on the same seeds, and half the 95 % interval; at least two missions."""
    longer = np.array([missions[seed].time_s - against[seed].time_s for seed in missions])
    return float(longer.mean()), float(1.96 * longer.std(ddof=1) / math.sqrt(len(longer)))


def row(name: str, found: Mapping[str, Mapping[int, FieldMission]]) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    missions = list(found[name].values())
    told = summary(ROWS[name], missions)
    in_time = np.mean([m.localized and m.time_s <= LATE_S for m in missions])
    claimed = not math.isnan(told.in_c95)
    return (
        name,
        told.missions,
        (told.time_s, told.time_ci95_s),
        None if name == AGAINST or AGAINST not in found else paired(found[name], found[AGAINST]),
        told.time_90_s,
        float(100.0 * in_time),
        100.0 * told.in_c95 if claimed else None,
        f"{100.0 * told.in_c95_low:.0f} to {100.0 * told.in_c95_high:.0f}" if claimed else None,
        100.0 * told.false_claims if claimed else None,
        told.turned_deg,
        told.energy_kj,
        told.bearings,
    )


def figures(found: Mapping[str, Mapping[int, FieldMission]]) -> list[Figure]:
    """How far each way of turning is ahead, whatever its coverage: the table says that beside it."""
    made = list[Figure]()
    for name, missions in found.items():
        told, note = summary(ROWS[name], list(missions.values())), f"{len(missions)} missions"
        half = round(told.time_ci95_s, 1)
        made.append(plain(f"time until the claim, {name}", round(told.time_s), "s", ci95=half, note=note))
        if name in JUDGED and AGAINST in found:
            longer, half = paired(missions, found[AGAINST])
            note = f"{len(missions)} pairs"
            made.append(wanted(JUDGED[name], round(-longer, 1), ci95=round(half, 1), note=note))
    return made


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=100, help="at least 2")
    parser.add_argument("--seed", type=int, default=1, help="of the first mission")
    parser.add_argument("--rows", default=",".join(ROWS))
    parser.add_argument("--kept", type=Path, help="folder that keeps each mission, to go on from")
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    found = flown(arguments.rows.split(","), range(arguments.seed, arguments.seed + arguments.missions), arguments.kept)
    table = Table(name="rows", columns=COLUMNS, rows=tuple(row(name, found) for name in found))
    print(markdown(table))
    title = "The field world, in pairs"
    write(arguments.out, "study_field_world", title, begun, figures(found), tables=[table], page="planner-studies.md")


if __name__ == "__main__":
    main()
