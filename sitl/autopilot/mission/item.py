# SPDX-License-Identifier: BSD-3-Clause
"""One mission item, as MISSION_ITEM_INT carries it, and what is known of each command.

https://mavlink.io/en/messages/common.html#MISSION_ITEM_INT,
https://ardupilot.org/copter/docs/mission-command-list.html
"""

from __future__ import annotations

from typing import NamedTuple

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
NAV_GUIDED_ENABLE = 92
NAV_DELAY = 93
NAV_PAYLOAD_PLACE = 94
CONDITION_DELAY = 112
CONDITION_DISTANCE = 114
CONDITION_YAW = 115
DO_JUMP = 177
DO_CHANGE_SPEED = 178
DO_SET_HOME = 179
DO_GO_AROUND = 191
DO_PAUSE_CONTINUE = 193
DO_SET_REVERSE = 194
DO_SET_ROI_LOCATION = 195
DO_SET_ROI_NONE = 197
DO_SET_ROI = 201
DO_FENCE_ENABLE = 207
NAV_SET_YAW_SPEED = 213
DO_AUTOTUNE_ENABLE = 212
DO_SET_RESUME_REPEAT_DIST = 215
DO_SEND_SCRIPT_MESSAGE = 217
DO_GUIDED_LIMITS = 222
DO_ENGINE_CONTROL = 223
SET_CAMERA_ZOOM, SET_CAMERA_FOCUS, SET_CAMERA_SOURCE = 531, 532, 534
DO_VTOL_TRANSITION = 3000
NAV_SCRIPT_TIME, NAV_ATTITUDE_TIME = 42702, 42703
DO_SET_RELAY, DO_REPEAT_RELAY, DO_SET_SERVO, DO_REPEAT_SERVO = 181, 182, 183, 184
DO_RETURN_PATH_START = 188
DO_LAND_START = 189
NAV_VTOL_TAKEOFF = 84
NAV_VTOL_LAND = 85
DO_PARACHUTE = 208
DO_INVERTED_FLIGHT = 210
DO_GRIPPER = 211
DO_SPRAYER = 216
DO_AUX_FUNCTION = 218
JUMP_TAG = 600
DO_JUMP_TAG = 601
DO_WINCH = 42600
DO_DIGICAM_CONFIGURE = 202
DO_DIGICAM_CONTROL = 203
DO_MOUNT_CONTROL = 205
DO_SET_CAM_TRIGG_DIST = 206
DO_GIMBAL_MANAGER_PITCHYAW = 1000
IMAGE_START_CAPTURE = 2000
IMAGE_STOP_CAPTURE = 2001
VIDEO_START_CAPTURE = 2500
VIDEO_STOP_CAPTURE = 2501
FENCE_COMMANDS = FENCE_RETURN_POINT, FENCE_INCLUSION, FENCE_EXCLUSION, FENCE_CIRCLE, FENCE_CIRCLE_OUT = range(
    5000, 5005
)
RALLY_POINT = 5100

GLOBAL, MISSION, RELATIVE, GLOBAL_INT, RELATIVE_INT, TERRAIN, TERRAIN_INT = 0, 2, 3, 5, 6, 10, 11
"""MAV_FRAMEs; MISSION counts as GLOBAL for a command with a place."""


class Command(NamedTuple):
    """What a command is."""

    name: str
    """As ArduPilot's "Mission: 1 Takeoff" texts say it."""
    is_nav: bool
    has_place: bool
    """x, y, z are latitude, longitude [degE7] and altitude [m]."""


COMMANDS = {
    NAV_WAYPOINT: Command("WP", True, True),
    NAV_LOITER_UNLIM: Command("LoitUnlim", True, True),
    NAV_LOITER_TURNS: Command("LoitTurns", True, True),
    NAV_LOITER_TIME: Command("LoitTime", True, True),
    NAV_RETURN_TO_LAUNCH: Command("RTL", True, False),
    NAV_LAND: Command("Land", True, True),
    NAV_TAKEOFF: Command("Takeoff", True, True),
    NAV_CONTINUE_AND_CHANGE_ALT: Command("ContinueAndChangeAlt", True, True),
    NAV_LOITER_TO_ALT: Command("LoitAltitude", True, True),
    NAV_ARC_WAYPOINT: Command("ArcWP", True, True),
    NAV_SPLINE_WAYPOINT: Command("SplineWP", True, True),
    NAV_ALTITUDE_WAIT: Command("AltitudeWait", True, False),
    NAV_GUIDED_ENABLE: Command("GuidedEnable", True, True),
    NAV_DELAY: Command("Delay", True, False),
    NAV_PAYLOAD_PLACE: Command("PayloadPlace", True, True),
    NAV_SET_YAW_SPEED: Command("SetYawSpd", True, False),
    CONDITION_DELAY: Command("CondDelay", False, False),
    CONDITION_DISTANCE: Command("CondDist", False, False),
    CONDITION_YAW: Command("CondYaw", False, False),
    DO_JUMP: Command("Jump", False, False),
    DO_CHANGE_SPEED: Command("ChangeSpeed", False, False),
    DO_SET_HOME: Command("SetHome", False, True),
    DO_GO_AROUND: Command("Go Around", False, True),
    DO_PAUSE_CONTINUE: Command("PauseContinue", False, False),
    DO_SET_REVERSE: Command("SetReverse", False, False),
    DO_SET_ROI_LOCATION: Command("SetROILocation", False, True),
    DO_SET_ROI_NONE: Command("SetROINone", False, False),
    DO_SET_ROI: Command("SetROI", False, True),
    DO_FENCE_ENABLE: Command("FenceEnable", False, False),
    DO_AUTOTUNE_ENABLE: Command("AutoTuneEnable", False, False),
    DO_SET_RESUME_REPEAT_DIST: Command("SetRepeatDist", False, False),
    DO_SEND_SCRIPT_MESSAGE: Command("Scripting", False, False),
    DO_ENGINE_CONTROL: Command("EngineControl", False, False),
    DO_INVERTED_FLIGHT: Command("InvertedFlight", False, False),
    DO_VTOL_TRANSITION: Command("VTOLTransition", False, False),
    SET_CAMERA_ZOOM: Command("SetCameraZoom", False, False),
    SET_CAMERA_FOCUS: Command("SetCameraFocus", False, False),
    SET_CAMERA_SOURCE: Command("SetCameraSource", False, False),
    NAV_SCRIPT_TIME: Command("NavScriptTime", True, False),
    NAV_ATTITUDE_TIME: Command("NavAttitudeTime", True, False),
    DO_GUIDED_LIMITS: Command("GuidedLimits", False, False),
    DO_RETURN_PATH_START: Command("ReturnPathStart", False, True),
    DO_LAND_START: Command("LandStart", False, True),
    NAV_VTOL_TAKEOFF: Command("VTOLTakeoff", True, True),
    NAV_VTOL_LAND: Command("VTOLLand", True, True),
    DO_SET_RELAY: Command("SetRelay", False, False),
    DO_REPEAT_RELAY: Command("RepeatRelay", False, False),
    DO_SET_SERVO: Command("SetServo", False, False),
    DO_REPEAT_SERVO: Command("RepeatServo", False, False),
    DO_PARACHUTE: Command("Parachute", False, False),
    DO_GRIPPER: Command("Gripper", False, False),
    DO_SPRAYER: Command("Sprayer", False, False),
    DO_AUX_FUNCTION: Command("AuxFunction", False, False),
    JUMP_TAG: Command("Tag", False, False),
    DO_JUMP_TAG: Command("JumpToTag", False, False),
    DO_WINCH: Command("Winch", False, False),
    DO_DIGICAM_CONFIGURE: Command("DigiCamCfg", False, False),
    DO_DIGICAM_CONTROL: Command("DigiCamCtrl", False, False),
    DO_MOUNT_CONTROL: Command("MountControl", False, False),
    DO_SET_CAM_TRIGG_DIST: Command("SetCamTrigDst", False, False),
    DO_GIMBAL_MANAGER_PITCHYAW: Command("GimbalPitchYaw", False, False),
    IMAGE_START_CAPTURE: Command("ImageStartCapture", False, False),
    IMAGE_STOP_CAPTURE: Command("ImageStopCapture", False, False),
    VIDEO_START_CAPTURE: Command("VideoStartCapture", False, False),
    VIDEO_STOP_CAPTURE: Command("VideoStopCapture", False, False),
    **dict.fromkeys(FENCE_COMMANDS, Command("Fence", False, True)),
    RALLY_POINT: Command("Rally", False, True),
}
"""Every command that lists of items may hold."""

STORED = frozenset(COMMANDS) - {*FENCE_COMMANDS, RALLY_POINT}
"""Commands that missions may hold, of all firmwares; ``commands.Commands.taken`` says which of them one carries out."""

CAMERA_COMMANDS = (
    DO_DIGICAM_CONFIGURE,
    DO_DIGICAM_CONTROL,
    DO_SET_CAM_TRIGG_DIST,
    IMAGE_START_CAPTURE,
    IMAGE_STOP_CAPTURE,
)
VIDEO_COMMANDS = (VIDEO_START_CAPTURE, VIDEO_STOP_CAPTURE)
"""Taken, and without effect: no vehicle here has a video camera."""
OUTPUT_COMMANDS = (DO_SET_RELAY, DO_REPEAT_RELAY, DO_SET_SERVO, DO_REPEAT_SERVO)
MOUNT_COMMANDS = (DO_MOUNT_CONTROL, DO_GIMBAL_MANAGER_PITCHYAW)
PAYLOAD_COMMANDS = (DO_GRIPPER, DO_SPRAYER, DO_WINCH, DO_AUX_FUNCTION)
"""In missions of all firmwares."""
NUMBER_COMMANDS = (
    DO_DIGICAM_CONFIGURE,
    DO_DIGICAM_CONTROL,
    DO_GIMBAL_MANAGER_PITCHYAW,
    NAV_SCRIPT_TIME,
    NAV_ATTITUDE_TIME,
)
"""Parameters 5 and 6 are numbers of their own. Of every other command they are a place or stand where one does."""
ROI_COMMANDS = (DO_SET_ROI_LOCATION, DO_SET_ROI_NONE, DO_SET_ROI)
CARRIED_OUT = frozenset(
    (*OUTPUT_COMMANDS, *CAMERA_COMMANDS, *MOUNT_COMMANDS, *PAYLOAD_COMMANDS, *ROI_COMMANDS, DO_PARACHUTE)
)
"""By the bridge and what is fitted to the vehicle, besides what the autopilot does with them."""
UNREPORTED = frozenset(
    (
        *OUTPUT_COMMANDS,
        *CAMERA_COMMANDS,
        *VIDEO_COMMANDS,
        *(SET_CAMERA_ZOOM, SET_CAMERA_FOCUS, SET_CAMERA_SOURCE),
        *(DO_GIMBAL_MANAGER_PITCHYAW, DO_GRIPPER, DO_SPRAYER, DO_AUX_FUNCTION, DO_PARACHUTE, JUMP_TAG),
        *(DO_SEND_SCRIPT_MESSAGE, DO_SET_RESUME_REPEAT_DIST, NAV_LOITER_TO_ALT),
    )
)
"""Of which nothing is told when they are done: no MISSION_ITEM_REACHED, and no word where they are not carried out."""
MARKS = (JUMP_TAG, DO_LAND_START, DO_RETURN_PATH_START)
"""Mark a place in the mission: nothing is done there."""

RELATIVE_FRAMES = (RELATIVE, RELATIVE_INT)
TERRAIN_FRAMES = (TERRAIN, TERRAIN_INT)


class MissionItem(NamedTuple):
    """A command with its parameters."""

    command: int
    """MAV_CMD"""
    frame: int = RELATIVE
    """MAV_FRAME of x, y, z"""
    p1: float = 0.0
    p2: float = 0.0
    p3: float = 0.0
    p4: float = 0.0
    x: int = 0
    """Latitude [degE7], or parameter 5."""
    y: int = 0
    """Longitude [degE7], or parameter 6."""
    z: float = 0.0
    """Altitude in the frame [m], or parameter 7."""
    autocontinue: int = 1
    current: int = 0

    @property
    def is_nav(self) -> bool:
        """Whether it is a navigation command (one at a time), not a do-command or condition."""
        return self.command in COMMANDS and COMMANDS[self.command].is_nav

    @property
    def name(self) -> str:
        """The command's short name, "?" when unknown."""
        return COMMANDS[self.command].name if self.command in COMMANDS else "?"

    @property
    def title(self) -> str:
        """What is said when the command begins; ArduPilot puts a 0 after a tag, whatever its number is."""
        return f"{self.name} 0" if self.command == JUMP_TAG else self.name

    @property
    def no_place(self) -> bool:
        """Latitude and longitude are both zero: "where the vehicle is"."""
        return self.x == 0 and self.y == 0


def home_item(lat: int, lon: int, alt: float) -> MissionItem:
    """Item 0 of a downloaded mission: home [degE7, m above mean sea level]."""
    return MissionItem(NAV_WAYPOINT, GLOBAL, x=lat, y=lon, z=alt)
