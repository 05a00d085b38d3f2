from __future__ import annotations

from backend.craft import inputs
from backend.craft.watch.said import AGAIN_S, BURST, FORGOTTEN_S, MOST_TEXTS, REFILL_S, SaidWatch
from hardware.reasons.vehicle_news import AutopilotRepeats, AutopilotSaid, AutopilotSaidMore

WIND = AutopilotSaid("warning", "High wind")


def test_a_text_is_told_at_once_and_then_counted() -> None:
    watch = SaidWatch()
    assert watch.hear(WIND, 0.0) == [inputs.Said(WIND)]
    for second in range(1, 8):
        assert watch.hear(WIND, float(second)) == []
        assert watch.look(float(second)) == []
    assert watch.look(AGAIN_S) == [inputs.Said(AutopilotRepeats("warning", "High wind", 8))]
    assert watch.look(AGAIN_S + 1.0) == []


def test_what_repeats_for_an_hour_is_a_few_facts_and_the_count_is_right() -> None:
    watch, told, last = SaidWatch(), 0, 0
    for second in range(3_600):
        found = watch.hear(WIND, float(second)) + watch.look(float(second))
        told += len(found)
        reasons = [given.reason for given in found if isinstance(given, inputs.Said)]
        last = max([last, *(reason.times for reason in reasons if isinstance(reason, AutopilotRepeats))])
    assert told < 15
    assert last > 1_800


def test_a_text_that_is_not_heard_any_more_is_over_and_new_when_it_comes_again() -> None:
    watch = SaidWatch()
    watch.hear(WIND, 0.0)
    assert watch.look(FORGOTTEN_S + 1.0) == [inputs.SaidNoMore("High wind")]
    assert watch.hear(WIND, FORGOTTEN_S + 2.0) == [inputs.Said(WIND)]


def test_a_flood_is_bounded_and_what_is_left_out_is_counted() -> None:
    watch, told, more = SaidWatch(), 0, 0
    for number in range(2_000):
        now_s = number * 0.01
        for given in watch.hear(AutopilotSaid("critical", f"text {number}"), now_s) + watch.look(now_s):
            assert isinstance(given, inputs.Said)
            if isinstance(given.reason, AutopilotSaidMore):
                more += given.reason.texts
            else:
                told += 1
    rest = watch.look(20.0 + REFILL_S * 2)
    more += sum(g.reason.texts for g in rest if isinstance(g, inputs.Said) and isinstance(g.reason, AutopilotSaidMore))
    assert told <= BURST + 20.0 / REFILL_S + 1
    assert told + more == 2_000
    assert len(watch._heard) <= MOST_TEXTS
