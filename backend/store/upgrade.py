"""Stored facts of before in the words of today. Nothing is rewritten: every reader upgrades what it reads.

Each stored event says the form of its body. In form 1 a mission has one craft and one emitter without ids, a reason is
a sentence, `draft`, `ready` and the ends of a mission are phases of the craft, and control is taken or released. Forms
2 to 4 may lack fields that were added since, each of which has a default: read, it is whole. Form 5 has every field of
backend.events, so that its text is sent as it is stored. Pure; a body is the parsed JSON of one event.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any
from uuid import UUID

from backend.events import FIRST_CRAFT, FORM
from backend.spec import FIRST_EMITTER

FIRST_FORM = 1
READ_AS_IT_STANDS = frozenset({2, 3, 4, FORM})

Body = dict[str, Any]
Imports = Mapping[str, str]
"""Recording id by sweep id, of the sweeps that came out of recordings."""


def imports_of(bodies: Iterable[Body]) -> dict[str, str]:
    """The sweeps that these `recording_imported` facts name."""
    return {sweep_id: body["recording_id"] for body in bodies for sweep_id in body["sweep_ids"]}


def upgraded(body: Body, imports: Imports) -> Body:
    """A body of form 1 in the words of today. Raises KeyError, ValueError for what never was a fact."""
    kind = body["kind"]
    now = CHANGED[kind](body) if kind in CHANGED else dict(body)
    if kind in OF_THE_CRAFT:
        now["craft_id"] = FIRST_CRAFT
    if kind in OF_THE_EMITTER:
        now["emitter_id"] = FIRST_EMITTER
    if kind in OF_A_SWEEP:
        now["source"] = _source(body["sweep_id"], imports)
    return now


def kinds_of_old(kinds: Iterable[str]) -> set[str]:
    """The kinds under which facts of these kinds may be stored, in any form."""
    wanted = set(kinds)
    return wanted | {"control_taken", "control_released"} if "authority_changed" in wanted else wanted


def craft_of_sweep(sweep_id: str) -> str | None:
    """Who took a sweep of form 1; None for an imported one, whose id was made from its recording (UUID version 5)."""
    try:
        return None if UUID(sweep_id).version == 5 else FIRST_CRAFT
    except ValueError:
        return FIRST_CRAFT


def told_before(text: str, remedy: str = "") -> Body:
    """A reason that was a sentence."""
    return {"code": "told_before", "text": _sentence(text), "remedy": _sentence(remedy)}


def _sentence(text: str) -> str:
    """Sentences were stored without capital and full stop. A file's name keeps its first letter."""
    text = text.strip()
    if not text:
        return ""
    word = text.split(maxsplit=1)[0].rstrip(":;,.")
    begun = text[0].upper() + text[1:] if word.replace("-", "").isalpha() else text
    return begun if begun[-1] in ".!?" else begun + "."


def _source(sweep_id: str, imports: Imports) -> Body:
    if sweep_id in imports:
        return {"kind": "import", "recording_id": imports[sweep_id]}
    return {"kind": "craft", "craft_id": FIRST_CRAFT}


def _without(body: Body, *names: str) -> Body:
    return {name: value for name, value in body.items() if name not in names}


def _reasoned(body: Body) -> Body:
    return body | {"reason": told_before(body["reason"])}


def _detailed(body: Body) -> Body:
    return _without(body, "detail") | {"reason": told_before(body["detail"])}


def _specified(body: Body) -> Body:
    """The prior belongs to the emitter now."""
    spec = _without(body["spec"], "emitter", "prior")
    prior = {"prior": body["spec"]["prior"]} if "prior" in body["spec"] else {}
    spec["emitters"] = [{"emitter_id": FIRST_EMITTER} | body["spec"].get("emitter", {}) | prior]
    if "timers" in spec:
        spec["timers"] = _without(spec["timers"], "vehicle_command_s")
    return body | {"spec": spec}


def _area_changed(body: Body) -> Body:
    search = body["search"]
    return body | {"search": _without(search, "prior") | {"priors": {FIRST_EMITTER: search["prior"]}}}


CHECKS = (
    ("vehicle link", "vehicle_link"),
    ("gps", "gps"),
    ("position", "position"),
    ("heading", "heading"),
    ("battery", "battery"),
    ("home position", "home"),
    ("ready to arm", "ready_to_arm"),
    ("control", "control"),
    ("failsafe", "failsafe"),
    ("receiver", "receiver"),
    ("antenna pattern", "pattern"),
    ("antenna", "antenna"),
    ("area", "area"),
    ("safety", "safety"),
)
"""How a check's name began, in lower case, and its name now; the first that fits."""


def _check(check: Body) -> Body:
    """A name went on with the parameter of the autopilot, or the rule of safety, that was checked."""
    began, name = next((began, name) for began, name in CHECKS if check["name"].lower().startswith(began))
    about = check["name"][len(began) :].strip(" :")
    detail = f"{about}: {check['detail']}" if name == "failsafe" and about else check["detail"]
    reason = told_before(detail, check["remedy"])
    return {"name": name, "ok": check["ok"], "reason": reason, "blocking": check["blocking"]}


def _preflight(body: Body) -> Body:
    return body | {"checks": [_check(check) for check in body["checks"]]}


def _antenna_checked(body: Body) -> Body:
    return body | {"check": _check(body["check"])}


NOT_FLYING = frozenset({"draft", "ready", "done", "aborted", "failed"})
LOCALIZED = "localized"


def _phase_changed(body: Body) -> Body:
    """The way home of a search that was successful is recognized by its reason."""
    phases = {name: "ground" if body[name] in NOT_FLYING else body[name] for name in ("before", "after")}
    reason = {"code": "localized"} if body["reason"] == LOCALIZED else told_before(body["reason"])
    return body | phases | {"reason": reason}


def _ordered(body: Body) -> Body:
    """What the mission ordered by itself was ordered by nobody; of a person's order no reason was known."""
    by = None if body["by"] == "mission" else body["by"]
    return body | {"by": by, "reason": None if body["reason"] in ("", "ordered") else told_before(body["reason"])}


ASKEW = "seem to be off by the same angle"


def _belief_updated(body: Body) -> Body:
    offset, error = body.get("heading_offset_deg"), body.get("heading_offset_std_error_deg")
    known = offset is not None and error is not None
    askew = {"code": "headings_askew", "offset_deg": offset, "std_error_deg": error}
    return body | {"not_yet": [askew if known and ASKEW in why else told_before(why) for why in body["not_yet"]]}


def _recording_imported(body: Body) -> Body:
    return body | {"remarks": [told_before(remark) for remark in body["remarks"]]}


def _control_taken(body: Body) -> Body:
    authority = {"who": "pilot", "taken_by": "mode", "mode": body["mode"]}
    return {"kind": "authority_changed", "craft_id": FIRST_CRAFT, "authority": authority, "by": None}


def _control_released(body: Body) -> Body:
    return {"kind": "authority_changed", "craft_id": FIRST_CRAFT, "authority": {"who": "ours"}, "by": body["by"]}


def _command_refused(body: Body) -> Body:
    return _without(body, "remedy") | {"reason": told_before(body["reason"], body.get("remedy", ""))}


def _safety_vetoed(body: Body) -> Body:
    return {"kind": body["kind"], "reason": told_before(body["detail"], body["remedy"])}


OF_THE_MISSION = frozenset({"heading", "storage"})
"""Topics of alerts that no craft has."""


def _alert_raised(body: Body) -> Body:
    """The id of an alert was its topic and a number."""
    topic = body["alert_id"].rsplit("-", 1)[0]
    craft_id = None if topic in OF_THE_MISSION else FIRST_CRAFT
    kept = {"topic": topic, "craft_id": craft_id, "reason": told_before(body["text"], body["remedy"])}
    return _without(body, "text", "remedy") | kept


CHANGED: dict[str, Callable[[Body], Body]] = {
    "mission_drafted": _specified,
    "mission_edited": _specified,
    "area_changed": _area_changed,
    "preflight_checked": _preflight,
    "antenna_checked": _antenna_checked,
    "phase_changed": _phase_changed,
    "plan_chosen": _reasoned,
    "sweep_rejected": _reasoned,
    "recording_imported": _recording_imported,
    "belief_updated": _belief_updated,
    "hold_ordered": _ordered,
    "return_ordered": _ordered,
    "abort_ordered": lambda body: _without(body, "reason"),
    "control_taken": _control_taken,
    "control_released": _control_released,
    "command_refused": _command_refused,
    "safety_vetoed": _safety_vetoed,
    "link_lost": _detailed,
    "alert_raised": _alert_raised,
    "server_restarted": lambda body: _without(body, "detail"),
    "mission_ended": _reasoned,
}
OF_THE_CRAFT = frozenset(
    {
        "mission_started", "phase_changed", "took_off", "plan_chosen", "plan_vetoed", "flight_started", "place_reached",
        "sweep_started", "hold_ordered", "resume_ordered", "return_ordered", "abort_ordered", "automatic_changed",
        "safety_vetoed", "link_lost", "link_restored",
    }
)  # fmt: skip
OF_THE_EMITTER = frozenset(
    {"sweep_rejected", "bearing_measured", "recording_imported", "bearing_excluded", "belief_updated"}
)
OF_A_SWEEP = frozenset({"sweep_rejected", "bearing_measured"})
