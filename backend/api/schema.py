"""The one wire schema: REST, the websocket's union and the events in one OpenAPI document.

`python -m backend.api.schema FILE` writes it, `--check FILE` fails when FILE is not what the code says. A request
that differs from its stored form (defaults may be left out) carries the suffix Input.
"""

from __future__ import annotations

import json
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from fastapi.routing import APIRoute
from pydantic import JsonValue

from backend.api import (
    advice,
    bundles,
    compass,
    courses,
    crafts,
    entering,
    library,
    maps,
    missions,
    people,
    planning,
    provider,
    read_export,
    recordings,
    reported,
    review,
    scene,
    system,
    terrain,
    ways,
)
from backend.commands import Command
from backend.events import Event
from backend.generated import write_or_check
from backend.reasons import REASONS
from backend.reasons.adapter import BY_NAME
from backend.spec import Area
from backend.wire.messages import LiveMessage
from backend.wire.problem import Problem
from backend.wire.resources import AreaUpload

ROUTERS = (
    entering.router,
    provider.router,
    people.router,
    system.router,
    missions.router,
    crafts.router,
    compass.router,
    recordings.router,
    reported.router,
    review.router,
    library.router,
    read_export.router,
    bundles.router,
    courses.router,
    planning.router,
    advice.router,
    ways.router,
    maps.router,
    terrain.router,
    scene.router,
)

UNIONS: dict[str, Any] = {"LiveMessage": LiveMessage, "Event": Event, "Command": Command, "Area": Area}
"""Named unions of the live channel and the journal: pydantic writes them in place, the page wants them by name."""

SCHEMA_ONLY = "/schema-only/"


def operation_id(route: APIRoute) -> str:
    """The endpoint's name is what generated clients call it by."""
    return route.name


def settle_names(schemas: dict[str, Any]) -> dict[str, str]:
    """pydantic's Foo-Output becomes Foo; Foo-Input becomes FooInput, or Foo when both are the same. Old name -> new.

    A tag (`kind`, `type`) tells the members of a union apart, so a request must carry it although it has a default.
    """
    for name, schema in schemas.items():
        tags = [key for key, value in schema.get("properties", {}).items() if "const" in value]
        if name.endswith("-Input") and tags:
            schema["required"] = sorted({*schema.get("required", ()), *tags}, key=list(schema["properties"]).index)
    names = {name: name.removesuffix("-Output").replace("-Input", "Input") for name in schemas}
    merged = True
    while merged:
        merged = False
        for name in [name for name in names if name.endswith("-Input")]:
            plain = name.removesuffix("-Input")
            both_known = names[name] != plain and f"{plain}-Output" in schemas
            if both_known and renamed(schemas[name], names) == renamed(schemas[f"{plain}-Output"], names):
                names[name] = plain
                merged = True
    return names


def renamed(schema: JsonValue, names: dict[str, str]) -> Any:
    """The same schema with every reference under its new name, without the titles pydantic makes of field names."""
    prefix = "#/components/schemas/"
    if isinstance(schema, dict) and BY_NAME in schema:
        described = {key: value for key, value in schema.items() if key == "description"}
        return {"$ref": prefix + names[str(schema[BY_NAME])], **described}
    if isinstance(schema, dict):
        return {
            key: renamed(value, names)
            for key, value in schema.items()
            if not (key == "title" and isinstance(value, str))
        }
    if isinstance(schema, list):
        return [renamed(value, names) for value in schema]
    if isinstance(schema, str) and schema.startswith(prefix):
        return prefix + names[schema.removeprefix(prefix)]
    return schema


def wire_schema(version: str) -> dict[str, Any]:
    """The OpenAPI document. Schema-only routes make FastAPI name the unions' models as it names all others."""
    app = FastAPI(title="Crossfix", version=version, generate_unique_id_function=operation_id)
    for router in ROUTERS:
        app.include_router(router)
    for name, union in {**UNIONS, "Problem": Problem, "AreaUpload": AreaUpload}.items():
        app.add_api_route(SCHEMA_ONLY + name, lambda: None, response_model=union, methods=["GET"], name=name)
    document = get_openapi(title=app.title, version=app.version, routes=app.routes)
    paths, schemas = document["paths"], document["components"]["schemas"]
    schemas |= REASONS.described("#/components/schemas/{model}")
    for name in UNIONS:
        schema = paths[SCHEMA_ONLY + name]["get"]["responses"]["200"]["content"]["application/json"]["schema"]
        schema.pop("title", None)
        schemas[name] = schema
    document["paths"] = {path: item for path, item in paths.items() if not path.startswith(SCHEMA_ONLY)}
    for unused in ("HTTPValidationError", "ValidationError"):
        schemas.pop(unused, None)
    names = settle_names(schemas)
    schemas = {names[name]: schema for name, schema in sorted(schemas.items())}
    document["components"]["schemas"] = dict(sorted(schemas.items()))
    for part in ("paths", "components"):
        document[part] = renamed(document[part], names)
    return document


def wire_schema_text(version: str = "0.1.0") -> str:
    """As it is committed: indented, with a line feed at the end."""
    return json.dumps(wire_schema(version), indent=2) + "\n"


if __name__ == "__main__":
    write_or_check(wire_schema_text(), "the wire schema")
