"""What the strikes came to: a line each, counts by scene, means and delay, and figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import plain, wanted
from tests.strikes.strike import NOTICED_S, Outcome


def unnoticed(outcome: Outcome) -> bool:
    return outcome.unaware_s is None or outcome.unaware_s > NOTICED_S


def spoke_late(outcome: Outcome) -> bool:
    """A flight command reached the vehicle later than a second after it was taken, and what the link takes."""
    return outcome.last_command_s > NOTICED_S + outcome.delay_s + (outcome.took_s or 0.0)


def line(outcome: Outcome, flown: int) -> str:
    """For a person who watches the run."""
    noticed = "never noticed" if outcome.noticed_s is None else f"noticed {outcome.noticed_s:.2f} s"
    took = "did not take" if outcome.took_s is None else f"took {outcome.took_s:.3f} s"
    undone = f"UNDONE to {outcome.back_to:#x} (the pilot's is {flown:#x})" if outcome.back_to is not None else "stays"
    why = f", {_told(outcome)}" if outcome.counts and (outcome.undone or unnoticed(outcome)) else ""
    return (
        f"{outcome.scene:9} {outcome.moment:10} {outcome.means:6} {outcome.delay_s * 1e3:4.0f} ms: {took}, {undone}, "
        f"{noticed}, {outcome.commands} commands afterwards, the last {outcome.last_command_s:.2f} s"
        f"{why}" + "".join(f"\n    {event}" for event in outcome.story)
    )


def _told(outcome: Outcome) -> str:
    """Why it was undone or noticed late: what the autopilot told, how long this process stood still, what we knew."""
    told = "the autopilot never told its mode" if outcome.told_s is None else f"told after {outcome.told_s:.2f} s"
    failsafe = ", a failsafe of its own acted" if outcome.failsafe else ""
    return (
        f"{told}{failsafe}, this process stood still for {outcome.stalled_s:.2f} s and delivered "
        f"{outcome.held_up_s:.2f} s late at most, in the end: {outcome.known}"
    )


def summary(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    counted = [outcome for outcome in outcomes if outcome.counts]
    return {
        "struck": len(outcomes),
        "took": len(counted),
        "undone": sum(outcome.undone for outcome in counted),
        "unnoticed": sum(map(unnoticed, counted)),
        "never_told": sum(outcome.told_s is None for outcome in counted),
        "undone_unnoticed": sum(outcome.undone and unnoticed(outcome) for outcome in counted),
        "late_commands": sum(map(spoke_late, counted)),
        "slowest_notice_s": max((o.unaware_s for o in counted if o.unaware_s is not None), default=None),
        "latest_command_s": max((o.last_command_s for o in counted), default=None),
        "by": [dict(zip((c.name for c in table(outcomes).columns), row, strict=True)) for row in table(outcomes).rows],
    }


def table(outcomes: Sequence[Outcome]) -> Table:
    groups: dict[tuple[str, str, float], list[Outcome]] = {}
    for outcome in outcomes:
        if outcome.counts:
            groups.setdefault((outcome.scene, outcome.means, outcome.delay_s), []).append(outcome)
    rows = [
        (
            scene,
            means,
            round(delay_s * 1e3),
            len(group),
            sum(outcome.undone for outcome in group),
            sum(map(unnoticed, group)),
            sum(outcome.told_s is None for outcome in group),
            max((o.unaware_s for o in group if o.unaware_s is not None), default=None),
            max(outcome.last_command_s for outcome in group),
        )
        for (scene, means, delay_s), group in sorted(groups.items())
    ]
    columns = (
        Column(name="while"),
        Column(name="by"),
        Column(name="delay each way, ms"),
        Column(name="takeovers"),
        Column(name="undone"),
        Column(name="unnoticed for 1 s"),
        Column(name="never told by the autopilot"),
        Column(name="slowest notice, s", decimals=2),
        Column(name="last command, s after", decimals=2),
    )
    return Table(name="runs", columns=columns, rows=tuple(rows))


def figures(outcomes: Sequence[Outcome], flavour: str, by_nobody: int, orders: bool) -> list[Figure]:
    """orders: the strikes met orders that select a mode, which may undo them; by_nobody: takeovers told without one."""
    counted = [outcome for outcome in outcomes if outcome.counts]
    delays = ", ".join(f"{delay * 1e3:g}" for delay in sorted({outcome.delay_s for outcome in counted}))
    note = f"of {len(counted)} at {delays} ms each way"
    of = f"{flavour}, meeting orders of a mode" if orders else flavour
    undone = sum(outcome.undone for outcome in counted)
    return [
        plain("undone", undone, "", note=note) if orders else wanted("takeovers_undone", undone, of=of, note=note),
        wanted("takeovers_unnoticed", sum(map(unnoticed, counted)), of=of, note=note),
        plain("followed by a flight command later than 1 s", sum(map(spoke_late, counted)), "", note=note),
        plain("takeovers aimed at real autopilots", len(counted), ""),
        plain(
            "never told by the autopilot, so that nobody can notice",
            sum(o.told_s is None for o in counted),
            "",
            note=note,
        ),
        plain("strikes that did not take", len(outcomes) - len(counted), ""),
        plain("takeovers told though nobody struck", by_nobody, ""),
        plain("slowest notice", max((o.unaware_s for o in counted if o.unaware_s is not None), default=0.0), "s"),
        plain("last flight command after a takeover", max((o.last_command_s for o in counted), default=0.0), "s"),
    ]
