"""Why something in the hardware is so, or cannot be: a module a kind, each with a union of its reasons.

Values are in SI with the unit in the name; angles in degrees, as they are shown. All of them together: see union.py.
Nothing is imported here, so that a vehicle left in flight is held before the reasons of antennas and files are loaded.
"""
