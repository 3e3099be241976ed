# SPDX-License-Identifier: BSD-3-Clause
"""One mission item, as MISSION_ITEM_INT carries it, and what is known of each command.

https://mavlink.io/en/messages/common.html#MISSION_ITEM_INT,
https://ardupilot.org/copter/docs/mission-command-list.html
"""

from __future__ import annotations

from typing import NamedTuple

from ...core.mavlink import MavCmd, MavFrame

FENCE_COMMANDS = (
    MavCmd.NAV_FENCE_RETURN_POINT,
    MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    MavCmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
    MavCmd.NAV_FENCE_CIRCLE_INCLUSION,
    MavCmd.NAV_FENCE_CIRCLE_EXCLUSION,
)


class Command(NamedTuple):
    """What a command is."""

    name: str
    """As ArduPilot's "Mission: 1 Takeoff" texts say it."""
    is_nav: bool
    has_location: bool
    """x, y, z are latitude, longitude [degE7] and altitude [m]."""


COMMANDS: dict[int, Command] = {
    MavCmd.NAV_WAYPOINT: Command("WP", True, True),
    MavCmd.NAV_LOITER_UNLIM: Command("LoitUnlim", True, True),
    MavCmd.NAV_LOITER_TURNS: Command("LoitTurns", True, True),
    MavCmd.NAV_LOITER_TIME: Command("LoitTime", True, True),
    MavCmd.NAV_RETURN_TO_LAUNCH: Command("RTL", True, False),
    MavCmd.NAV_LAND: Command("Land", True, True),
    MavCmd.NAV_TAKEOFF: Command("Takeoff", True, True),
    MavCmd.NAV_CONTINUE_AND_CHANGE_ALT: Command("ContinueAndChangeAlt", True, True),
    MavCmd.NAV_LOITER_TO_ALT: Command("LoitAltitude", True, True),
    MavCmd.NAV_ARC_WAYPOINT: Command("ArcWP", True, True),
    MavCmd.NAV_SPLINE_WAYPOINT: Command("SplineWP", True, True),
    MavCmd.NAV_ALTITUDE_WAIT: Command("AltitudeWait", True, False),
    MavCmd.NAV_GUIDED_ENABLE: Command("GuidedEnable", True, True),
    MavCmd.NAV_DELAY: Command("Delay", True, False),
    MavCmd.NAV_PAYLOAD_PLACE: Command("PayloadPlace", True, True),
    MavCmd.NAV_SET_YAW_SPEED: Command("SetYawSpd", True, False),
    MavCmd.CONDITION_DELAY: Command("CondDelay", False, False),
    MavCmd.CONDITION_DISTANCE: Command("CondDist", False, False),
    MavCmd.CONDITION_YAW: Command("CondYaw", False, False),
    MavCmd.DO_JUMP: Command("Jump", False, False),
    MavCmd.DO_CHANGE_SPEED: Command("ChangeSpeed", False, False),
    MavCmd.DO_SET_HOME: Command("SetHome", False, True),
    MavCmd.DO_GO_AROUND: Command("Go Around", False, True),
    MavCmd.DO_PAUSE_CONTINUE: Command("PauseContinue", False, False),
    MavCmd.DO_SET_REVERSE: Command("SetReverse", False, False),
    MavCmd.DO_SET_ROI_LOCATION: Command("SetROILocation", False, True),
    MavCmd.DO_SET_ROI_NONE: Command("SetROINone", False, False),
    MavCmd.DO_SET_ROI: Command("SetROI", False, True),
    MavCmd.DO_FENCE_ENABLE: Command("FenceEnable", False, False),
    MavCmd.DO_AUTOTUNE_ENABLE: Command("AutoTuneEnable", False, False),
    MavCmd.DO_SET_RESUME_REPEAT_DIST: Command("SetRepeatDist", False, False),
    MavCmd.DO_SEND_SCRIPT_MESSAGE: Command("Scripting", False, False),
    MavCmd.DO_ENGINE_CONTROL: Command("EngineControl", False, False),
    MavCmd.DO_INVERTED_FLIGHT: Command("InvertedFlight", False, False),
    MavCmd.DO_VTOL_TRANSITION: Command("VTOLTransition", False, False),
    MavCmd.SET_CAMERA_ZOOM: Command("SetCameraZoom", False, False),
    MavCmd.SET_CAMERA_FOCUS: Command("SetCameraFocus", False, False),
    MavCmd.SET_CAMERA_SOURCE: Command("SetCameraSource", False, False),
    MavCmd.NAV_SCRIPT_TIME: Command("NavScriptTime", True, False),
    MavCmd.NAV_ATTITUDE_TIME: Command("NavAttitudeTime", True, False),
    MavCmd.DO_GUIDED_LIMITS: Command("GuidedLimits", False, False),
    MavCmd.DO_RETURN_PATH_START: Command("ReturnPathStart", False, True),
    MavCmd.DO_LAND_START: Command("LandStart", False, True),
    MavCmd.NAV_VTOL_TAKEOFF: Command("VTOLTakeoff", True, True),
    MavCmd.NAV_VTOL_LAND: Command("VTOLLand", True, True),
    MavCmd.DO_SET_RELAY: Command("SetRelay", False, False),
    MavCmd.DO_REPEAT_RELAY: Command("RepeatRelay", False, False),
    MavCmd.DO_SET_SERVO: Command("SetServo", False, False),
    MavCmd.DO_REPEAT_SERVO: Command("RepeatServo", False, False),
    MavCmd.DO_PARACHUTE: Command("Parachute", False, False),
    MavCmd.DO_GRIPPER: Command("Gripper", False, False),
    MavCmd.DO_SPRAYER: Command("Sprayer", False, False),
    MavCmd.DO_AUX_FUNCTION: Command("AuxFunction", False, False),
    MavCmd.JUMP_TAG: Command("Tag", False, False),
    MavCmd.DO_JUMP_TAG: Command("JumpToTag", False, False),
    MavCmd.DO_WINCH: Command("Winch", False, False),
    MavCmd.DO_DIGICAM_CONFIGURE: Command("DigiCamCfg", False, False),
    MavCmd.DO_DIGICAM_CONTROL: Command("DigiCamCtrl", False, False),
    MavCmd.DO_MOUNT_CONTROL: Command("MountControl", False, False),
    MavCmd.DO_SET_CAM_TRIGG_DIST: Command("SetCamTrigDst", False, False),
    MavCmd.DO_GIMBAL_MANAGER_PITCHYAW: Command("GimbalPitchYaw", False, False),
    MavCmd.IMAGE_START_CAPTURE: Command("ImageStartCapture", False, False),
    MavCmd.IMAGE_STOP_CAPTURE: Command("ImageStopCapture", False, False),
    MavCmd.VIDEO_START_CAPTURE: Command("VideoStartCapture", False, False),
    MavCmd.VIDEO_STOP_CAPTURE: Command("VideoStopCapture", False, False),
    **dict.fromkeys(FENCE_COMMANDS, Command("Fence", False, True)),
    MavCmd.NAV_RALLY_POINT: Command("Rally", False, True),
}
"""Every command that lists of items may hold."""

STORED = frozenset(COMMANDS) - {*FENCE_COMMANDS, MavCmd.NAV_RALLY_POINT}
"""Commands that missions may hold, of all firmwares; ``commands.Commands.taken`` says which of them one carries out."""

CAMERA_COMMANDS = (
    MavCmd.DO_DIGICAM_CONFIGURE,
    MavCmd.DO_DIGICAM_CONTROL,
    MavCmd.DO_SET_CAM_TRIGG_DIST,
    MavCmd.IMAGE_START_CAPTURE,
    MavCmd.IMAGE_STOP_CAPTURE,
)
VIDEO_COMMANDS = (MavCmd.VIDEO_START_CAPTURE, MavCmd.VIDEO_STOP_CAPTURE)
"""Taken, and without effect: no vehicle here has a video camera."""
OUTPUT_COMMANDS = (MavCmd.DO_SET_RELAY, MavCmd.DO_REPEAT_RELAY, MavCmd.DO_SET_SERVO, MavCmd.DO_REPEAT_SERVO)
MOUNT_COMMANDS = (MavCmd.DO_MOUNT_CONTROL, MavCmd.DO_GIMBAL_MANAGER_PITCHYAW)
PAYLOAD_COMMANDS = (MavCmd.DO_GRIPPER, MavCmd.DO_SPRAYER, MavCmd.DO_WINCH, MavCmd.DO_AUX_FUNCTION)
"""In missions of all firmwares."""
NUMBER_COMMANDS = (
    MavCmd.DO_DIGICAM_CONFIGURE,
    MavCmd.DO_DIGICAM_CONTROL,
    MavCmd.DO_GIMBAL_MANAGER_PITCHYAW,
    MavCmd.NAV_SCRIPT_TIME,
    MavCmd.NAV_ATTITUDE_TIME,
)
"""Parameters 5 and 6 are numbers of their own. Of every other command they are a location or stand where one does."""
ROI_COMMANDS = (MavCmd.DO_SET_ROI_LOCATION, MavCmd.DO_SET_ROI_NONE, MavCmd.DO_SET_ROI)
CARRIED_OUT = frozenset(
    (*OUTPUT_COMMANDS, *CAMERA_COMMANDS, *MOUNT_COMMANDS, *PAYLOAD_COMMANDS, *ROI_COMMANDS, MavCmd.DO_PARACHUTE)
)
"""By the bridge and what is fitted to the vehicle, besides what the autopilot does with them."""
UNREPORTED = frozenset(
    (
        *OUTPUT_COMMANDS,
        *CAMERA_COMMANDS,
        *VIDEO_COMMANDS,
        *(MavCmd.SET_CAMERA_ZOOM, MavCmd.SET_CAMERA_FOCUS, MavCmd.SET_CAMERA_SOURCE),
        *(
            MavCmd.DO_GIMBAL_MANAGER_PITCHYAW,
            MavCmd.DO_GRIPPER,
            MavCmd.DO_SPRAYER,
            MavCmd.DO_AUX_FUNCTION,
            MavCmd.DO_PARACHUTE,
            MavCmd.JUMP_TAG,
        ),
        *(MavCmd.DO_SEND_SCRIPT_MESSAGE, MavCmd.DO_SET_RESUME_REPEAT_DIST, MavCmd.NAV_LOITER_TO_ALT),
    )
)
"""Of which nothing is reported when they are done: no MISSION_ITEM_REACHED, and no word where they are not carried
out."""
MARKS = (MavCmd.JUMP_TAG, MavCmd.DO_LAND_START, MavCmd.DO_RETURN_PATH_START)
"""Mark a location in the mission: nothing is done there."""
COMMON = (
    MavCmd.CONDITION_DELAY, MavCmd.CONDITION_DISTANCE, MavCmd.DO_JUMP, MavCmd.DO_JUMP_TAG, MavCmd.DO_CHANGE_SPEED,
    MavCmd.DO_FENCE_ENABLE, MavCmd.DO_SET_HOME, MavCmd.DO_GUIDED_LIMITS, MavCmd.DO_SET_RESUME_REPEAT_DIST,
    *MARKS, *CAMERA_COMMANDS, *VIDEO_COMMANDS, *OUTPUT_COMMANDS, *MOUNT_COMMANDS, *PAYLOAD_COMMANDS, *ROI_COMMANDS,
)  # fmt: skip
"""Carried out in missions of all firmwares, besides those that move the vehicle."""

RELATIVE_FRAMES = (MavFrame.GLOBAL_RELATIVE_ALT, MavFrame.GLOBAL_RELATIVE_ALT_INT)
TERRAIN_FRAMES = (MavFrame.GLOBAL_TERRAIN_ALT, MavFrame.GLOBAL_TERRAIN_ALT_INT)


class MissionItem(NamedTuple):
    """A command with its parameters."""

    command: int
    """MAV_CMD"""
    frame: int = MavFrame.GLOBAL_RELATIVE_ALT
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
        return f"{self.name} 0" if self.command == MavCmd.JUMP_TAG else self.name

    @property
    def no_location(self) -> bool:
        """Latitude and longitude are both zero: "where the vehicle is"."""
        return self.x == 0 and self.y == 0


def home_item(lat: int, lon: int, alt: float) -> MissionItem:
    """Item 0 of a downloaded mission: home [degE7, m above mean sea level]."""
    return MissionItem(MavCmd.NAV_WAYPOINT, MavFrame.GLOBAL, x=lat, y=lon, z=alt)
