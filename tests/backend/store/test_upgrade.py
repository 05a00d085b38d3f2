"""Facts of form 1 in the words of today. Whole journals are in tests/golden; here is what those do not hold."""

from __future__ import annotations

import pytest

from backend.events import FORM
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import (
    CHECKS,
    FIRST_FORM,
    craft_of_sweep,
    imports_of,
    kinds_of_old,
    told_before,
    upgraded,
)

IMPORTED, FLOWN = "9f1c1a54-6d5b-5c6e-8d1f-0a4c8a3f1b2c", "9f1c1a54-6d5b-4c6e-8d1f-0a4c8a3f1b2c"


def test_the_prior_goes_to_the_emitter_and_the_vehicles_patience_is_dropped() -> None:
    ring = {"kind": "ring", "centre": {"lat": 50.6, "lon": 7.2}, "inner_m": 0, "outer_m": 90}
    spec = {"name": "s", "prior": ring, "emitter": {"label": "tag"}, "timers": {"vehicle_command_s": 60}}
    now = upgraded({"kind": "mission_drafted", "spec": spec}, {})["spec"]
    assert now == {"name": "s", "emitters": [{"emitter_id": "emitter-1", "label": "tag", "prior": ring}], "timers": {}}
    search = {"area": "here", "prior": ring, "fence": None}
    changed = upgraded({"kind": "area_changed", "search": search, "by": "o"}, {})["search"]
    assert changed == {"area": "here", "priors": {"emitter-1": ring}, "fence": None}


def test_a_specification_of_little_keeps_its_defaults() -> None:
    now = upgraded({"kind": "mission_edited", "spec": {"name": "s"}}, {})["spec"]
    assert now == {"name": "s", "emitters": [{"emitter_id": "emitter-1"}]}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("nothing heard for 5 s", "Nothing heard for 5 s."),
        ("vehicle: gone", "Vehicle: gone."),
        ("turn0.csv: it says nothing", "turn0.csv: it says nothing."),
        ("Wait for a fix.", "Wait for a fix."),
        ("-9999 is no power", "-9999 is no power."),
        ("  ", ""),
    ],
)
def test_sentences_get_their_capital_and_full_stop(text: str, sentence: str) -> None:
    assert told_before(text)["text"] == sentence


@pytest.mark.parametrize(
    ("name", "code", "said"),
    [
        ("Failsafe NAV_DLL_ACT", "failsafe", "NAV_DLL_ACT: it is 0."),
        ("safety: fence", "safety", "It is 0."),
        ("antenna pattern", "pattern", "It is 0."),
        ("antenna", "antenna", "It is 0."),
        ("Home position", "home", "It is 0."),
    ],
)
def test_checks_are_named_by_codes(name: str, code: str, said: str) -> None:
    check = {"name": name, "ok": False, "detail": "it is 0", "remedy": "set it", "blocking": True}
    (now,) = upgraded({"kind": "preflight_checked", "passed": False, "checks": [check]}, {})["checks"]
    assert (now["name"], now["reason"]["text"], now["reason"]["remedy"]) == (code, said, "Set it.")
    assert (now["ok"], now["blocking"]) == (False, True)


def test_every_check_of_before_has_a_code() -> None:
    names = ("Vehicle link", "GPS", "Position", "Heading", "Battery", "Home position", "Ready to arm", "Control")
    for name in (*names, "receiver", "area", "safety", "antenna"):
        assert any(name.lower() == began for began, _ in CHECKS)


def test_headings_askew_keep_their_angle() -> None:
    not_yet = ["not yet: all bearings seem to be off by the same angle; check compass", "not yet: one place only"]
    body = {"kind": "belief_updated", "not_yet": not_yet, "heading_offset_deg": -12.0}
    now = upgraded(body | {"heading_offset_std_error_deg": 2.5}, {})
    assert now["not_yet"][0] == {"code": "headings_askew", "offset_deg": -12.0, "std_error_deg": 2.5}
    assert now["not_yet"][1]["code"] == "told_before"
    assert upgraded(body, {})["not_yet"][0]["code"] == "told_before"


def test_a_pilots_takeover_is_who_flies() -> None:
    taken = upgraded({"kind": "control_taken", "mode": "POSCTL", "detail": "the vehicle is in POSCTL"}, {})
    assert taken["authority"] == {"who": "pilot", "taken_by": "mode", "mode": "POSCTL"}
    released = upgraded({"kind": "control_released", "by": "operator"}, {})
    assert (released["authority"], released["by"]) == ({"who": "ours"}, "operator")
    assert kinds_of_old(["authority_changed"]) == {"authority_changed", "control_taken", "control_released"}
    assert kinds_of_old(["took_off"]) == {"took_off"}


def test_who_ordered_what_and_why() -> None:
    def order(by: str, reason: str) -> tuple[object, object]:
        now = upgraded({"kind": "hold_ordered", "by": by, "reason": reason}, {})
        return now["by"], now["reason"]

    assert order("mission", "no console is connected") == (None, told_before("no console is connected"))
    assert order("operator", "ordered") == ("operator", None)
    assert "reason" not in upgraded({"kind": "abort_ordered", "by": "operator", "reason": "ordered"}, {})


@pytest.mark.parametrize(
    ("alert_id", "craft_id"), [("vehicle-3", "craft-1"), ("heading-1", None), ("storage-12", None)]
)
def test_an_alert_is_about_what_its_id_said(alert_id: str, craft_id: str | None) -> None:
    body = {"kind": "alert_raised", "alert_id": alert_id, "level": "caution", "text": "look", "remedy": ""}
    now = upgraded(body, {})
    assert (now["topic"], now["craft_id"], now["alert_id"]) == (alert_id.split("-")[0], craft_id, alert_id)


def test_a_sweep_came_from_the_craft_or_a_recording() -> None:
    imports = imports_of([{"kind": "recording_imported", "recording_id": "r", "sweep_ids": [IMPORTED]}])
    body = {"kind": "bearing_measured", "bearing_deg": 1.0}
    source = upgraded(body | {"sweep_id": IMPORTED}, imports)["source"]
    assert source == {"kind": "import", "recording_id": "r"}
    assert upgraded(body | {"sweep_id": FLOWN}, imports)["source"] == {"kind": "craft", "craft_id": "craft-1"}
    assert (craft_of_sweep(IMPORTED), craft_of_sweep(FLOWN), craft_of_sweep("s1")) == (None, "craft-1", "craft-1")


def test_a_body_is_not_changed_in_place() -> None:
    body = {"kind": "took_off", "altitude_relative_m": 40.0}
    assert upgraded(body, {}) == body | {"craft_id": "craft-1"}
    assert "craft_id" not in body


def test_what_a_later_crossfix_stored_is_not_guessed_at() -> None:
    with pytest.raises(ValueError, match="later Crossfix"):
        to_records("m", [EventRow(1, 0, "server_restarted", FORM + 1, '{"kind": "server_restarted"}')])
    with pytest.raises(ValueError, match="detail"):
        to_records("m", [EventRow(1, 0, "server_restarted", FORM, '{"kind": "server_restarted", "detail": "d"}')])
    old = EventRow(1, 0, "server_restarted", FIRST_FORM, '{"kind": "server_restarted", "detail": "d"}')
    assert to_records("m", [old])[0].event.kind == "server_restarted"
