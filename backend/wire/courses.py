"""How the estimate of a mission, and of its variants, came about over time."""

from __future__ import annotations

from backend.events.review import Supposition
from backend.reasons import Reason
from backend.spec import EmitterSpec, Model


class CoursePoint(Model):
    """What was, or would have been, believed at a time. t_s: since the start. error_m: of the estimate, None while
    nobody has said where the emitter was."""

    t_s: float
    bearings: int
    expected_rmse_m: float | None
    c95_area_m2: float | None
    error_m: float | None
    inside: bool | None
    localized: bool


class Course(Model):
    """Of a mission as it was flown (name None), or of one of its variants. problem: why a variant has no points."""

    name: str | None
    wanted: Supposition | None
    points: list[CoursePoint]
    problem: Reason | None = None


class MissionCourses(Model):
    """Of one emitter, the variants too, whatever emitter they were kept for. emitters: all that are looked for.
    ended_s: since the start, None of a mission that has not ended. bearings_s: when each bearing that counts was
    taken."""

    mission_id: str
    name: str
    emitter_id: str
    emitters: list[EmitterSpec]
    ended_s: float | None
    bearings_s: list[float]
    courses: list[Course]
