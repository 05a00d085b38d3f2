"""The binary frame of one belief: 4-byte little-endian header length, JSON header, body.

Header: {"type": "belief", "mission_id", "bearings", "nx", "ny", "bounds": [[lon, lat] x 4: SW, SE, NE, NW],
"encoding": "f32-shuffle-zlib" | "u8-log-zlib", "peak": float}. Body: ny rows of nx cells, south to north, west to
east, probability a cell divided by `peak`. f32-shuffle-zlib: float32 little-endian, bytes shuffled (all first bytes,
then all second ...), zlib level 1. u8-log-zlib: 0 = zero, else round(255 * (1 + log10(p) / 6)) clipped to 1..255.
"""
