"""What a flight teaches reaches the next mission's facts; what cannot be kept holds nothing up."""

from __future__ import annotations

from equipment import HOME, PATTERN, PointingFinder, spec
from flights import order
from stage import Stage

from backend import commands
from backend.events import FIRST_CRAFT, MissionStarted
from backend.mission.state import fold
from backend.ports import Lesson
from backend.spec import MissionSpec, SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.readings import BearingReading, Sweep


class MemoryLessons:
    """`full`: nothing can be kept any more."""

    def __init__(self) -> None:
        self.kept: list[Lesson] = []
        self.tried = 0
        self.full = False

    async def of(self, craft_id: str, antenna: str) -> list[Lesson]:
        return [*self.kept] if (craft_id, antenna) == (FIRST_CRAFT, PATTERN.name) else []

    async def keep(self, craft_id: str, antenna: str, lesson: Lesson) -> None:
        self.tried += 1
        if self.full:
            raise OSError("no space left on device")
        assert (craft_id, antenna) == (FIRST_CRAFT, PATTERN.name)
        self.kept = [*(one for one in self.kept if one.mission_id != lesson.mission_id), lesson]

    async def forget(self, craft_id: str, antenna: str) -> None:
        self.kept.clear()


class HearingFinder(PointingFinder):
    """Keeps how the antenna of each sweep was said to be mounted."""

    def __init__(self) -> None:
        super().__init__((120.0, 80.0))
        self.mounted = set[float]()

    def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading:
        self.mounted.add(pattern.offset_to_nose_deg)
        return super().estimate(sweep, pattern)


def joint() -> MissionSpec:
    return spec().model_copy(update={"sensor": SensorSpec(bearing_errors="joint")})


async def flown(stage: Stage, lessons: MemoryLessons, mission_id: str) -> MissionStarted:
    """To its end, and until its lesson was handed over."""
    before = lessons.tried
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until_true(lambda: stage.vehicle.names[-1:] == ["land"], wall_s=60.0)
    stage.vehicle.touch_down()
    await stage.until_mission(mission_id, "done")
    await stage.until_true(lambda: lessons.tried > before, wall_s=60.0)
    (started,) = stage.journal.of_kind(mission_id, MissionStarted)
    assert stage.journal.state(mission_id).search.mission.sensor.learned == started.learned
    return started


async def test_a_flight_teaches_the_next_one_which_keeps_what_it_started_from() -> None:
    stage, lessons = Stage(), MemoryLessons()
    stage.lessons = lessons
    stage.room = stage.new_room()
    await stage.room.start_up()
    early = [await stage.room.drafts.create(joint(), "anna") for _ in range(3)]
    first, second = [await flown(stage, lessons, mission_id) for mission_id in early[:2]]
    lessons.full = True
    third = await flown(stage, lessons, early[2])
    await stage.room.shut_down()
    known = [one.learned for one in (first, second, third)]
    assert [one and one.flights for one in known] == [0, 1, 2]
    assert len({str(one) for one in known}) == 3
    assert [one.mission_id for one in lessons.kept] == early[:2]
    again = fold(await stage.journal.read(early[1]))
    assert again.search.mission.sensor.learned == second.learned


async def test_what_is_taken_off_bearings_is_flown_and_stays_known_with_what_was_learned() -> None:
    stage, lessons = Stage(), MemoryLessons()
    stage.lessons = lessons
    stage.finder = finder = HearingFinder()
    stage.room = stage.new_room()
    await stage.room.start_up()
    offset = SensorSpec(bearing_errors="joint", bearing_offset_deg=6.5)
    mission_id = await stage.room.drafts.create(spec().model_copy(update={"sensor": offset}), "anna")
    started = await flown(stage, lessons, mission_id)
    await stage.room.shut_down()
    assert started.antenna is not None
    assert started.antenna.offset_to_nose_deg == PATTERN.offset_to_nose_deg - 6.5
    assert finder.mounted == {PATTERN.offset_to_nose_deg - 6.5}, "at every sweep, in flight"
    assert [one.taken_off_deg for one in lessons.kept] == [6.5]


async def test_where_the_emitter_was_found_teaches_in_the_place_of_what_the_bearings_alone_did() -> None:
    stage, lessons = Stage(), MemoryLessons()
    stage.lessons = lessons
    stage.room = stage.new_room()
    await stage.room.start_up()
    mission_id = await stage.room.drafts.create(joint(), "anna")
    truth = HOME
    await stage.room.review.tell_truth(mission_id, None, truth, 5.0, "map", "anna")
    assert lessons.tried == 0, "a draft has taught nothing yet"
    await flown(stage, lessons, mission_id)
    said: list[Lesson] = [*lessons.kept]
    for place in (None, truth):
        await stage.room.review.tell_truth(mission_id, None, place, 5.0, "map", "anna")
        said += lessons.kept
    assert [one.place_known for one in said] == [True, False, True]
    assert said[0] == said[2] != said[1]
    lessons.full = True
    await stage.room.review.tell_truth(mission_id, None, None, None, "map", "anna")
    assert lessons.kept == said[2:], "what cannot be kept stops nobody"
    lessons.full = False
    lessons.kept.clear()
    await stage.room.review.tell_truth(mission_id, None, truth, 5.0, "map", "anna")
    assert lessons.kept == [], "what was forgotten stays forgotten"
    await stage.room.shut_down()


async def test_a_mission_with_independent_errors_is_told_nothing_and_teaches_nothing() -> None:
    stage, lessons = Stage(), MemoryLessons()
    stage.lessons = lessons
    stage.room = stage.new_room()
    await stage.room.start_up()
    mission_id = await stage.room.drafts.create(spec(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until_true(lambda: stage.vehicle.names[-1:] == ["land"], wall_s=60.0)
    stage.vehicle.touch_down()
    await stage.until_mission(mission_id, "done")
    await stage.until_true(lambda: stage.room.flights.active is None)
    await stage.room.shut_down()
    (started,) = stage.journal.of_kind(mission_id, MissionStarted)
    assert started.learned is None
    assert lessons.tried == 0
