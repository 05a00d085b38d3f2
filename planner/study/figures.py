"""The thesis' figures from stored results, each None when the data for it are not there.

All are drawn from the missions, the cells' summaries, and `paths`: how many sample paths value a first action.
"""

# matplotlib's own types leave the keyword arguments of its drawing methods unknown.
# pyright: reportUnknownMemberType=false

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.belief.grid import GridBelief, prior_belief
from planner.study.action_values import values_of_grid, values_of_places
from planner.study.cell import Cell
from planner.study.courses import draw_courses
from planner.study.scenarios import MEASUREMENT_TIMES
from planner.study.table import Summary, half_width, label

Draw = Callable[[pd.DataFrame, list[Summary], int], Figure | None]

MOST_PANELS = 9

APART = 1.015
"""Factor between planners' error bars at the same budget, so that they can be told apart."""


def _axes(count: int, width: float = 4.2, height: float = 3.6, columns: int = 3) -> tuple[Figure, list[Axes]]:
    columns = min(columns, count)
    rows = -(-count // columns)
    figure = Figure(figsize=(width * columns, height * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for unused in axes[count:]:
        unused.set_visible(False)
    return figure, list(axes[:count])


def _of(results: pd.DataFrame, cell: Cell) -> pd.DataFrame:
    return results.loc[results["cell"] == cell.name()]


def _configs(summaries: list[Summary]) -> list[str]:
    """fast before medium before slow, as many as there are."""
    present = {s.cell.config for s in summaries}
    return [config for config in MEASUREMENT_TIMES if config in present]


def time_by_target(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Scenario 1: mean time against the target's distance along the row."""
    chosen = [s for s in summaries if s.cell.scenario == "1"]
    if not chosen:
        return None
    configs = _configs(chosen)
    figure, axes = _axes(len(configs))
    for panel, config in zip(axes, configs, strict=True):
        for summary in chosen:
            if summary.cell.config != config:
                continue
            missions = _of(results, summary.cell)
            distance, at = np.unique(missions["target_y"].to_numpy(dtype=float), return_inverse=True)
            every = missions["time"].to_numpy(dtype=float)
            times = [every[at == k] for k in range(len(distance))]
            panel.errorbar(
                distance,
                [t.mean() for t in times],
                yerr=[half_width(t) for t in times],
                marker="o",
                markersize=3,
                capsize=2,
                label=label(summary.cell.fields()),
            )
        panel.set(title=config, xlabel="distance of the target, m", ylabel="time until localization, s")
        panel.legend(fontsize="small")
    return figure


def times_violin(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Scenario 2: how the times are spread, one violin a planner, with mean (red) and median (dotted)."""
    chosen = [s for s in summaries if s.cell.scenario == "2" and s.runs >= 10]
    if not chosen:
        return None
    configs = _configs(chosen)
    most = max(sum(s.cell.config == config for s in chosen) for config in configs)
    figure, axes = _axes(len(configs), width=5.5, height=1.2 + 0.42 * most, columns=3)
    for panel, config in zip(axes, configs, strict=True):
        here = sorted((s for s in chosen if s.cell.config == config), key=lambda s: -s.mean_s)
        times = [_of(results, s.cell)["time"].to_numpy(dtype=float) for s in here]
        drawn = panel.violinplot(
            times, orientation="horizontal", showmeans=True, showmedians=True, showextrema=False, widths=0.85
        )
        drawn["cmeans"].set(color="tab:red", label="mean")
        drawn["cmedians"].set(color="black", linestyle=":", label="median")
        panel.set_yticks(np.arange(1, len(here) + 1), [label(s.cell.fields()) for s in here], fontsize="small")
        panel.set_xlim(0, max(np.quantile(t, 0.995) for t in times))
        panel.set(title=config, xlabel="time until localization, s")
    axes[-1].legend(fontsize="small")
    return figure


def first_actions(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Scenario 2: where each planner goes first, over the prior; as many missions as there are in the results."""
    chosen = _one_a_planner([s for s in summaries if s.cell.scenario == "2"])[:MOST_PANELS]
    if not chosen:
        return None
    figure, axes = _axes(len(chosen), height=4.4)
    for panel, summary in zip(axes, chosen, strict=True):
        case = summary.cell.case()
        _belief(panel, prior_belief(case.problem))
        places = _of(results, summary.cell)[["first_x", "first_y"]].dropna().to_numpy(dtype=float)
        distinct, counts = np.unique(places, axis=0, return_counts=True)
        panel.scatter(*distinct.T, s=8 + 200 * counts / counts.sum(), color="tab:red", alpha=0.6, linewidths=0)
        panel.plot(*case.platform, marker="^", color="black", clip_on=False, zorder=3)
        panel.set(title=label(summary.cell.fields()), xlabel="x, m", ylabel="y, m", aspect="equal")
        panel.title.set_fontsize("small")
    return figure


def action_values(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Expected time by way of each first place, with the belief it is for, for every configuration of Scenario 2."""
    configs = _configs([s for s in summaries if s.cell.scenario == "2"])
    if not configs:
        return None
    figure, axes = _axes(len(configs), width=4.8, height=4.4)
    for panel, config in zip(axes, configs, strict=True):
        case = Cell(scenario="2", config=config).case()
        values = values_of_grid(case, paths)
        _belief(panel, values.belief)
        nx, ny = case.problem.action_grid
        x, y, z = (column.reshape(ny, nx) for column in (*values.places.T, values.values))
        levels = z.min() + np.array([0.5, 1, 2, 4, 8, 16, 32])
        lines = panel.contour(x, y, z, levels=levels, cmap="viridis", linewidths=1.2)
        panel.clabel(lines, levels[2:], fmt="%.0f", fontsize="x-small")  # the innermost have no room for theirs
        best = int(np.argmin(values.values))
        panel.plot(*values.places[best], marker="*", markersize=12, color="tab:red")
        panel.plot(*case.platform, marker="^", color="black", clip_on=False, zorder=3)
        panel.set(title=f"{config}: least {values.values[best]:.1f} s", xlabel="x, m", ylabel="y, m", aspect="equal")
    return figure


def optimization_by_budget(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Scenario 2: what the chosen first actions are really worth, against the budget."""
    return _by_budget(summaries, lambda s: _optimization(results, s, paths), "value of the first action, s")


def localization_by_budget(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Scenario 2: mean time until localization against the budget."""
    return _by_budget(summaries, lambda s: (s.mean_s, s.ci95_s), "time until localization, s")


def optimization_against_localization(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Scenario 2: whether better first actions make quicker missions, one point a cell."""
    chosen = _rollouts(summaries)
    configs = [c for c in MEASUREMENT_TIMES if sum(s.cell.config == c for s in chosen) >= 3]
    if not configs:
        return None
    figure, axes = _axes(len(configs))
    for panel, config in zip(axes, configs, strict=True):
        here = [s for s in chosen if s.cell.config == config]
        points = np.array([_optimization(results, s, paths)[0] for s in here]), np.array([s.mean_s for s in here])
        for summary, x, y in zip(here, *points, strict=True):
            panel.errorbar(x, y, yerr=summary.ci95_s, marker="o", markersize=4, capsize=2, color="tab:blue")
        title = config
        if np.ptp(points[0]) > 0 and np.ptp(points[1]) > 0:
            title += f": correlation {np.corrcoef(points)[0, 1]:.2f}"
        panel.set(title=title, xlabel="value of the first action, s", ylabel="time until localization, s")
    return figure


def sensitivity_to_grid(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Mean time against the number of places compared, for cells that differ in nothing else."""
    return _sensitivity(
        summaries,
        axis=lambda cell: int(np.prod(cell.case().problem.action_grid)),
        without=("actions",),
        name="places compared",
    )


def sensitivity_to_measurement_time(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Mean time against the time a bearing takes, for cells that differ in nothing else."""
    return _sensitivity(
        summaries,
        axis=lambda cell: cell.case().problem.measurement_time,
        without=("config", "measurement_time"),
        name="time a bearing takes, s",
    )


def courses(results: pd.DataFrame, summaries: list[Summary], paths: int) -> Figure | None:
    """Fig. 3.9: the lookahead planner's courses; needs no results."""
    return draw_courses()


def _belief(panel: Axes, belief: GridBelief) -> None:
    x_min, y_min, x_max, y_max = belief.bounds
    panel.imshow(
        belief.density, origin="lower", extent=(x_min, x_max, y_min, y_max), cmap="Greys", interpolation="nearest"
    )


def _rollouts(summaries: list[Summary]) -> list[Summary]:
    return [s for s in summaries if s.cell.scenario == "2" and s.cell.planner == "rollout"]


def _one_a_planner(summaries: list[Summary]) -> list[Summary]:
    """The medium one of cells that differ in the configuration only, the quickest of rollout's selections each."""
    kept: dict[tuple[str, str | None], Summary] = {}
    for summary in sorted(summaries, key=lambda s: (s.cell.config != "medium", s.mean_s)):
        cell = summary.cell
        kept.setdefault((cell.planner, cell.selection if cell.planner == "rollout" else None), summary)
    return list(kept.values())


def _optimization(results: pd.DataFrame, summary: Summary, paths: int) -> tuple[float, float]:
    """Mean value of the chosen first actions and its half width, on the common test paths."""
    places = _of(results, summary.cell)[["first_x", "first_y"]].dropna().to_numpy(dtype=float)
    distinct, of_mission = np.unique(places, axis=0, return_inverse=True)
    values = values_of_places(summary.cell.case(), distinct, paths)
    return float(values[of_mission].mean()), half_width(values[of_mission])


def _by_budget(summaries: list[Summary], measure: Callable[[Summary], tuple[float, float]], name: str) -> Figure | None:
    series: dict[tuple[str, str], list[Summary]] = defaultdict(list)
    for summary in _rollouts(summaries):
        fields = summary.cell.fields() | {"budget": 0}
        series[summary.cell.config, label(fields).replace(", N 0", "")].append(summary)
    series = {key: found for key, found in series.items() if len({s.cell.budget for s in found}) > 1}
    if not series:
        return None
    configs = _configs([s for found in series.values() for s in found])
    figure, axes = _axes(len(configs), width=5.0)
    for panel, config in zip(axes, configs, strict=True):
        here = {words: found for (own, words), found in series.items() if own == config}
        for number, (words, found) in enumerate(here.items()):
            found.sort(key=lambda s: s.cell.budget)
            values = np.array([measure(s) for s in found])
            beside = APART**number * np.array([s.cell.budget for s in found])
            panel.errorbar(beside, values[:, 0], yerr=values[:, 1], marker="o", markersize=4, capsize=2, label=words)
        panel.set(title=config, xlabel="rollouts a decision", ylabel=name, xscale="log")
        budgets = sorted({s.cell.budget for found in here.values() for s in found})
        panel.set_xticks(budgets, [str(budget) for budget in budgets], fontsize="small")
        panel.minorticks_off()
        panel.legend(fontsize="x-small")
    return figure


def _sensitivity(
    summaries: list[Summary], axis: Callable[[Cell], float], without: tuple[str, ...], name: str
) -> Figure | None:
    series: dict[str, list[Summary]] = defaultdict(list)
    for summary in summaries:
        fields = summary.cell.fields()
        words = label(fields | dict.fromkeys(without))
        series[f"scenario {fields['scenario']}{'' if 'config' in without else ' ' + fields['config']}: {words}"].append(
            summary
        )
    series = {words: found for words, found in series.items() if len({axis(s.cell) for s in found}) > 1}
    if not series:
        return None
    figure, (panel,) = _axes(1, width=6.0, height=4.2)
    for words, found in series.items():
        found.sort(key=lambda s: axis(s.cell))
        panel.errorbar(
            [axis(s.cell) for s in found],
            [s.mean_s for s in found],
            yerr=[s.ci95_s for s in found],
            marker="o",
            capsize=2,
            label=words,
        )
    panel.set(xlabel=name, ylabel="time until localization, s")
    panel.legend(fontsize="x-small")
    return figure


FIGURES: dict[str, tuple[Draw, str]] = {
    "time_by_target": (time_by_target, "results of scenario 1"),
    "times_violin": (times_violin, "ten runs or more of scenario 2"),
    "first_actions": (first_actions, "results of scenario 2"),
    "action_values": (action_values, "results of scenario 2"),
    "optimization_by_budget": (optimization_by_budget, "rollout cells of scenario 2 with several budgets"),
    "localization_by_budget": (localization_by_budget, "rollout cells of scenario 2 with several budgets"),
    "optimization_against_localization": (
        optimization_against_localization,
        "three rollout cells of scenario 2 or more with one --config",
    ),
    "sensitivity_to_grid": (sensitivity_to_grid, "cells that differ in --actions only"),
    "sensitivity_to_measurement_time": (
        sensitivity_to_measurement_time,
        "cells that differ in --config or --measurement-time only",
    ),
    "courses": (courses, "nothing"),
}
"""File name, how to draw it, what it needs."""
