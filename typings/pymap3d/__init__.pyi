"""What Crossfix calls of pymap3d 3.2. Angles in degrees, lengths in metres."""

from typing import SupportsFloat, overload

import numpy as np
from numpy.typing import NDArray
from pymap3d import vincenty as vincenty

_Floats = NDArray[np.float64]

@overload
def geodetic2enu(
    lat: float, lon: float, h: float, lat0: float, lon0: float, h0: float
) -> tuple[SupportsFloat, SupportsFloat, SupportsFloat]: ...
@overload
def geodetic2enu(
    lat: _Floats, lon: _Floats, h: float, lat0: float, lon0: float, h0: float
) -> tuple[_Floats, _Floats, _Floats]: ...
@overload
def enu2geodetic(
    e: float, n: float, u: float, lat0: float, lon0: float, h0: float
) -> tuple[SupportsFloat, SupportsFloat, SupportsFloat]: ...
@overload
def enu2geodetic(
    e: _Floats, n: _Floats, u: float, lat0: float, lon0: float, h0: float
) -> tuple[_Floats, _Floats, _Floats]: ...
