"""What loops of kills found, as a summary, as figures and as rows of the page's table (figures 8 and 21)."""

from __future__ import annotations

import statistics
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from tests.benchmarks.figures.circumstances import Begun
from tests.benchmarks.figures.pieces import SEED, count, numbers
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import plain, wanted

HOLD_WITHIN_S = 5.0
IDLE_LOAD, HIGH_LOAD = 1.0, 12.0
FORKED, WHOLE = "forked server to HOLD, s", "whole `crossfix serve` to HOLD, s"
COLUMNS = (
    *(Column(name=name) for name in ("run", "kills", "facts shown before a kill", "of them bearings")),
    *(Column(name=name) for name in ("lost or changed", "beliefs compared", "changed")),
    *(Column(name=f"{FORKED}: {which}", decimals=2) for which in ("median", "most")),
    *(Column(name=f"{WHOLE}: {which}", decimals=1) for which in ("median", "most")),
    *(Column(name=name) for name in ("whole starts", "taken for a pilot", SEED, "commit")),
)


@dataclass
class Findings:
    kills: int = 0
    phases: Counter[str] = field(default_factory=Counter)
    found_in: Counter[str] = field(default_factory=Counter)
    acknowledged: int = 0
    bearings: int = 0
    missions: int = 0
    lost: int = 0
    beliefs_compared: int = 0
    beliefs_changed: int = 0
    late_failsafes: int = 0
    taken_for_a_pilot: int = 0
    hold_s: dict[str, list[float]] = field(default_factory=lambda: {"forked": [], "whole": []})
    """From the start of the server until the page can read that the mission holds."""
    told_s: dict[str, list[float]] = field(default_factory=lambda: {"forked": [], "whole": []})
    """Until the vehicle was told to."""

    def summary(self) -> dict[str, Any]:
        def spread(values: list[float]) -> dict[str, float] | None:
            ordered = sorted(values)
            if not ordered:
                return None
            median, worst = ordered[len(ordered) // 2], ordered[-1]
            return {"starts": len(ordered), "median": round(median, 2), "most": round(worst, 2)}

        return {
            "kills": self.kills,
            "killed_in": dict(self.phases.most_common()),
            "found_in": dict(self.found_in.most_common()),
            "missions": self.missions,
            "acknowledged_facts": self.acknowledged,
            "acknowledged_bearings": self.bearings,
            "lost_or_changed_facts": self.lost,
            "beliefs_compared": self.beliefs_compared,
            "beliefs_changed": self.beliefs_changed,
            "failsafes_right_after_a_restart": self.late_failsafes,
            "taken_for_a_pilot": self.taken_for_a_pilot,
            "start_to_hold_s": {kind: spread(values) for kind, values in self.hold_s.items()},
            "start_to_vehicle_told_s": {kind: spread(values) for kind, values in self.told_s.items()},
        }

    @property
    def good(self) -> bool:
        late = [s for values in self.hold_s.values() for s in values if s > HOLD_WITHIN_S]
        return not (self.lost or self.beliefs_changed or self.taken_for_a_pilot or late)


def figures(found: Findings, runs: Table, database: str, load_before: float) -> list[Figure]:
    """Counts of all runs, times of a whole start of this one. load_before: the machine's own, without this benchmark;
    it says which bound a whole start has."""
    note = f"{len(runs.rows)} runs together" if len(runs.rows) > 1 else ""
    forked, killed = numbers(runs, f"{FORKED}: most"), count(runs, "kills")
    made = [
        wanted("kills", killed, of=database, note=note)
        if forked
        else plain("kills -9 before whole starts", killed, ""),
        wanted("kill_lost", count(runs, "lost or changed"), of=database, note=note),
        wanted("kill_beliefs", count(runs, "changed"), of=database, note=note),
        plain("acknowledged facts", count(runs, "facts shown before a kill"), ""),
        plain("of them bearings", count(runs, "of them bearings"), ""),
        plain("beliefs compared", count(runs, "beliefs compared"), ""),
        plain("failsafes taken for a pilot", count(runs, "taken for a pilot"), ""),
    ]
    if forked:
        made.append(wanted("restart", round(max(forked), 2), of=database, note=note))
    made += _whole_starts(found, database, load_before)
    return made


def _whole_starts(found: Findings, database: str, load_before: float) -> list[Figure]:
    made: list[Figure] = []
    if whole := found.hold_s["whole"]:
        most, note = round(max(whole), 2), f"starts: {len(whole)}"
        if load_before < IDLE_LOAD:
            made.append(wanted("start_idle", most, of=database, note=note))
        elif load_before >= HIGH_LOAD:
            made.append(wanted("start_loaded", most, of=database, note=note))
        else:
            made.append(plain("whole start to HOLD, at most", most, "s", note=note))
        made.append(plain("whole start to HOLD, median", round(statistics.median(whole), 2), "s"))
    if found.told_s["whole"]:
        told = found.told_s["whole"]
        most, note = round(max(told), 2), f"starts: {len(told)}; load {load_before:.1f}"
        if load_before < IDLE_LOAD:
            made.append(wanted("hold_order_idle", most, of=database, note=note))
        elif load_before >= HIGH_LOAD:
            made.append(wanted("hold_order_loaded", most, of=database, note=note))
        else:
            made.append(plain("whole start to the hold order at the vehicle, at most", most, "s", note=note))
        median = round(statistics.median(told), 2)
        made.append(plain("whole start to the hold order at the vehicle, median", median, "s", note=note))
    return made


def runs(found: Findings, begun: Begun, seed: int) -> Table:
    """The run as the one row of a table."""

    def spread(values: list[float]) -> tuple[Cell, Cell]:
        return (statistics.median(values), max(values)) if values else (None, None)

    row = (
        *(f"{begun.date}, load {begun.load:.1f}", found.kills, found.acknowledged, found.bearings),
        *(found.lost, found.beliefs_compared, found.beliefs_changed),
        *(*spread(found.hold_s["forked"]), *spread(found.hold_s["whole"]), len(found.hold_s["whole"])),
        *(found.taken_for_a_pilot, seed, begun.commit),
    )
    return Table(name="runs", columns=COLUMNS, rows=(row,))
