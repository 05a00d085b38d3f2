"""What a turn can look like: one wave; one wave and its echo; one wave from far below. As templates in linear power.

With g the antenna's amplitude (square root of the power pattern, scaled to a maximum of 1) against x = source bearing -
antenna heading:

    one wave             P(x) = g(x)^2
    with an echo         P(x) = g(x)^2 + a^2 g(x + d)^2 + 2 a cos(t) g(x) g(x + d)
    from e degrees below P(x) = g(arccos(cos x cos e))^2

The echo arrives d degrees clockwise, weaker by a (a <= 1), with phase t: both waves have one frequency, so fields add,
not powers. An echo within the beam is seen as a lobe that is shifted, wider or narrower, hardly as a second one.
Looking down, an antenna whose gain depends on the angle to its boom (any end-fire array) sees each heading difference x
as the angle arccos(cos x cos e): its lobe widens and its front stops standing out.

Where nobody checked the pattern on its vehicle, one wave may also look like

    a bent lobe          P(x) = g(u / s)^2,  s = w (1 - a) left of the lobe's middle, w (1 + a) right of it

u the angle from there: the antenna's lobe is wider by w than the measured one, its flanks uneven by a. It is seen as a
lobe that is turned by up to 0.7 a beam widths, and no sweep of few readings tells the two apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.sweep import BIN_DEG, BINS

ECHO_APART_DEG = 12.0
ECHO_LEVELS_DB = (-16.0, -10.0, -6.0, -3.0, 0.0)
"""The direct wave is the strongest, or no stronger than its echo."""
ECHO_PHASES_DEG = (22.5, 67.5, 112.5, 157.5)
"""Midpoints of quarters of the half circle: +t and -t look alike."""
LOOK_DOWN_DEG = (25.0, 35.0, 45.0, 55.0)
PRIOR = (0.6, 0.33, 0.07)
"""How probable the three are before the sweep is seen."""
KINDS = len(PRIOR)
EVEN = 0.6
"""How probable it is that the flanks of an antenna nobody checked are nearly even, a ~ N(0, 0.05^2)."""
NEARLY, UNEVEN = 0.05, 0.25
"""Standard deviation of a where the flanks are nearly even, and where they are not."""
WIDER = 0.12
"""Standard deviation of log w."""
_UNEVEN_STEP, _UNEVEN_STEPS = 0.1, 4
_WIDER_STEP, _WIDER_STEPS = 0.12, 2
_LEAST_POWER = 1e-5


@dataclass(frozen=True, slots=True)
class Alternatives:
    """power: (k, 180) at x = 0, 2, .. 358 degrees. log_prior, kind: (k,).

    kind 0: one wave (row 0: as the pattern has it; bent ones), 1: with an echo, 2: from below.
    """

    power: NDArray[np.float64]
    log_prior: NDArray[np.float64]
    kind: NDArray[np.int64]

    @classmethod
    def of(cls, pattern: AntennaPattern) -> Alternatives:
        """The templates of one antenna, whose strongest gain counts as 1; bent ones where its pattern is unchecked."""
        x: NDArray[np.float64] = np.arange(0.0, 360.0, BIN_DEG)
        peak_db = float(pattern.gain_db.max())

        def amplitude(relative_deg: NDArray[np.float64]) -> NDArray[np.float64]:
            return 10.0 ** ((pattern.gain_at(relative_deg) - peak_db) / 20.0)

        direct = amplitude(x)
        apart = np.arange(ECHO_APART_DEG, 360.0, ECHO_APART_DEG)
        a = 10.0 ** (np.array(ECHO_LEVELS_DB) / 20.0)[None, :, None, None]
        cos_t = np.cos(np.radians(ECHO_PHASES_DEG))[None, None, :, None]
        echo = a * np.array([amplitude(x + d) for d in apart])[:, None, None, :]
        echoed = (direct**2 + echo**2 + 2.0 * cos_t * direct * echo).reshape(-1, BINS)
        below = np.array([amplitude(_angle_to_boom(x, e)) ** 2 for e in LOOK_DOWN_DEG])
        bent = np.array([[0.0, 0.0, 1.0]]) if pattern.checked else _bends()
        waves = np.array([amplitude(_unbent(x, pattern, a, w)) ** 2 for a, w, _ in bent])
        parts = (waves, echoed, below)
        shares = (bent[:, 2], *(np.full(len(part), 1.0 / len(part)) for part in parts[1:]))
        return cls(
            np.maximum(np.concatenate(parts), _LEAST_POWER),
            np.concatenate([np.log(kind * share) for kind, share in zip(PRIOR, shares, strict=True)]),
            np.concatenate([np.full(len(part), kind, dtype=np.int64) for kind, part in enumerate(parts)]),
        )


def _bends() -> NDArray[np.float64]:
    """(k, 3): a, log w and how probable they are; the first is the pattern as it is."""
    a, uneven = _nodes(_UNEVEN_STEP, _UNEVEN_STEPS, ((EVEN, NEARLY), (1.0 - EVEN, UNEVEN)))
    w, wider = _nodes(_WIDER_STEP, _WIDER_STEPS, ((1.0, WIDER),))
    bends = [(i, j, p * q) for i, p in zip(a, uneven, strict=True) for j, q in zip(w, wider, strict=True)]
    return np.array(sorted(bends, key=lambda bend: bend[0] != 0.0 or bend[1] != 0.0))


def _nodes(
    step: float, steps: int, normals: tuple[tuple[float, float], ...]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(2 steps + 1,) values about 0 and the mass around each of a mixture of (share, standard deviation) normals."""
    value: NDArray[np.float64] = step * np.arange(-steps, steps + 1, dtype=np.float64)
    edge = np.append(value - 0.5 * step, value[-1] + 0.5 * step)
    below = [sum(share * math.erf(e / (sd * math.sqrt(2.0))) for share, sd in normals) for e in edge]
    mass = np.diff(below)
    return value, mass / mass.sum()


def _unbent(
    relative_deg: NDArray[np.float64], pattern: AntennaPattern, uneven: float, log_wider: float
) -> NDArray[np.float64]:
    """Where on the measured pattern the bent one takes its gain: stretched in the lobe, whole at its back.

    The lobe reaches one beam width to either side of its middle; from there to the back the angle goes on evenly.
    """
    middle, reach = pattern.lobe_deg, min(pattern.beam_deg, 100.0)
    off = (relative_deg - middle + 180.0) % 360.0 - 180.0
    stretch = math.exp(log_wider) * (1.0 + uneven * np.sign(off))
    edge = np.minimum(stretch * reach, 170.0)
    inside = np.abs(off) / stretch
    outside = edge / stretch + (np.abs(off) - edge) * (180.0 - edge / stretch) / (180.0 - edge)
    return middle + np.sign(off) * np.where(np.abs(off) <= edge, inside, outside)


def _angle_to_boom(relative_deg: NDArray[np.float64], below_deg: float) -> NDArray[np.float64]:
    """arccos(cos x cos e), on the side of x; degrees in [0, 360)."""
    angle = np.degrees(np.arccos(np.cos(np.radians(relative_deg)) * math.cos(math.radians(below_deg))))
    return np.where(relative_deg <= 180.0, angle, 360.0 - angle)
