"""How sure a counted share is."""

from __future__ import annotations

from math import sqrt


def wilson(successes: float, trials: float, z: float = 1.96) -> tuple[float, float]:
    """(low, high) of a share: (p + z^2/2n +- z sqrt(p (1-p)/n + z^2/4n^2)) / (1 + z^2/n) (Wilson 1927); all that is
    possible when n = 0."""
    if trials == 0:
        return 0.0, 1.0
    share, square = successes / trials, z * z / trials
    middle = (share + square / 2.0) / (1.0 + square)
    half = z * sqrt(share * (1.0 - share) / trials + square / (4.0 * trials)) / (1.0 + square)
    return max(0.0, middle - half), min(1.0, middle + half)
