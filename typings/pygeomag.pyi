"""What Crossfix calls of pygeomag 1.1."""

from datetime import datetime

class GeoMagResult:
    d: float
    """Declination, degrees: magnetic north east of true north."""

class GeoMag:
    def __init__(self, *, base_year: datetime) -> None: ...
    def calculate(self, glat: float, glon: float, alt: float, time: float) -> GeoMagResult:
        """glat, glon: degrees. alt: km. time: year and its part."""
