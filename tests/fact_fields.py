"""Every field of every stored fact, with the form that it is of: a stored text of the present form is sent as it lies
there, so it must have them all.

`python -m tests.fact_fields FILE` writes it, `--check FILE` fails when FILE is not what the classes say.
"""

from __future__ import annotations

import json
from dataclasses import fields

from pydantic import TypeAdapter

from backend.events import FORM, Event
from backend.generated import write_or_check
from backend.reasons.catalogue import reason_classes


def fact_fields() -> dict[str, list[str]]:
    """Names of fields by class: facts, what they hold (places, parts of a specification), and every reason."""
    described = TypeAdapter[Event](Event).json_schema(mode="serialization")["$defs"]
    of_facts = {name: sorted(described[name].get("properties", {})) for name in sorted(described)}
    return of_facts | {
        reason.__name__: sorted(field.name for field in fields(reason))  # type: ignore[arg-type]
        for reason in reason_classes()
    }


def told() -> str:
    """JSON, one class a line."""
    lines = [f"  {json.dumps(name)}: {json.dumps(named)}" for name, named in fact_fields().items()]
    return f'{{"form": {FORM}, "fields": {{\n' + ",\n".join(lines) + "\n}}\n"


if __name__ == "__main__":
    write_or_check(told(), "the fields of every stored fact")
