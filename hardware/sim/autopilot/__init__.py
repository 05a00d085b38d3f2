"""A simulated multicopter that is a MAVLink autopilot in its own process: `python -m hardware.sim.autopilot --help`."""
