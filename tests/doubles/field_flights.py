"""A mission as the field world's study flies it."""

from __future__ import annotations

from backend.cli.field_missions import FieldMission

FLOWN = FieldMission(
    seed=1,
    localized=True,
    time_s=100.0,
    in_c95=True,
    error_m=5.0,
    stated_m=8.0,
    bearings=4,
    rejected=0,
    turned_deg=1440.0,
    off_deg=(1.0, -2.0),
)
