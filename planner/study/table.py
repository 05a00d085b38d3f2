"""Means with 95 % intervals, beside the figures that the thesis prints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import pandas as pd

from planner.study.cell import Cell
from planner.study.reference import Printed, printed
from planner.types import FloatArray

Z95 = 1.959964


@dataclass(frozen=True, slots=True)
class Summary:
    """One cell summed up. ci95_s, bearings_ci95: half widths of 95 % intervals, NaN with fewer than two runs.

    localized, in_c95: shares of the runs. error_m: mean distance of the last estimate from the truth.
    """

    cell: Cell
    runs: int
    mean_s: float
    ci95_s: float
    bearings_mean: float
    bearings_ci95: float
    travel_m: float
    localized: float
    in_c95: float
    error_m: float
    thesis: Printed | None

    @property
    def within(self) -> bool | None:
        """Whether the difference to the thesis lies inside the joint 95 % interval; None without a figure."""
        if self.thesis is None or math.isnan(self.ci95_s):
            return None
        printed_ci = 0.0 if math.isnan(self.thesis.ci95) else self.thesis.ci95
        return abs(self.mean_s - self.thesis.mean) <= math.hypot(self.ci95_s, printed_ci)

    def json(self) -> dict[str, Any]:
        """For `--json`: numbers that are not known are null."""
        thesis = self.thesis
        return {
            **self.cell.fields(),
            "mean_s": self.mean_s,
            "ci95_s": _known(self.ci95_s),
            "runs": self.runs,
            "bearings_mean": self.bearings_mean,
            "bearings_ci95": _known(self.bearings_ci95),
            "travel_mean_m": self.travel_m,
            "localized_share": self.localized,
            "in_c95_share": self.in_c95,
            "error_mean_m": self.error_m,
            "thesis_mean_s": None if thesis is None else thesis.mean,
            "thesis_ci95_s": None if thesis is None else _known(thesis.ci95),
            "within_joint_ci95": self.within,
        }


def summarize(cell: Cell, missions: pd.DataFrame) -> Summary:
    """missions: one row each, the columns of `Mission`."""
    return Summary(
        cell=cell,
        runs=len(missions),
        mean_s=_mean(missions, "time"),
        ci95_s=half_width(missions["time"].to_numpy(dtype=float)),
        bearings_mean=_mean(missions, "bearings"),
        bearings_ci95=half_width(missions["bearings"].to_numpy(dtype=float)),
        travel_m=_mean(missions, "travel"),
        localized=_mean(missions, "localized"),
        in_c95=_mean(missions, "in_c95"),
        error_m=_mean(missions, "error"),
        thesis=printed(cell.fields()),
    )


def _mean(missions: pd.DataFrame, column: str) -> float:
    return float(missions[column].to_numpy(dtype=float).mean())


def half_width(values: FloatArray) -> float:
    """Of the 95 % interval of the mean."""
    return float(Z95 * values.std(ddof=1) / math.sqrt(len(values))) if len(values) > 1 else math.nan


HEADER = ("scenario", "config", "planner", "mean s", "thesis s", "difference", "bearings", "thesis", "runs")


def row(summary: Summary) -> tuple[str, ...]:
    """The cells under `HEADER`."""
    thesis = summary.thesis
    difference = "" if thesis is None else f"{summary.mean_s - thesis.mean:+.2f}{'' if summary.within else ' *'}"
    return (
        summary.cell.scenario,
        summary.cell.config,
        label(summary.cell.fields()),
        _with_ci(summary.mean_s, summary.ci95_s),
        "" if thesis is None else _with_ci(thesis.mean, thesis.ci95),
        difference,
        f"{summary.bearings_mean:.3f}",
        "" if thesis is None or math.isnan(thesis.bearings) else f"{thesis.bearings:g}",
        str(summary.runs),
    )


FOOTNOTE = "* outside the joint 95 % interval"


def markdown(summaries: list[Summary]) -> str:
    """A Markdown table, one row a cell."""
    lines = [" | ".join(HEADER), " | ".join("---" for _ in HEADER), *(" | ".join(row(s)) for s in summaries)]
    return "\n".join(f"| {line} |" for line in lines)


def label(fields: dict[str, Any]) -> str:
    """The planner in few words."""
    if fields["planner"] != "rollout":
        words = [fields["planner"].replace("_", " ")]
    else:
        words = ["rollout", fields["selection"].replace("_", " "), fields["sampling"], f"N {fields['budget']}"]
        if fields["base_policy"]:
            words.append(f"on {fields['base_policy']}")
    if fields["actions"]:
        words.append(fields["actions"])
    if fields["estimator"]:
        words.append(fields["estimator"].replace("_", " "))
    if fields["measurement_time"] is not None:
        words.append(f"t_m {fields['measurement_time']:g} s")
    return ", ".join(words)


def _with_ci(mean: float, ci: float) -> str:
    return f"{mean:.2f}" if math.isnan(ci) else f"{mean:.2f} ± {ci:.2f}"


def _known(value: float) -> float | None:
    return None if math.isnan(value) else value
