"""What Crossfix calls of pymap3d.vincenty 3.2. Angles in degrees, lengths in metres."""

from typing import SupportsFloat, overload

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

@overload
def vdist(Lat1: float, Lon1: float, Lat2: float, Lon2: float) -> tuple[SupportsFloat, SupportsFloat]: ...
@overload
def vdist(Lat1: _Floats, Lon1: _Floats, Lat2: float, Lon2: float) -> tuple[_Floats, _Floats]: ...
def vreckon(Lat1: _Floats, Lon1: _Floats, Rng: _Floats, Azim: _Floats) -> tuple[_Floats, _Floats]: ...
