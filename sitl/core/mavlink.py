# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of MAVLink that more than one file knows, by their names there (https://mavlink.io/en/messages/common.html).

A member has MAVLink's name without what all of its group begin with: ``MavResult.DENIED`` is MAV_RESULT_DENIED. The
numbers are no part of the bridge: ArduPilot goes by them, too, an item of a mission by MAV_CMD and MAV_FRAME.
"""

from __future__ import annotations

from enum import IntEnum

ARM_FORCED = 21196
"""Second parameter of COMPONENT_ARM_DISARM: arming without checks, disarming in the air."""


class MavSeverity(IntEnum):
    """Of a STATUSTEXT."""

    EMERGENCY = 0
    ALERT = 1
    CRITICAL = 2
    ERROR = 3
    WARNING = 4
    NOTICE = 5
    INFO = 6
    DEBUG = 7


class MavResult(IntEnum):
    """Of a command."""

    ACCEPTED = 0
    TEMPORARILY_REJECTED = 1
    DENIED = 2
    UNSUPPORTED = 3
    FAILED = 4
    IN_PROGRESS = 5


class MavMissionResult(IntEnum):
    """Of an item, and of a list of items."""

    ACCEPTED = 0
    ERROR = 1
    UNSUPPORTED_FRAME = 2
    UNSUPPORTED = 3
    NO_SPACE = 4
    INVALID = 5
    INVALID_PARAM1 = 6
    INVALID_PARAM2 = 7
    INVALID_PARAM3 = 8
    INVALID_PARAM4 = 9
    INVALID_PARAM5_X = 10
    INVALID_PARAM6_Y = 11
    INVALID_PARAM7 = 12
    INVALID_SEQUENCE = 13
    DENIED = 14
    OPERATION_CANCELLED = 15


class MavMissionType(IntEnum):
    """Which list of items."""

    MISSION = 0
    FENCE = 1
    RALLY = 2
    ALL = 255


class MavType(IntEnum):
    """Of a vehicle."""

    GENERIC = 0
    FIXED_WING = 1
    QUADROTOR = 2
    GCS = 6
    GROUND_ROVER = 10
    SURFACE_BOAT = 11
    HEXAROTOR = 13
    OCTOROTOR = 14
    TRICOPTER = 15
    DODECAROTOR = 29
    DECAROTOR = 35


class MavAutopilot(IntEnum):
    """Whose firmware; INVALID: of what is no vehicle."""

    GENERIC = 0
    ARDUPILOTMEGA = 3
    INVALID = 8
    PX4 = 12


class MavModeFlag(IntEnum):
    """Bits of ``base_mode``."""

    CUSTOM_MODE_ENABLED = 1
    GUIDED_ENABLED = 8
    STABILIZE_ENABLED = 16
    MANUAL_INPUT_ENABLED = 64
    SAFETY_ARMED = 128


class MavSysStatus(IntEnum):
    """Bits of SYS_STATUS: sensors and what else is present, enabled, healthy (MAV_SYS_STATUS_SENSOR)."""

    SENSOR_3D_GYRO = 0x1
    SENSOR_3D_ACCEL = 0x2
    SENSOR_3D_MAG = 0x4
    SENSOR_ABSOLUTE_PRESSURE = 0x8
    SENSOR_DIFFERENTIAL_PRESSURE = 0x10
    SENSOR_GPS = 0x20
    SENSOR_OPTICAL_FLOW = 0x40
    SENSOR_VISION_POSITION = 0x80
    SENSOR_ANGULAR_RATE_CONTROL = 0x400
    SENSOR_ATTITUDE_STABILIZATION = 0x800
    SENSOR_YAW_POSITION = 0x1000
    SENSOR_Z_ALTITUDE_CONTROL = 0x2000
    SENSOR_XY_POSITION_CONTROL = 0x4000
    SENSOR_MOTOR_OUTPUTS = 0x8000
    SENSOR_RC_RECEIVER = 0x10000
    GEOFENCE = 0x100000
    AHRS = 0x200000
    TERRAIN = 0x400000
    LOGGING = 0x1000000
    SENSOR_BATTERY = 0x2000000
    SENSOR_PROXIMITY = 0x4000000
    PREARM_CHECK = 0x10000000
    SENSOR_PROPULSION = 0x40000000


class MavState(IntEnum):
    """``system_status`` of a HEARTBEAT."""

    CALIBRATING = 2
    STANDBY = 3
    ACTIVE = 4
    CRITICAL = 5


class MavLandedState(IntEnum):
    """Of EXTENDED_SYS_STATE."""

    UNDEFINED = 0
    ON_GROUND = 1
    IN_AIR = 2
    TAKEOFF = 3
    LANDING = 4


class MavFrame(IntEnum):
    """What coordinates count from, and along which axes."""

    GLOBAL = 0
    LOCAL_NED = 1
    MISSION = 2
    GLOBAL_RELATIVE_ALT = 3
    GLOBAL_INT = 5
    GLOBAL_RELATIVE_ALT_INT = 6
    LOCAL_OFFSET_NED = 7
    BODY_NED = 8
    BODY_OFFSET_NED = 9
    GLOBAL_TERRAIN_ALT = 10
    GLOBAL_TERRAIN_ALT_INT = 11
    BODY_FRD = 12
    LOCAL_FRD = 20


class MavParamType(IntEnum):
    """Of a value of a parameter."""

    INT32 = 6
    REAL32 = 9


class GpsFixType(IntEnum):
    """Of a GPS receiver."""

    NO_FIX = 1
    FIX_3D = 3
    RTK_FIXED = 6


class MotorTestThrottleType(IntEnum):
    """What the throttle of a motor test means."""

    PERCENT = 0
    PWM = 1
    PILOT = 2


class MavCmd(IntEnum):
    """Of a command, and of an item of a mission."""

    NAV_WAYPOINT = 16
    NAV_LOITER_UNLIM = 17
    NAV_LOITER_TURNS = 18
    NAV_LOITER_TIME = 19
    NAV_RETURN_TO_LAUNCH = 20
    NAV_LAND = 21
    NAV_TAKEOFF = 22
    NAV_CONTINUE_AND_CHANGE_ALT = 30
    NAV_LOITER_TO_ALT = 31
    NAV_ARC_WAYPOINT = 36
    NAV_SPLINE_WAYPOINT = 82
    NAV_ALTITUDE_WAIT = 83
    NAV_VTOL_TAKEOFF = 84
    NAV_VTOL_LAND = 85
    NAV_GUIDED_ENABLE = 92
    NAV_DELAY = 93
    NAV_PAYLOAD_PLACE = 94
    NAV_LAST = 95
    CONDITION_DELAY = 112
    CONDITION_DISTANCE = 114
    CONDITION_YAW = 115
    DO_SET_MODE = 176
    DO_JUMP = 177
    DO_CHANGE_SPEED = 178
    DO_SET_HOME = 179
    DO_SET_RELAY = 181
    DO_REPEAT_RELAY = 182
    DO_SET_SERVO = 183
    DO_REPEAT_SERVO = 184
    DO_RETURN_PATH_START = 188
    DO_LAND_START = 189
    DO_GO_AROUND = 191
    DO_REPOSITION = 192
    DO_PAUSE_CONTINUE = 193
    DO_SET_REVERSE = 194
    DO_SET_ROI_LOCATION = 195
    DO_SET_ROI_NONE = 197
    DO_SET_ROI = 201
    DO_DIGICAM_CONFIGURE = 202
    DO_DIGICAM_CONTROL = 203
    DO_MOUNT_CONTROL = 205
    DO_SET_CAM_TRIGG_DIST = 206
    DO_FENCE_ENABLE = 207
    DO_PARACHUTE = 208
    DO_MOTOR_TEST = 209
    DO_INVERTED_FLIGHT = 210
    DO_GRIPPER = 211
    DO_AUTOTUNE_ENABLE = 212
    NAV_SET_YAW_SPEED = 213
    DO_SET_RESUME_REPEAT_DIST = 215
    DO_SPRAYER = 216
    DO_SEND_SCRIPT_MESSAGE = 217
    DO_AUX_FUNCTION = 218
    DO_GUIDED_LIMITS = 222
    DO_ENGINE_CONTROL = 223
    PREFLIGHT_REBOOT_SHUTDOWN = 246
    MISSION_START = 300
    COMPONENT_ARM_DISARM = 400
    SET_MESSAGE_INTERVAL = 511
    REQUEST_MESSAGE = 512
    SET_CAMERA_ZOOM = 531
    SET_CAMERA_FOCUS = 532
    SET_CAMERA_SOURCE = 534
    JUMP_TAG = 600
    DO_JUMP_TAG = 601
    DO_GIMBAL_MANAGER_PITCHYAW = 1000
    IMAGE_START_CAPTURE = 2000
    IMAGE_STOP_CAPTURE = 2001
    VIDEO_START_CAPTURE = 2500
    VIDEO_STOP_CAPTURE = 2501
    DO_VTOL_TRANSITION = 3000
    NAV_FENCE_RETURN_POINT = 5000
    NAV_FENCE_POLYGON_VERTEX_INCLUSION = 5001
    NAV_FENCE_POLYGON_VERTEX_EXCLUSION = 5002
    NAV_FENCE_CIRCLE_INCLUSION = 5003
    NAV_FENCE_CIRCLE_EXCLUSION = 5004
    NAV_RALLY_POINT = 5100
    USER_1 = 31010
    USER_2 = 31011
    DO_WINCH = 42600
    NAV_SCRIPT_TIME = 42702
    NAV_ATTITUDE_TIME = 42703
