"""What every fact is: frozen, told apart by `kind`, of finite numbers only."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, cast

from pydantic import BeforeValidator, ConfigDict

from backend.spec import Model


class Fact(Model):
    """A number that is not finite cannot be stored: it is refused where the fact is made."""

    model_config = ConfigDict(allow_inf_nan=False)


def _known(value: object) -> object:
    return None if isinstance(value, float) and not math.isfinite(value) else value


Known = Annotated[float | None, BeforeValidator(_known)]
"""A number that may be unknown: NaN and infinity are None."""


def _each_known(values: object) -> object:
    """As `_known` for each, without a call for each: a bearing has 360 of them."""
    if not isinstance(values, list | tuple):
        return values
    row = cast("Sequence[object]", values)
    return [None if value != value or value in UNKNOWN else value for value in row]  # NaN is not itself


UNKNOWN = (math.inf, -math.inf)

KnownRow = Annotated[list[float | None], BeforeValidator(_each_known)]
"""Numbers of which each may be unknown."""
