"""How long a flight takes: the three movement time models and their least-squares fit (spec 7, thesis 6.4.3)."""

from __future__ import annotations

import numpy as np

from planner.observation import wrap
from planner.reasons import UnusableFlights, UnusableNumber
from planner.types import FloatArray, FullMotion, LinearConstantMotion, LinearMotion, Motion, PlannerError


def flight_time(motion: Motion, distance: FloatArray | float, turn: FloatArray | float = 0.0) -> FloatArray:
    """Seconds to fly `distance` m after turning by `turn` rad (only the full model turns). Shapes broadcast."""
    distance = np.asarray(distance, dtype=float)
    match motion:
        case LinearMotion(speed):
            return distance / speed
        case LinearConstantMotion(speed, constant):
            return distance / speed + constant
        case FullMotion(turn_rate, acceleration, speed, constant):
            ramp = speed**2 / acceleration
            cruising = distance / speed + speed / acceleration
            short = 2.0 * np.sqrt(np.maximum(distance, 0.0) / acceleration)
            return np.abs(turn) / turn_rate + np.where(distance >= ramp, cruising, short) + constant


def turn_between(heading: float, direction: FloatArray | float) -> FloatArray:
    """Smallest turn in rad, [0, pi], from one direction to another."""
    return np.abs(wrap(np.asarray(direction) - heading))


def fit_motion(distances: FloatArray, turns: FloatArray, times: FloatArray) -> tuple[Motion, dict[str, float]]:
    """The model that explains stored flights best, and the RMS error in s of each model.

    distances: (n,) m. turns: (n,) rad before each flight. times: (n,) s. Errors: PlannerError for fewer than four
    flights, lengths that differ, or values that are not finite and positive.
    """
    distances, turns, times = (np.asarray(a, dtype=float) for a in (distances, turns, times))
    if not distances.shape == turns.shape == times.shape or distances.ndim != 1:
        raise PlannerError(UnusableFlights("lengths_differ"))
    if len(distances) < 4:
        raise PlannerError(UnusableFlights("too_few"))
    if not (np.isfinite([distances, turns, times]).all() and (times > 0).all() and (distances >= 0).all()):
        raise PlannerError(UnusableFlights("not_finite"))
    if np.ptp(distances) == 0:
        raise PlannerError(UnusableFlights("equal_distances"))
    models = [_fit_linear(distances, times), _fit_linear_constant(distances, times), _fit_full(distances, turns, times)]
    errors = {
        name: float(np.sqrt(np.mean((flight_time(model, distances, turns) - times) ** 2)))
        for name, model in zip(("linear", "linear_constant", "full"), models, strict=True)
    }
    best = min(range(3), key=lambda k: list(errors.values())[k])
    return models[best], errors


def _fit_linear(distances: FloatArray, times: FloatArray) -> LinearMotion:
    return LinearMotion(speed=float(distances @ distances / (distances @ times)))


def _fit_linear_constant(distances: FloatArray, times: FloatArray) -> LinearConstantMotion:
    slope, constant = np.polyfit(distances, times, 1)
    if slope <= 0 or constant < 0:
        return LinearConstantMotion(speed=_fit_linear(distances, times).speed, constant=0.0)
    return LinearConstantMotion(speed=float(1.0 / slope), constant=float(constant))


def _fit_full(distances: FloatArray, turns: FloatArray, times: FloatArray) -> FullMotion:
    from scipy.optimize import least_squares  # half a second to import, and only fits need it

    start = FullMotion()

    def model(p: FloatArray) -> FullMotion:
        return FullMotion(*(float(v) for v in np.exp(p[:3])), constant=float(p[3]))

    fitted = least_squares(
        lambda p: flight_time(model(p), distances, turns) - times,
        np.array([np.log(start.turn_rate), np.log(start.acceleration), np.log(start.speed), start.constant]),
        bounds=([-5.0, -4.0, -2.0, 0.0], [3.0, 4.0, 5.0, np.inf]),
        x_scale=[1.0, 1.0, 1.0, 3.0],
    )
    return model(fitted.x)


def validate_motion(motion: Motion) -> None:
    """PlannerError when a rate, speed or constant is not usable."""
    for name in ("turn_rate", "acceleration", "speed"):
        value = getattr(motion, name, 1.0)
        if not (np.isfinite(value) and value > 0):
            raise PlannerError(UnusableNumber(name, "positive", f"{value:g}"))
    constant = getattr(motion, "constant", 0.0)
    if not (np.isfinite(constant) and constant >= 0):
        raise PlannerError(UnusableNumber("movement_constant", "not_negative", f"{constant:g}"))
