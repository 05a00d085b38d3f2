"""What every fact is: frozen, told apart by `kind`, of finite numbers only."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import BeforeValidator, ConfigDict

from backend.spec import Model


class Fact(Model):
    """A number that is not finite cannot be stored: it is refused where the fact is made."""

    model_config = ConfigDict(allow_inf_nan=False)


def _known(value: object) -> object:
    return None if isinstance(value, float) and not math.isfinite(value) else value


Known = Annotated[float | None, BeforeValidator(_known)]
"""A number that may be unknown: NaN and infinity are None."""
