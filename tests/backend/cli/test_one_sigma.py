"""`crossfix sweep`, `crossfix localize` and a flight state the same sigma of the same sweep."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from backend.cli.localize import localize
from backend.cli.sweep import sweep
from backend.events import BearingMeasured, CraftSource
from backend.search.sweep_facts import Taken, sweep_fact
from backend.settings import settings_of
from backend.spec import SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.comparison import beam, known_right
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import borrowed_pattern, load_pattern, save_pattern
from hardware.direction_finding.recordings import mounted
from hardware.sdr.rotation import IqReading, read_sweeps
from tests.benchmarks.pattern_mismatch import Mismatch, deformed, lumpy, sweep_of

NOMINAL = beam(60.0)
BORROWED = borrowed_pattern()
SWEEP, LOCALIZE = typer.Typer(), typer.Typer()
SWEEP.command()(sweep)
LOCALIZE.command()(localize)


@pytest.mark.parametrize(
    ("heard", "pattern", "echoes_db"),
    [
        (NOMINAL, known_right(NOMINAL), ()),
        (NOMINAL, known_right(NOMINAL), (-6.0, -6.0, -6.0)),
        (deformed(60.0, left=0.75, right=1.25), NOMINAL, ()),
        (lumpy(), BORROWED, ()),
    ],
    ids=["checked", "checked, three echoes", "unchecked, uneven flanks", "borrowed"],
)
def test_everybody_states_the_same_sigma(
    tmp_path: Path, heard: AntennaPattern, pattern: AntennaPattern, echoes_db: tuple[float, ...]
) -> None:
    rng = np.random.default_rng(11)
    made = sweep_of(Mismatch("", heard, pattern, echoes_db), 36, math.inf, 75.0, rng)
    file = tmp_path / "turn.csv"
    rows = zip(made.heading_deg, made.power_db, strict=True)
    file.write_text("\n".join(["heading_deg,power_db", *(f"{h:.6f},{p:.6f}" for h, p in rows)]))
    known = [] if pattern is BORROWED else ["--pattern", str(tmp_path / "antenna.json")]
    if known:
        save_pattern(pattern, tmp_path / "antenna.json")
        pattern = load_pattern(tmp_path / "antenna.json")  # rounded

    told = json.loads(CliRunner().invoke(SWEEP, [str(file), *known, "--at", "50.6,7.2", "--json"]).stdout)

    recorded = read_sweeps(file, None, IqReading(None, None, None)).sweeps[0]
    finder = SparseDirectionFinder(heading_sigma_deg=settings_of().heading_sigma_deg)  # as backend.wiring makes it
    reading = finder.estimate(recorded.sweep, mounted(pattern, recorded, None))
    fact = sweep_fact(
        Taken("emitter-1", CraftSource(craft_id="craft-1"), "s1", 1, 1), SensorSpec(), recorded.sweep, reading, 12.0
    )
    assert isinstance(fact, BearingMeasured)
    assert told["sigma_deg"] == pytest.approx(fact.sigma_deg, abs=1e-3)
    assert told["bearing_deg"] == pytest.approx(fact.bearing_deg, abs=1e-3)

    bearings = tmp_path / "bearings.csv"
    bearings.write_text(f"lat,lon,bearing_deg,sigma_deg\n50.6,7.2,{told['bearing_deg']},{told['sigma_deg']}\n")
    located = json.loads(CliRunner().invoke(LOCALIZE, [str(bearings), "--json"]).stdout)
    assert located["sigma_deg"] == pytest.approx(fact.sigma_deg, abs=6e-3)
