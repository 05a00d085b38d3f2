"""A fact gets no field without a new form: texts of the present form are sent as they are stored."""

from __future__ import annotations

import json
from pathlib import Path

from backend.events import FORM
from backend.first_hold import FORMS
from backend.store.upgrade import FIRST_FORM, READ_AS_IT_STANDS
from tests.fact_fields import fact_fields

GOLDEN = Path(__file__).with_name("facts.json")


def test_fields_change_with_the_form_only() -> None:
    golden = json.loads(GOLDEN.read_text())
    now = fact_fields()
    changed = [name for name, fields in golden["fields"].items() if now.get(name, fields) != fields]
    assert not changed or golden["form"] < FORM, (
        f"{changed} have other fields than the facts that are stored in form {FORM}: raise FORM in backend.events, see "
        "that backend.store.upgrade reads the form before, then record again: python -m tests.fact_fields FILE"
    )


def test_every_form_of_before_is_read() -> None:
    assert {FIRST_FORM, *READ_AS_IT_STANDS} == set(range(FIRST_FORM, FORM + 1))
    assert set(FORMS) <= READ_AS_IT_STANDS
    assert FORM in FORMS
