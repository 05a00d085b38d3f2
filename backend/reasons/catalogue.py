"""The page's English: every reason's words by its code, as the classes have them.

`python -m backend.reasons.catalogue FILE` writes it, `--check FILE` fails when FILE is not what the classes say.
"""

from __future__ import annotations

import json
from typing import get_args, get_type_hints

from backend.generated import write_or_check
from backend.reasons import ReasonUnion
from planner.reason import Reason as AnyReason
from planner.reason import Words

HEAD = """\
// English for every reason, generated from the classes: `make codegen` writes it.
import type { ReasonTable } from "./reasons";

export const reasonsEn: ReasonTable = {
"""
LINE = 140
"""As wide as the page's formatter makes a line."""


def reason_classes() -> tuple[type[AnyReason], ...]:
    """Every class of the union, in its order."""
    union, _ = get_args(ReasonUnion.__value__)
    return get_args(union)


def code_of(reason: type[AnyReason]) -> str:
    """Without an instance: a reason's values need not be known."""
    (code,) = get_args(get_type_hints(reason)["code"])
    return code


def english_table() -> str:
    """TypeScript, formatted as the page's formatter would."""
    entries = (_entry(code_of(reason), reason.english) for reason in reason_classes())
    return f"{HEAD}{''.join(entries)}}};\n"


def _entry(code: str, words: Words) -> str:
    literals = [_literal(one) for one in (words.text, words.remedy) if one]
    line = f"  {code}: [{', '.join(literals)}],\n"
    if len(line) <= LINE + 1:
        return line
    return "".join([f"  {code}: [\n", *(f"    {literal},\n" for literal in literals), "  ],\n"])


def _literal(words: str) -> str:
    """In the quotes that need fewer escapes."""
    double = json.dumps(words, ensure_ascii=False)
    if words.count('"') <= words.count("'"):
        return double
    return "'" + double[1:-1].replace('\\"', '"').replace("'", "\\'") + "'"


if __name__ == "__main__":
    write_or_check(english_table(), "the page's English for every reason")
