"""One builder a MAVLink message: the firmware's state as the message an autopilot would send now."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.firmware import Firmware

Message = mavlink.MAVLink_message

EKF_STATUS_REPORT_ID = 193
"""Of ArduPilot's own dialect."""

GRAVITY = 9.81

_SENSORS = (
    mavlink.MAV_SYS_STATUS_SENSOR_3D_GYRO
    | mavlink.MAV_SYS_STATUS_SENSOR_3D_ACCEL
    | mavlink.MAV_SYS_STATUS_SENSOR_3D_MAG
    | mavlink.MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE
    | mavlink.MAV_SYS_STATUS_SENSOR_GPS
    | mavlink.MAV_SYS_STATUS_AHRS
    | mavlink.MAV_SYS_STATUS_SENSOR_BATTERY
)


_CAPABILITIES = (
    mavlink.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
    | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
)


_NONE = 65535
_UNUSED_CHANNELS = (_NONE, _NONE, _NONE, _NONE, _NONE, _NONE, _NONE, _NONE, _NONE, _NONE)
ESTIMATOR_LATE, SYS_STATUS_LATE = 5.2, 7.4
"""Seconds after the last fix at which PX4's estimator and its health say so; GPS_RAW_INT says it at once."""


def _boot_ms(firmware: Firmware) -> int:
    return int(firmware.time * 1000.0)


def _estimate(firmware: Firmware) -> tuple[int, int, float]:
    """(lat 1e-7 deg, lon 1e-7 deg, up m) as the navigation has it."""
    nav = firmware.navigation
    lat, lon = firmware.home.to_geo(nav.north, nav.east)
    return round(lat * 1e7), round(lon * 1e7), nav.up


def heartbeat(firmware: Firmware) -> Message:
    base = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
    if firmware.flight.armed:
        base |= mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    state = mavlink.MAV_STATE_ACTIVE if firmware.flight.armed else mavlink.MAV_STATE_STANDBY
    if firmware.critical:
        state = mavlink.MAV_STATE_CRITICAL
    return mavlink.MAVLink_heartbeat_message(
        mavlink.MAV_TYPE_QUADROTOR, firmware.mav_autopilot, base, firmware.custom_mode, state, 3
    )


def current_mode(firmware: Firmware) -> Message:
    return mavlink.MAVLink_current_mode_message(0, firmware.custom_mode, firmware.custom_mode)


def sys_status(firmware: Firmware) -> Message:
    prearm = mavlink.MAV_SYS_STATUS_PREARM_CHECK
    present = _SENSORS | prearm if firmware.prearm_has_present_bit else _SENSORS
    health = _SENSORS | prearm if firmware.prearm_ok else _SENSORS
    if firmware.navigation.without_fix_for > SYS_STATUS_LATE:
        health &= ~mavlink.MAV_SYS_STATUS_SENSOR_GPS
    percent = firmware.copter.battery_percent
    volts = 13.2 + 3.6 * percent / 100.0
    amps = firmware.copter.power / volts
    return mavlink.MAVLink_sys_status_message(
        present, present, health, 300, int(volts * 1000), int(amps * 100), round(percent), 0, 0, 0, 0, 0, 0
    )


def battery_status(firmware: Firmware) -> Message:
    percent = firmware.copter.battery_percent
    volts = 13.2 + 3.6 * percent / 100.0
    amps = firmware.copter.power / volts
    used = firmware.copter.airframe.capacity - firmware.copter.energy
    cells = [int(volts * 250)] * 4 + [65535] * 6
    return mavlink.MAVLink_battery_status_message(
        0, 0, 3, 2500, cells, int(amps * 100), int(used / 14.8 * 1000), int(used * 36), round(percent)
    )


def gps_raw_int(firmware: Firmware) -> Message:
    lat, lon, up = _estimate(firmware)
    copter = firmware.copter
    speed = math.hypot(copter.v_north, copter.v_east)
    course = math.degrees(math.atan2(copter.v_east, copter.v_north)) % 360.0
    return mavlink.MAVLink_gps_raw_int_message(
        int(firmware.time * 1e6),
        mavlink.GPS_FIX_TYPE_3D_FIX if firmware.navigation.has_fix else mavlink.GPS_FIX_TYPE_NO_FIX,
        lat,
        lon,
        int((firmware.home.amsl_m + up) * 1000),
        80,
        120,
        int(speed * 100),
        int(course * 100) % 36000,
        firmware.navigation.satellites,
    )


def global_position_int(firmware: Firmware) -> Message:
    lat, lon, up = _estimate(firmware)
    copter = firmware.copter
    return mavlink.MAVLink_global_position_int_message(
        _boot_ms(firmware),
        lat,
        lon,
        round((firmware.home.amsl_m + up) * 1000),
        round((up + firmware.faults.home_m) * 1000),
        round(copter.v_north * 100),
        round(copter.v_east * 100),
        round(-copter.v_up * 100),
        int(firmware.navigation.heading_deg() * 100) % 36000,
    )


def attitude(firmware: Firmware) -> Message:
    yaw = math.remainder(math.radians(firmware.navigation.heading_deg()), 2.0 * math.pi)
    copter = firmware.copter
    heading = math.radians(copter.heading)
    forward = copter.push_north * math.cos(heading) + copter.push_east * math.sin(heading)
    right = copter.push_east * math.cos(heading) - copter.push_north * math.sin(heading)
    pitch = -math.atan(forward / GRAVITY)
    roll = math.atan(right * math.cos(pitch) / GRAVITY)
    return mavlink.MAVLink_attitude_message(
        _boot_ms(firmware), roll, pitch, yaw, 0.0, 0.0, math.radians(firmware.copter.yaw_rate)
    )


def vfr_hud(firmware: Firmware) -> Message:
    copter, nav = firmware.copter, firmware.navigation
    speed = math.hypot(copter.v_north, copter.v_east)
    throttle = 50 if firmware.flight.armed else 0
    amsl = firmware.home.amsl_m + nav.up
    return mavlink.MAVLink_vfr_hud_message(speed, speed, int(nav.heading_deg()), throttle, amsl, copter.v_up)


def home_position(firmware: Firmware) -> Message:
    home = firmware.home
    return mavlink.MAVLink_home_position_message(
        round(home.lat_deg * 1e7), round(home.lon_deg * 1e7), round(home.amsl_m * 1000),
        0.0, 0.0, 0.0, [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0, int(firmware.time * 1e6),
    )  # fmt: skip


def extended_sys_state(firmware: Firmware) -> Message:
    flight = firmware.flight
    if not flight.in_air:
        landed = mavlink.MAV_LANDED_STATE_ON_GROUND
    elif flight.task == "land":
        landed = mavlink.MAV_LANDED_STATE_LANDING
    elif flight.task == "take_off" and flight.navigation.up < flight.demand.up - 0.5:
        landed = mavlink.MAV_LANDED_STATE_TAKEOFF
    else:
        landed = mavlink.MAV_LANDED_STATE_IN_AIR
    return mavlink.MAVLink_extended_sys_state_message(mavlink.MAV_VTOL_STATE_UNDEFINED, landed)


def system_time(firmware: Firmware) -> Message:
    return mavlink.MAVLink_system_time_message(0, _boot_ms(firmware))


def autopilot_version(firmware: Firmware) -> Message:
    encoding = (
        mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE
        if firmware.parameters.bytewise
        else mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST
    )
    capabilities = encoding | _CAPABILITIES
    version = 0x011000FF if firmware.name == "px4" else 0x040700FF
    return mavlink.MAVLink_autopilot_version_message(
        capabilities, version, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, firmware.conditions.seed, [0] * 18
    )


def _estimator_flags(firmware: Firmware) -> int:
    """ESTIMATOR_STATUS_FLAGS, and EKF_STATUS_FLAGS alike: attitude and velocity; all of position besides."""
    return 0x33F if firmware.prearm_ok and firmware.navigation.without_fix_for < ESTIMATOR_LATE else 0x007


def estimator_status(firmware: Firmware) -> Message:
    flags = _estimator_flags(firmware)
    at_us = int(firmware.time * 1e6)
    return mavlink.MAVLink_estimator_status_message(at_us, flags, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.8, 1.2)


def ekf_status_report(firmware: Firmware) -> Any:
    """ArduPilot's word on its position estimate; MAVSDK asks for it as part of "health"."""
    from pymavlink.dialects.v20 import ardupilotmega  # a fifth of a PX4's start, which never says it

    good = _estimator_flags(firmware)
    return ardupilotmega.MAVLink_ekf_status_report_message(good, 0.1, 0.1, 0.1, 0.1, 0.0)


def rc_channels(firmware: Firmware) -> Message:
    """Eight channels of a transmitter; the fifth is its mode switch."""
    channels = (1500, 1500, 1000, 1500, firmware.mode_switch_us, 1500, 1500, 1500)
    return mavlink.MAVLink_rc_channels_message(_boot_ms(firmware), 8, *channels, *_UNUSED_CHANNELS, 200)


_COMMON: dict[int, Callable[[Firmware], Any]] = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: heartbeat,
    mavlink.MAVLINK_MSG_ID_SYS_STATUS: sys_status,
    mavlink.MAVLINK_MSG_ID_BATTERY_STATUS: battery_status,
    mavlink.MAVLINK_MSG_ID_GPS_RAW_INT: gps_raw_int,
    mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: global_position_int,
    mavlink.MAVLINK_MSG_ID_ATTITUDE: attitude,
    mavlink.MAVLINK_MSG_ID_VFR_HUD: vfr_hud,
    mavlink.MAVLINK_MSG_ID_HOME_POSITION: home_position,
    mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: extended_sys_state,
    mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: system_time,
    mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION: autopilot_version,
}


def builders(flavour: str) -> dict[int, Callable[[Firmware], Any]]:
    """Message id -> builder: what this flavour can send when asked."""
    if flavour == "ardupilot":
        return _COMMON | {
            EKF_STATUS_REPORT_ID: ekf_status_report,
            mavlink.MAVLINK_MSG_ID_RC_CHANNELS: rc_channels,
        }
    return _COMMON | {
        mavlink.MAVLINK_MSG_ID_ESTIMATOR_STATUS: estimator_status,
        mavlink.MAVLINK_MSG_ID_CURRENT_MODE: current_mode,
    }
