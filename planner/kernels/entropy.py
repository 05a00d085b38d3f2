"""Shannon entropy of a belief after the bearing that is expected at each of many places: readable and compiled.

`expected_entropies_reference` is the specification in numpy, `expected_entropies` its compiled twin.
"""

from __future__ import annotations

import math

import numpy as np

from planner.compiling import entry
from planner.types import FloatArray

WEDGE = 4.0  # cells further than 4 sigma from the bearing are impossible (thesis 4.3.1)


def expected_entropies_reference(
    cells: FloatArray, mass: FloatArray, places: FloatArray, aims: FloatArray, sigma: float
) -> FloatArray:
    """Mean over `aims` of the entropy, nat, after the noiseless bearing from each place to the aim.

    cells: (n, 2) centres, m. mass: (n,) positive. places: (k, 2) m. aims: (m, 2) m. sigma: rad. Returns (k,); a place
    from which some aim's wedge meets no cell gets +inf.
    """
    answer = np.empty(len(places))
    for index, place in enumerate(places):
        entropies: list[float] = []
        for aim in aims:
            bearing = np.arctan2(aim[1] - place[1], aim[0] - place[0])
            error = np.arctan2(cells[:, 1] - place[1], cells[:, 0] - place[0]) - bearing
            error = (error + np.pi) % (2 * np.pi) - np.pi
            seen = np.abs(error) <= WEDGE * sigma
            posterior = mass[seen] * np.exp(-0.5 * (error[seen] / sigma) ** 2)  # (3.26)
            if posterior.sum() <= 0:
                entropies.append(np.inf)
                continue
            posterior /= posterior.sum()
            posterior = posterior[posterior > 0]
            entropies.append(float(-np.sum(posterior * np.log(posterior))))  # (3.59)
        answer[index] = np.mean(entropies)
    return answer


def expected_entropies(
    cells: FloatArray, mass: FloatArray, places: FloatArray, aims: FloatArray, sigma: float
) -> FloatArray:
    """As `expected_entropies_reference`, compiled; sigma must keep the wedge within a half plane (below 22.5 deg)."""
    if not 0 < WEDGE * sigma < math.pi / 2:
        return expected_entropies_reference(cells, mass, places, aims, sigma)
    contiguous = np.ascontiguousarray
    return _entropies(
        contiguous(cells[:, 0]), contiguous(cells[:, 1]), contiguous(mass), np.log(mass), places, aims, sigma
    )


@entry
def _entropies(
    x: FloatArray,
    y: FloatArray,
    mass: FloatArray,
    log_mass: FloatArray,
    places: FloatArray,
    aims: FloatArray,
    sigma: float,
) -> FloatArray:
    answer = np.empty(len(places))
    errors = np.empty(len(x))
    seen = np.empty(len(x), dtype=np.int64)
    tangent = math.tan(WEDGE * sigma)
    precision = 0.5 / sigma**2
    for k in range(len(places)):
        a, b = places[k, 0], places[k, 1]
        total = 0.0
        for m in range(len(aims)):
            c, s = aims[m, 0] - a, aims[m, 1] - b
            if c == 0.0 and s == 0.0:
                c = 1.0  # atan2(0, 0) = 0
            n = 0
            for i in range(len(x)):
                dot = (x[i] - a) * c + (y[i] - b) * s
                cross = (y[i] - b) * c - (x[i] - a) * s
                inside = abs(cross) <= tangent * dot
                seen[n] = i
                errors[n] = cross / dot  # tan(error)
                n += inside
            # H = log(sum w) - sum(w log w) / sum(w) with w = p L
            weight = 0.0
            weighted_log = 0.0
            for j in range(n):
                error = math.atan(errors[j])
                exponent = -precision * error * error
                w = mass[seen[j]] * math.exp(exponent)
                weight += w
                weighted_log += w * (log_mass[seen[j]] + exponent)
            total += math.log(weight) - weighted_log / weight if weight > 0.0 else math.inf
        answer[k] = total / len(aims)
    return answer
