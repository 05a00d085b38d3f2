"""How far a replayed belief of another build lies from that of this one (figure 9).

python -m tests.benchmarks.replay_elsewhere --missions 30

Missions of the field world are flown, and what was known at each decision (bearings and stretches of way) is folded
again twice: as the code is compiled for this processor, and as it is for an x86-64 of 2003, where numba compiles
without AVX and FMA and numpy keeps to the code that it has for old processors.
"""

from __future__ import annotations

import argparse
import json
import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from backend.cli.field_missions import FieldOptions, FieldStudy
from backend.events import BearingMeasured
from backend.search.localization import Localization
from planner.belief.grid import GridBelief
from planner.on_the_way import Stretch
from planner.types import FloatArray
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

OLD_PROCESSOR = {
    "NUMBA_CPU_NAME": "x86-64",
    "NUMBA_CPU_FEATURES": "",
    "NPY_DISABLE_CPU_FEATURES": "AVX512F AVX512CD AVX512_SKX AVX2 FMA3",
}
OPTIONS = FieldOptions(turns="sector", listens="way_swinging", compass_deg=8.0)

Known = tuple[Sequence[BearingMeasured], tuple[Stretch, ...]]
"""What a decision rests on."""


@dataclass(slots=True)
class Watched(FieldStudy):
    """Flies missions and keeps what each decision rested on."""

    known: list[Known] = field(default_factory=list[Known])

    def _choose(
        self,
        task: Localization,
        belief: GridBelief,
        measured: Sequence[BearingMeasured],
        here: tuple[float, float],
        rng: np.random.Generator,
        avoid: Sequence[tuple[float, float]] = (),
    ) -> tuple[tuple[float, float], FloatArray]:
        self.known.append((tuple(measured), task.stretches))
        return FieldStudy._choose(self, task, belief, measured, here, rng, avoid)


def flown(seeds: range) -> list[Known]:
    study = Watched.of(OPTIONS)
    assert isinstance(study, Watched)
    for seed in seeds:
        study.fly(seed)
    return study.known


def folded(known: Sequence[Known]) -> list[GridBelief]:
    """The belief at each decision."""
    task = FieldStudy.of(OPTIONS).task
    beliefs = list[GridBelief]()
    for measured, stretches in known:
        belief = replace(task, stretches=stretches).belief(task.planner_bearings(measured))
        assert belief is not None
        beliefs.append(belief)
    return beliefs


def folded_by_another_build(known: Sequence[Known]) -> list[GridBelief]:
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "beliefs"
        made.write_bytes(pickle.dumps(known))
        command = [sys.executable, "-m", "tests.benchmarks.replay_elsewhere", "--only-fold", str(made)]
        subprocess.run(command, check=True, env=os.environ | OLD_PROCESSOR | {"NUMBA_CACHE_DIR": folder})
        return pickle.loads(made.read_bytes())


def apart(one: GridBelief, other: GridBelief) -> float:
    """The largest difference of two cells, of the largest mass of one; 1 where their grids differ."""
    if one.density.shape != other.density.shape or not np.allclose(one.bounds, other.bounds, rtol=1e-9, atol=1e-9):
        return 1.0
    return float(np.max(np.abs(one.density - other.density)) / np.max(one.density))


def figures(here: Sequence[GridBelief], there: Sequence[GridBelief], missions: int) -> list[Figure]:
    found = [apart(one, other) for one, other in zip(here, there, strict=True)]
    note = f"at most, {len(found)} beliefs of {missions} missions, bearings and legs"
    return [
        wanted("replay_elsewhere", float(f"{max(found):.2g}"), note=note),
        plain("median of them", float(f"{np.median(found):.2g}"), ""),
        plain("beliefs that are the same to the last bit", sum(one == 0.0 for one in found), ""),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1, help="of the first mission")
    parser.add_argument("--only-fold", type=Path, metavar="FILE", help="make beliefs of what this file knows")
    add_out(parser)
    given = parser.parse_args()
    if given.only_fold is not None:
        given.only_fold.write_bytes(pickle.dumps(folded(pickle.loads(given.only_fold.read_bytes()))))
        return
    begun = begin(__file__)
    known = flown(range(given.seed, given.seed + given.missions))
    found = figures(folded(known), folded_by_another_build(known), given.missions)
    print(json.dumps({figure.name: figure.value for figure in found}, indent=2))
    write(given.out, "replay_elsewhere", "Replay on another build", begun, found)


if __name__ == "__main__":
    main()
