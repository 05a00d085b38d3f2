"""One validator for a large union, shared by all models that hold it.

pydantic builds a union's validator again for each model: some 350 classes in forty models took ten seconds of a start.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic import ConfigDict, GetCoreSchemaHandler, GetJsonSchemaHandler, TypeAdapter
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

BY_NAME = "x-by-name"
"""Key of a schema that only names another one."""


class ByOneAdapter:
    """Annotates a union. name: in schemas. named: gives the union, which may not be complete yet when this is made."""

    def __init__(self, name: str, named: Callable[[], Any]) -> None:
        self.name = name
        self._named = named
        self._built: TypeAdapter[Any] | None = None

    @property
    def adapter(self) -> TypeAdapter[Any]:
        """Built when the first value comes."""
        if self._built is None:
            self._built = TypeAdapter(self._named(), config=ConfigDict(extra="forbid"))
        return self._built

    def __get_pydantic_core_schema__(self, _source: Any, _handler: GetCoreSchemaHandler) -> CoreSchema:
        def validate(value: Any) -> Any:
            return self.adapter.validate_python(value)

        def dump(value: Any, info: core_schema.SerializationInfo) -> Any:
            return self.adapter.dump_python(value, mode="json" if info.mode_is_json() else "python")

        return core_schema.no_info_plain_validator_function(
            validate,
            serialization=core_schema.plain_serializer_function_ser_schema(dump, info_arg=True),
        )

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """By name only: whoever writes the whole schema adds what `described` gives and refers to it."""
        return {BY_NAME: self.name}

    def described(self, ref_template: str) -> dict[str, JsonSchemaValue]:
        """The union under its name, and each of its classes under theirs."""
        schema = self.adapter.json_schema(ref_template=ref_template, mode="serialization")
        classes = schema.pop("$defs")
        return {**classes, self.name: schema}
