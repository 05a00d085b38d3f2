"""Fig. 3.9: courses of the deterministic lookahead for a stationary target, myopic, moving target, two platforms."""

# matplotlib's own types leave the keyword arguments of its drawing methods unknown.
# pyright: reportUnknownMemberType=false

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.policy.lookahead import RATIOS, Course, myopic_headings, optimal_headings, places, stationary_course
from planner.types import FloatArray

STEPS = 20


def moving_course(ratio: float = 0.5) -> Course:
    """The target crosses at half the platform's speed."""
    still = stationary_course(ratio, STEPS)
    return replace(still, velocity=np.array([0.0, 0.5 * still.step]))


def two_platform_course(ratio: float = 0.5) -> Course:
    """Both start at the same place."""
    return replace(stationary_course(ratio, STEPS), starts=np.zeros((2, 2)))


def draw_courses() -> Figure:
    """Four panels; the platform starts at (0, 0), the target is at (1, 0)."""
    figure = Figure(figsize=(11.0, 7.0), layout="constrained")
    stationary, myopic, moving, two = figure.subplots(2, 2).ravel()
    for ratio in RATIOS:
        course = stationary_course(ratio, STEPS)
        _way(stationary, places(course, optimal_headings(course))[0], f"{ratio:g}")
        _way(myopic, places(course, myopic_headings(course))[0], f"{ratio:g}")
    course = moving_course()
    _way(moving, places(course, optimal_headings(course))[0], "platform")
    ahead = course.target + np.arange(STEPS + 1)[:, None] * course.velocity
    moving.plot(*ahead.T, color="black", linestyle=":", label="target")
    for number, way in enumerate(places(two_platform_course(), optimal_headings(two_platform_course())), start=1):
        _way(two, way, f"platform {number}")
    titles = {
        stationary: "stationary target, path length / first distance",
        myopic: "the same, one step at a time",
        moving: "moving target, ratio 0.5",
        two: "two platforms, ratio 0.5",
    }
    for panel, title in titles.items():
        panel.plot(1.0, 0.0, marker="*", color="black", markersize=10)
        panel.set(title=title, xlabel="x", ylabel="y", aspect="equal")
        panel.legend(fontsize="x-small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _way(panel: Axes, way: FloatArray, name: str) -> None:
    panel.plot(*way.T, marker=".", markersize=3, linewidth=1, label=name)
