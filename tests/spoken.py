"""Every reason with values and its English, which the page's own renderer must write alike (`reasons.test.ts`).

`python -m tests.spoken FILE` writes it, `--check FILE` fails when FILE is not what the classes say.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, fields, is_dataclass

from backend.generated import write_or_check
from backend.reasons.catalogue import reason_classes
from planner.reason import Reason, remedy_of, text_of
from tests.reasons import examples


def spoken() -> str:
    """JSON, one example a line: the reason as the wire carries it, its text and its remedy."""
    said = [
        json.dumps([asdict(one), text_of(one), remedy_of(one)], ensure_ascii=False)  # type: ignore[call-overload]
        for reason in reason_classes()
        for one in told_apart(reason)
    ]
    return "[\n" + ",\n".join(said) + "\n]\n"


def told_apart(reason: type[Reason]) -> Iterator[Reason]:
    """The examples in which a reason's own values differ; what it may hold inside is an example by itself."""
    first, *others = examples(reason)
    yield first
    for other in others:
        changed = [
            (getattr(first, field.name), getattr(other, field.name))
            for field in fields(first)  # type: ignore[arg-type]
            if getattr(first, field.name) != getattr(other, field.name)
        ]
        if not any(_holds_reason(value) for pair in changed for value in pair):
            yield other


def _holds_reason(value: object) -> bool:
    inside = value if isinstance(value, tuple) else (value,)
    return any(is_dataclass(one) for one in inside)


if __name__ == "__main__":
    write_or_check(spoken(), "every reason in English")
