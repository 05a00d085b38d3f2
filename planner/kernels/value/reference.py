"""The dynamic program in readable numpy: what `transitions` and `iteration` compute, and their oracle in the tests."""

from __future__ import annotations

import numpy as np

from planner.kernels.value.iteration import CHI_95
from planner.kernels.value.model import NEAR, NODE_STEP, RATIO_STEP, SCALE_STEP, Transitions
from planner.kernels.value.transitions import ACROSS, BEYOND, FEWEST, LIGHT, MEDIAN_STEPS, REACH
from planner.types import BoolArray, FloatArray


def posterior(
    rho: float, place: FloatArray, sigma: float, draw: FloatArray
) -> tuple[float, float, float, float, float]:
    """log s1', log rho', the platform in the new frame, E |x - median|, all for s1 = 1 and a bearing from `place` (2,).

    draw: (3,) standard normal, the target's place in the prior's own units and the bearing's noise.
    """
    nx, ny = ACROSS + 1, max(FEWEST, int(np.ceil(ACROSS / rho)) + 1)
    h = np.array([2.0 * REACH / nx, 2.0 * REACH / (rho * ny)])
    x, y = np.meshgrid(
        -REACH + (np.arange(nx) + 0.5) * h[0], -REACH / rho + (np.arange(ny) + 0.5) * h[1], indexing="ij"
    )
    target = np.array([draw[0], draw[1] / rho]) - place
    angle = np.arctan2(target[1], target[0]) + sigma * draw[2]  # (4.2)
    dx, dy = x - place[0], y - place[1]
    r2 = np.maximum(dx**2 + dy**2, 0.25 * (h @ h) / 3.0)
    seen = ((h[0] * dy) ** 2 + (h[1] * dx) ** 2) / (12.0 * r2**2)  # variance of the directions inside a cell
    variance = sigma**2 + seen
    error = (np.arctan2(dy, dx) - angle + np.pi) % (2.0 * np.pi) - np.pi
    weight = np.exp(-0.5 * (x**2 + (rho * y) ** 2)) * sigma / np.sqrt(variance) * np.exp(-0.5 * error**2 / variance)
    weight[~_touched(dx, dy, angle, sigma, h) | (0.5 * error**2 / variance > BEYOND) | (weight <= LIGHT)] = 0.0
    mass = weight / weight.sum()
    mean = np.array([(mass * x).sum(), (mass * y).sum()])
    xx = (mass * (x - mean[0]) ** 2).sum() + h[0] ** 2 / 12.0
    yy = (mass * (y - mean[1]) ** 2).sum() + h[1] ** 2 / 12.0
    xy = (mass * (x - mean[0]) * (y - mean[1])).sum()
    (s2, s1), axes = np.linalg.eigh(np.array([[xx, xy], [xy, yy]]))
    u = np.abs(axes.T @ (place - mean))[::-1] / np.sqrt(s1)
    px, py = mean
    for _ in range(MEDIAN_STEPS):  # Weiszfeld
        pull = mass / np.maximum(np.hypot(x - px, y - py), 0.1 * h[1])
        px, py = (pull * x).sum() / pull.sum(), (pull * y).sum() / pull.sum()
    spread = (mass * np.hypot(x - px, y - py)).sum()
    return 0.5 * np.log(s1), 0.5 * np.log(s1 / s2), float(u[0]), float(u[1]), float(spread)


def _touched(dx: FloatArray, dy: FloatArray, angle: float, sigma: float, h: FloatArray) -> BoolArray:
    """The cells in the widened wedge; those of them whose error counts for nothing are left out later."""
    along, across = np.cos(angle) * dx + np.sin(angle) * dy, np.cos(angle) * dy - np.sin(angle) * dx
    margin = 1.5 * h.max()
    return (np.abs(across) <= np.tan(min(4.5 * sigma, 1.4)) * along + margin) & (along >= -margin)


def sweep(
    value: FloatArray, t: Transitions, scales: FloatArray, ratios: FloatArray, nodes: FloatArray, unit: float,
    measurement_time: float, speed: float, standoff: float,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """One sweep of value iteration at a constant speed: (G, V), each (RATIOS, NODES, NODES, SCALES) s."""
    after = np.empty_like(value)
    for r, i, j in np.ndindex(value.shape[:3]):
        left = np.zeros(len(scales))
        for d in range(t.shrunk.shape[3]):
            ratio, u1, u2 = t.ratio[r, i, j, d], t.u1[r, i, j, d], t.u2[r, i, j, d]
            going_on = (
                t.spread[r, i, j, d] * scales >= 1.0 - 1e-12
            )  # E d of the new belief at least the threshold (4.11)
            at = np.log(scales / scales[0]) / SCALE_STEP + t.shrunk[r, i, j, d] / SCALE_STEP
            beyond = np.hypot(max(u1 - nodes[-1], 0.0), max(u2 - nodes[-1], 0.0))
            flown_back = beyond * np.exp(t.shrunk[r, i, j, d]) * scales * unit / speed
            following = _interpolated(value, ratio / RATIO_STEP, _node(u1, nodes), _node(u2, nodes), at) + flown_back
            left += np.where(going_on, following, 0.0)
        after[r, i, j] = measurement_time + left / t.shrunk.shape[3]
    value = np.empty_like(after)
    a, b = np.meshgrid(nodes, nodes, indexing="ij")
    for r, i, j in np.ndindex(value.shape[:3]):
        far = np.hypot(a - nodes[i], b - nodes[j])[..., None] * scales * unit
        allowed = _clearance(a, b, float(ratios[r]))[..., None] * scales * unit >= standoff
        allowed[-1, -1] = True
        value[r, i, j] = np.where(allowed, far / speed + after[r], np.inf).min(axis=(0, 1))  # Bellman
    return after, value


def _node(u: float, nodes: FloatArray) -> float:
    return float(np.log1p(min(u, nodes[-1]) / NEAR) / NODE_STEP)


def _interpolated(value: FloatArray, ratio: float, i: float, j: float, at: FloatArray) -> FloatArray:
    """(SCALES,) linear in four indices, as at the edge beyond the grid."""
    for position in (ratio, i, j):
        last = value.shape[0] - 1
        position = min(max(position, 0.0), float(last))
        k = min(int(position), last - 1)
        value = (1.0 - (position - k)) * value[k] + (position - k) * value[k + 1]
    return np.interp(at, np.arange(len(value)), value)


def _clearance(u1: FloatArray, u2: FloatArray, rho: float) -> FloatArray:
    """Distance of places (u1, u2) >= 0 to the 95 % ellipse of N(0, diag(1, 1 / rho^2)), 0 inside."""
    a, b = CHI_95, CHI_95 / rho
    angle = 0.5 * np.pi * np.arange(91) / 90
    nearest = np.hypot(a * np.cos(angle) - u1[..., None], b * np.sin(angle) - u2[..., None]).min(axis=-1)
    return np.where((u1 / a) ** 2 + (u2 / b) ** 2 <= 1.0, 0.0, nearest)
