"""What Crossfix and its tests use of pymavlink's dialect development, whose 26,000 lines take pyright seconds."""

from collections.abc import Sequence
from typing import Any

GPS_FIX_TYPE_3D_FIX: int
GPS_FIX_TYPE_NO_FIX: int
MAVLINK_MSG_ID_ATTITUDE: int
MAVLINK_MSG_ID_AUTOPILOT_VERSION: int
MAVLINK_MSG_ID_BATTERY_STATUS: int
MAVLINK_MSG_ID_CURRENT_MODE: int
MAVLINK_MSG_ID_ESTIMATOR_STATUS: int
MAVLINK_MSG_ID_EXTENDED_SYS_STATE: int
MAVLINK_MSG_ID_GLOBAL_POSITION_INT: int
MAVLINK_MSG_ID_GPS_RAW_INT: int
MAVLINK_MSG_ID_HEARTBEAT: int
MAVLINK_MSG_ID_HOME_POSITION: int
MAVLINK_MSG_ID_RC_CHANNELS: int
MAVLINK_MSG_ID_SYSTEM_TIME: int
MAVLINK_MSG_ID_SYS_STATUS: int
MAVLINK_MSG_ID_VFR_HUD: int
MAV_AUTOPILOT_ARDUPILOTMEGA: int
MAV_AUTOPILOT_INVALID: int
MAV_AUTOPILOT_PX4: int
MAV_CMD_COMPONENT_ARM_DISARM: int
MAV_CMD_CONDITION_YAW: int
MAV_CMD_DO_CHANGE_SPEED: int
MAV_CMD_DO_REPOSITION: int
MAV_CMD_DO_SET_MODE: int
MAV_CMD_GET_HOME_POSITION: int
MAV_CMD_NAV_LAND: int
MAV_CMD_NAV_RETURN_TO_LAUNCH: int
MAV_CMD_NAV_TAKEOFF: int
MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: int
MAV_CMD_REQUEST_MESSAGE: int
MAV_CMD_SET_MESSAGE_INTERVAL: int
MAV_COMP_ID_AUTOPILOT1: int
MAV_DATA_STREAM_EXTENDED_STATUS: int
MAV_DATA_STREAM_EXTRA1: int
MAV_DATA_STREAM_EXTRA2: int
MAV_DATA_STREAM_EXTRA3: int
MAV_DATA_STREAM_POSITION: int
MAV_FRAME_GLOBAL: int
MAV_FRAME_GLOBAL_RELATIVE_ALT: int
MAV_FRAME_GLOBAL_RELATIVE_ALT_INT: int
MAV_LANDED_STATE_IN_AIR: int
MAV_LANDED_STATE_LANDING: int
MAV_LANDED_STATE_ON_GROUND: int
MAV_LANDED_STATE_TAKEOFF: int
MAV_MISSION_TYPE_FENCE: int
MAV_MODE_FLAG_CUSTOM_MODE_ENABLED: int
MAV_MODE_FLAG_SAFETY_ARMED: int
MAV_ODID_ARM_STATUS_GOOD_TO_ARM: int
MAV_ODID_ARM_STATUS_PRE_ARM_FAIL_GENERIC: int
MAV_PROTOCOL_CAPABILITY_COMMAND_INT: int
MAV_PROTOCOL_CAPABILITY_MAVLINK2: int
MAV_PROTOCOL_CAPABILITY_MISSION_FENCE: int
MAV_PROTOCOL_CAPABILITY_MISSION_INT: int
MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE: int
MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST: int
MAV_RESULT_ACCEPTED: int
MAV_RESULT_DENIED: int
MAV_RESULT_UNSUPPORTED: int
MAV_SEVERITY_CRITICAL: int
MAV_SEVERITY_EMERGENCY: int
MAV_SEVERITY_INFO: int
MAV_SEVERITY_NOTICE: int
MAV_SEVERITY_WARNING: int
MAV_STATE_ACTIVE: int
MAV_STATE_CRITICAL: int
MAV_STATE_STANDBY: int
MAV_SYS_STATUS_AHRS: int
MAV_SYS_STATUS_PREARM_CHECK: int
MAV_SYS_STATUS_SENSOR_3D_ACCEL: int
MAV_SYS_STATUS_SENSOR_3D_GYRO: int
MAV_SYS_STATUS_SENSOR_3D_MAG: int
MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE: int
MAV_SYS_STATUS_SENSOR_BATTERY: int
MAV_SYS_STATUS_SENSOR_GPS: int
MAV_TYPE_GCS: int
MAV_TYPE_QUADROTOR: int
MAV_VTOL_STATE_UNDEFINED: int

class MAVLink_message:
    id: int
    msgname: str
    def __init__(self, msgId: int, name: str) -> None: ...
    def _pack(self, mav: MAVLink, crc_extra: int, payload: bytes, force_mavlink1: bool = False) -> bytes: ...
    def get_msgbuf(self) -> bytearray: ...
    def get_type(self) -> str: ...
    def get_msgId(self) -> int: ...
    def get_srcSystem(self) -> int: ...
    def get_srcComponent(self) -> int: ...
    def to_dict(self) -> dict[str, str | float | int]: ...
    def pack(self, mav: MAVLink, force_mavlink1: bool = False) -> bytes: ...

class MAVLink_attitude_message(MAVLink_message):
    def __init__(
        self,
        time_boot_ms: int,
        roll: float,
        pitch: float,
        yaw: float,
        rollspeed: float,
        pitchspeed: float,
        yawspeed: float,
    ) -> None: ...

class MAVLink_autopilot_version_message(MAVLink_message):
    def __init__(
        self,
        capabilities: int,
        flight_sw_version: int,
        middleware_sw_version: int,
        os_sw_version: int,
        board_version: int,
        flight_custom_version: Sequence[int],
        middleware_custom_version: Sequence[int],
        os_custom_version: Sequence[int],
        vendor_id: int,
        product_id: int,
        uid: int,
        uid2: Sequence[int] = ...,
    ) -> None: ...

class MAVLink_battery_status_message(MAVLink_message):
    def __init__(
        self,
        id: int,
        battery_function: int,
        type: int,
        temperature: int,
        voltages: Sequence[int],
        current_battery: int,
        current_consumed: int,
        energy_consumed: int,
        battery_remaining: int,
    ) -> None: ...

class MAVLink_command_ack_message(MAVLink_message):
    def __init__(
        self,
        command: int,
        result: int,
        progress: int = 0,
        result_param2: int = 0,
        target_system: int = 0,
        target_component: int = 0,
    ) -> None: ...

class MAVLink_command_int_message(MAVLink_message):
    def __init__(
        self,
        target_system: int,
        target_component: int,
        frame: int,
        command: int,
        current: int,
        autocontinue: int,
        param1: float,
        param2: float,
        param3: float,
        param4: float,
        x: int,
        y: int,
        z: float,
    ) -> None: ...

class MAVLink_command_long_message(MAVLink_message):
    def __init__(
        self,
        target_system: int,
        target_component: int,
        command: int,
        confirmation: int,
        param1: float,
        param2: float,
        param3: float,
        param4: float,
        param5: float,
        param6: float,
        param7: float,
    ) -> None: ...

class MAVLink_current_mode_message(MAVLink_message):
    def __init__(self, standard_mode: int, custom_mode: int, intended_custom_mode: int) -> None: ...

class MAVLink_estimator_status_message(MAVLink_message):
    def __init__(
        self,
        time_usec: int,
        flags: int,
        vel_ratio: float,
        pos_horiz_ratio: float,
        pos_vert_ratio: float,
        mag_ratio: float,
        hagl_ratio: float,
        tas_ratio: float,
        pos_horiz_accuracy: float,
        pos_vert_accuracy: float,
    ) -> None: ...

class MAVLink_extended_sys_state_message(MAVLink_message):
    def __init__(self, vtol_state: int, landed_state: int) -> None: ...

class MAVLink_global_position_int_message(MAVLink_message):
    def __init__(
        self, time_boot_ms: int, lat: int, lon: int, alt: int, relative_alt: int, vx: int, vy: int, vz: int, hdg: int
    ) -> None: ...

class MAVLink_gps_raw_int_message(MAVLink_message):
    def __init__(
        self,
        time_usec: int,
        fix_type: int,
        lat: int,
        lon: int,
        alt: int,
        eph: int,
        epv: int,
        vel: int,
        cog: int,
        satellites_visible: int,
    ) -> None: ...

class MAVLink_heartbeat_message(MAVLink_message):
    def __init__(
        self, type: int, autopilot: int, base_mode: int, custom_mode: int, system_status: int, mavlink_version: int
    ) -> None: ...

class MAVLink_home_position_message(MAVLink_message):
    def __init__(
        self,
        latitude: int,
        longitude: int,
        altitude: int,
        x: float,
        y: float,
        z: float,
        q: Sequence[float],
        approach_x: float,
        approach_y: float,
        approach_z: float,
        time_usec: int = 0,
    ) -> None: ...

class MAVLink_manual_control_message(MAVLink_message):
    def __init__(self, target: int, x: int, y: int, z: int, r: int, buttons: int) -> None: ...

class MAVLink_mission_ack_message(MAVLink_message):
    def __init__(self, target_system: int, target_component: int, type: int, mission_type: int = 0) -> None: ...

class MAVLink_mission_count_message(MAVLink_message):
    def __init__(self, target_system: int, target_component: int, count: int, mission_type: int = 0) -> None: ...

class MAVLink_mission_item_int_message(MAVLink_message):
    def __init__(
        self,
        target_system: int,
        target_component: int,
        seq: int,
        frame: int,
        command: int,
        current: int,
        autocontinue: int,
        param1: float,
        param2: float,
        param3: float,
        param4: float,
        x: int,
        y: int,
        z: float,
        mission_type: int = 0,
    ) -> None: ...

class MAVLink_mission_request_int_message(MAVLink_message):
    def __init__(self, target_system: int, target_component: int, seq: int, mission_type: int = 0) -> None: ...

class MAVLink_open_drone_id_arm_status_message(MAVLink_message):
    def __init__(self, status: int, error: bytes) -> None: ...

class MAVLink_param_request_list_message(MAVLink_message):
    def __init__(self, target_system: int, target_component: int) -> None: ...

class MAVLink_param_request_read_message(MAVLink_message):
    def __init__(self, target_system: int, target_component: int, param_id: bytes, param_index: int) -> None: ...

class MAVLink_param_set_message(MAVLink_message):
    def __init__(
        self, target_system: int, target_component: int, param_id: bytes, param_value: float, param_type: int
    ) -> None: ...

class MAVLink_param_value_message(MAVLink_message):
    def __init__(
        self, param_id: bytes, param_value: float, param_type: int, param_count: int, param_index: int
    ) -> None: ...

class MAVLink_ping_message(MAVLink_message):
    def __init__(self, time_usec: int, seq: int, target_system: int, target_component: int) -> None: ...

class MAVLink_rc_channels_message(MAVLink_message):
    def __init__(
        self,
        time_boot_ms: int,
        chancount: int,
        chan1_raw: int,
        chan2_raw: int,
        chan3_raw: int,
        chan4_raw: int,
        chan5_raw: int,
        chan6_raw: int,
        chan7_raw: int,
        chan8_raw: int,
        chan9_raw: int,
        chan10_raw: int,
        chan11_raw: int,
        chan12_raw: int,
        chan13_raw: int,
        chan14_raw: int,
        chan15_raw: int,
        chan16_raw: int,
        chan17_raw: int,
        chan18_raw: int,
        rssi: int,
    ) -> None: ...

class MAVLink_request_data_stream_message(MAVLink_message):
    def __init__(
        self, target_system: int, target_component: int, req_stream_id: int, req_message_rate: int, start_stop: int
    ) -> None: ...

class MAVLink_statustext_message(MAVLink_message):
    text: str
    def __init__(self, severity: int, text: bytes, id: int = 0, chunk_seq: int = 0) -> None: ...

class MAVLink_sys_status_message(MAVLink_message):
    def __init__(
        self,
        onboard_control_sensors_present: int,
        onboard_control_sensors_enabled: int,
        onboard_control_sensors_health: int,
        load: int,
        voltage_battery: int,
        current_battery: int,
        battery_remaining: int,
        drop_rate_comm: int,
        errors_comm: int,
        errors_count1: int,
        errors_count2: int,
        errors_count3: int,
        errors_count4: int,
    ) -> None: ...

class MAVLink_system_time_message(MAVLink_message):
    def __init__(self, time_unix_usec: int, time_boot_ms: int) -> None: ...

class MAVLink_timesync_message(MAVLink_message):
    def __init__(self, tc1: int, ts1: int) -> None: ...

class MAVLink_vfr_hud_message(MAVLink_message):
    def __init__(
        self, airspeed: float, groundspeed: float, heading: int, throttle: int, alt: float, climb: float
    ) -> None: ...

class MAVLink:
    def __init__(self, file: Any, srcSystem: int = 0, srcComponent: int = 0, use_native: bool = False) -> None: ...
    robust_parsing: bool
    def parse_char(self, c: Sequence[int]) -> MAVLink_message | None: ...
    def parse_buffer(self, s: Sequence[int]) -> list[MAVLink_message] | None: ...
    def decode(self, msgbuf: bytearray) -> MAVLink_message: ...
    def heartbeat_encode(
        self, type: int, autopilot: int, base_mode: int, custom_mode: int, system_status: int, mavlink_version: int = 3
    ) -> MAVLink_heartbeat_message: ...
    def command_long_encode(
        self,
        target_system: int,
        target_component: int,
        command: int,
        confirmation: int,
        param1: float,
        param2: float,
        param3: float,
        param4: float,
        param5: float,
        param6: float,
        param7: float,
    ) -> MAVLink_command_long_message: ...
    def manual_control_encode(
        self, target: int, x: int, y: int, z: int, r: int, buttons: int
    ) -> MAVLink_manual_control_message: ...

mavlink_map: dict[int, type[MAVLink_message]]
