"""What the autopilot says reaches whoever listens: whole, printable, and with its weight."""

from __future__ import annotations

import asyncio

import pytest
from rig import FLIGHT_COMMANDS, Rig

from hardware.autopilot.messages import REPOSITION
from hardware.fence import FencePolygon, MissionNets
from hardware.ports import PlaceRefused
from hardware.reasons.preflight import ArmingChecked
from hardware.reasons.vehicle import AutopilotRefused, PlaceNotTaken
from hardware.reasons.vehicle_news import AutopilotSaid, TriedAgain

LONG = "Preflight Fail: the compass needs calibration, and then some more words until it takes three chunks to say."


def said(rig: Rig) -> list[AutopilotSaid]:
    return [news for news in rig.news if isinstance(news, AutopilotSaid)]


async def heard(rig: Rig, text: str) -> AutopilotSaid:
    await rig.until(lambda: any(one.text == text for one in said(rig)), 20, f"hearing {text!r}")
    return next(one for one in said(rig) if one.text == text)


async def test_words_come_whole_with_their_weight(rig: Rig) -> None:
    await rig.sim.order("say", text="Low battery", severity=4)
    assert (await heard(rig, "Low battery")).severity == "warning"
    await rig.sim.order("say", text=LONG, severity=2)
    assert (await heard(rig, LONG)).severity == "critical"
    await rig.sim.order("say", text="x" * 100, severity=3)
    assert (await heard(rig, "x" * 100)).severity == "error"
    await rig.sim.order("say", text="no matter", severity=6)
    await rig.sim.order("say", text=LONG, severity=2, lost=[1])
    await heard(rig, LONG[:50] + "…" + LONG[100:])
    assert all(one.text != "no matter" for one in said(rig))


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        (b"\x1b[2J\x07\xff\xfe\x80 oops\r\n{}%s", "oops"),
        ("über 5 °C ⚠".encode(), "über 5 °C ⚠"),
        (b'"quoted\\ \x00 hidden', '"quoted\\'),
        (b"\xe2\x82" * 40, None),
    ],
)
async def test_hostile_words_do_no_harm(rig: Rig, words: bytes, shown: str | None) -> None:
    await rig.sim.order("say", hex=words.hex(), severity=2)
    await rig.sim.order("say", text="after it", severity=2)
    await heard(rig, "after it")
    found = [one.text for one in said(rig)]
    assert all(text.isprintable() for text in found)
    if shown is not None:
        assert any(shown in text for text in found), found


async def test_a_place_beyond_the_fence_is_refused_at_once_and_not_ordered_again(rig: Rig) -> None:
    home = rig.vehicle.telemetry().home
    assert home is not None
    corners = tuple(rig.place(east, north) for east, north in ((-50, -50), (50, -50), (50, 50), (-50, 50)))
    fence = (FencePolygon(corners, inside=True),)
    plan = await rig.vehicle.plan_nets(MissionNets(home, fence, fence, 40.0, 40.0))
    try:
        await rig.vehicle.set_nets(plan.after)
        await rig.airborne()
        began = 0.0 if rig.autopilot is None else (await rig.sim.order("ping"))["time_s"]
        with pytest.raises(PlaceRefused) as refused:
            await rig.vehicle.goto(rig.place(0.0, 200.0), rig.amsl(), 5.0)
        assert isinstance(refused.value.reason, PlaceNotTaken)
        assert rig.off_by(rig.place(0.0, 0.0)) < 5.0
        if rig.autopilot is not None:
            sent = (await rig.sim.order("commands", since_s=began))["commands"]
            assert [number for _, number in sent if number in FLIGHT_COMMANDS] == [REPOSITION]
        await rig.vehicle.goto(rig.place(0.0, 20.0), rig.amsl(), 5.0)
        await rig.vehicle.land()
        await rig.until(lambda: rig.vehicle.telemetry().armed is False, 120, "landing")
    finally:
        await rig.vehicle.set_nets(plan.before)


async def test_why_it_does_not_arm_is_told_in_its_own_words(rig: Rig) -> None:
    await rig.sim.order("prearm", ok=False)
    take_off = asyncio.create_task(rig.vehicle.take_off(10.0))

    def told() -> bool:
        return any(
            isinstance(news, TriedAgain)
            and isinstance(news.because, AutopilotRefused)
            and "position estimate is not ready" in news.because.said
            for news in rig.news
        )

    await rig.until(told, 30, "the reason")
    (row,) = [check for check in await rig.vehicle.preflight() if check.name == "ready_to_arm"]
    assert isinstance(row.reason, ArmingChecked)
    assert "position estimate is not ready" in row.reason.said
    await rig.sim.order("prearm", ok=True)
    await asyncio.wait_for(take_off, 60)
