"""The wire schema: complete, unambiguous, and what the committed types were made from."""

from __future__ import annotations

import json
from typing import Any, get_args

import pytest
from pydantic import TypeAdapter

from backend.api.schema import wire_schema, wire_schema_text
from backend.commands import Command
from backend.events import Event
from backend.settings import REPOSITORY
from backend.wire.messages import LiveMessage


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    return wire_schema("0")


@pytest.fixture(scope="module")
def schemas(schema: dict[str, Any]) -> dict[str, Any]:
    return schema["components"]["schemas"]


def references(part: Any) -> set[str]:
    if isinstance(part, dict):
        found = {part["$ref"]} if isinstance(part.get("$ref"), str) else set()
        return found.union(*(references(value) for value in part.values()))
    return set().union(*(references(value) for value in part)) if isinstance(part, list) else set()


def test_every_reference_leads_somewhere(schema, schemas):
    assert {ref.removeprefix("#/components/schemas/") for ref in references(schema)} <= set(schemas)


@pytest.mark.parametrize(("name", "union"), [("LiveMessage", LiveMessage), ("Event", Event), ("Command", Command)])
def test_each_union_is_there_by_name_with_all_its_members(schemas, name, union):
    members = {ref.removeprefix("#/components/schemas/") for ref in references(schemas[name])}
    assert members == {member.__name__ for member in get_args(get_args(union)[0])}


def test_what_is_sent_always_has_all_fields_and_what_is_asked_may_leave_defaults_out(schemas):
    assert set(schemas["SensorSpec"]["required"]) == set(schemas["SensorSpec"]["properties"])
    assert "required" not in schemas["SensorSpecInput"]
    assert schemas["MissionSpecInput"]["required"] == ["name", "area"]
    assert schemas["HoldInput"]["required"] == ["kind"]


def test_every_answer_but_success_is_a_problem(schema):
    for path, operations in schema["paths"].items():
        for operation in operations.values():
            content = operation["responses"]["default"]["content"]
            assert list(content) == ["application/problem+json"], path


def test_operations_have_plain_distinct_names(schema):
    names = [operation["operationId"] for item in schema["paths"].values() for operation in item.values()]
    assert len(names) == len(set(names))
    assert all(name.isidentifier() for name in names)


def test_the_committed_schema_is_what_the_code_says():
    assert (REPOSITORY / "frontend/src/wire/openapi.json").read_text() == wire_schema_text(), "run `make codegen`"


def test_the_schema_says_what_pydantic_sends(schemas):
    sent = TypeAdapter(LiveMessage).json_schema(mode="serialization")
    assert set(sent["$defs"]) <= set(schemas)
    assert json.loads(wire_schema_text()) == wire_schema("0.1.0")


def test_no_two_classes_of_the_wire_share_a_name(schemas):
    """pydantic would tell them apart by their modules, which are no part of the wire."""
    assert [name for name in schemas if "__" in name] == []
