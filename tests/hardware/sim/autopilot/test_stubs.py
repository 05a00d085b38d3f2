"""The types that typings/ gives pymavlink's dialects are those that the dialects themselves have."""

from __future__ import annotations

import ast
import inspect
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, get_type_hints

import pytest

STUBS = Path(__file__).resolve().parents[4] / "typings" / "pymavlink" / "dialects" / "v20"


def assert_called_so(stub: ast.FunctionDef, real: Any, dialect: ModuleType) -> None:
    """The stub's parameters are the first ones of `real`, with its types; what is left out has a default there."""
    types = get_type_hints(real)
    parameters = list(inspect.signature(real).parameters.values())
    names = [one.arg for one in stub.args.args]
    assert names == [one.name for one in parameters[: len(names)]]
    assert all(one.default is not inspect.Parameter.empty for one in parameters[len(names) :])
    for one in stub.args.args[1:]:
        assert one.annotation is not None
        assert eval(ast.unparse(one.annotation), vars(dialect)) == types[one.arg]
    defaults = len(stub.args.defaults)
    for parameter in parameters[len(names) - defaults : len(names)]:
        assert parameter.default is not inspect.Parameter.empty


@pytest.mark.parametrize("dialect", ["development", "ardupilotmega"])
def test_a_dialect_has_what_its_stub_tells(dialect: str) -> None:
    real = import_module(f"pymavlink.dialects.v20.{dialect}")
    for said in ast.parse((STUBS / f"{dialect}.pyi").read_text()).body:
        match said:
            case ast.AnnAssign(target=ast.Name(id=name), annotation=ast.Name(id="int")):
                assert isinstance(getattr(real, name), int)
            case ast.AnnAssign(target=ast.Name(id=name)):
                assert hasattr(real, name)
            case ast.ClassDef(name=name, body=body):
                made = getattr(real, name)
                assert [base.id for base in said.bases if isinstance(base, ast.Name)] == [
                    base.__name__ for base in made.__bases__ if base is not object
                ]
                for member in body:
                    if isinstance(member, ast.FunctionDef):
                        assert_called_so(member, getattr(made, member.name), real)
            case _:
                assert isinstance(said, ast.Expr | ast.ImportFrom)
