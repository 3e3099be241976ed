# SPDX-License-Identifier: BSD-3-Clause
"""Commands that are scanned: every MAV_CMD without parameters, and what scripts send with some."""

from __future__ import annotations

import itertools
from typing import NamedTuple

from sitl.bridge.docs import NEWER
from sitl.client.commands import command_name, command_number
from sitl.core.mavlink import MavFrame

RANGES = (
    (16, 25), (30, 36), (80, 85), (92, 95), (112, 115), (159, 159), (176, 198), (200, 218), (220, 224), (240, 243),
    (245, 246), (252, 252), (260, 260), (262, 262), (300, 300), (310, 311), (400, 401), (405, 406), (410, 410),
    (420, 420), (500, 500), (510, 512), (519, 522), (525, 534), (600, 601), (611, 611), (1000, 1001), (2000, 2005),
    (2010, 2010), (2500, 2505), (2510, 2511), (2520, 2520), (2600, 2600), (2800, 2800), (3000, 3001), (4000, 4001),
    (4501, 4501), (5000, 5004), (5100, 5100), (5200, 5200), (10001, 10001), (10151, 10151), (30001, 30002),
    (31000, 31009), (31012, 31014), (32000, 32000), (42000, 42000), (42004, 42005), (42007, 42007), (42425, 42429),
    (42501, 42503), (42505, 42505), (42600, 42600), (42650, 42651), (42700, 42703), (43000, 43003), (43005, 43006),
)  # fmt: skip
"""Numbers of MAV_CMD, without some: 31010 and 31011, which ``sitl run --lockstep`` has for itself; 5300, which may
switch motors off in flight; 42006 and 42424, which calibrate compasses there; the buttons of a Solo, which take off."""
HERE = (-35.363262, 149.165237)
"""The start of the programs [deg]."""
SET_GLOBAL_ORIGIN = next(number for number, name in NEWER.items() if name == "DO_SET_GLOBAL_ORIGIN")


class Case(NamedTuple):
    """A command with parameters."""

    number: int
    params: tuple[float, ...] = ()
    frame: int = MavFrame.GLOBAL_RELATIVE_ALT
    """Of COMMAND_INT."""
    is_location: bool = False
    """The fifth and sixth are degrees."""

    @property
    def name(self) -> str:
        """As "DO_CHANGE_SPEED 1 5"."""
        words = [NEWER.get(self.number) or command_name(self.number), *(f"{x:g}" for x in self.params)]
        return " ".join([*words, f"frame {self.frame}"] if self.frame != MavFrame.GLOBAL_RELATIVE_ALT else words)


EVERY = tuple(Case(n) for low, high in RANGES for n in range(low, high + 1))
_NAN = float("nan")
_PLAIN: dict[str, tuple[tuple[float, ...], ...]] = {
    "CONDITION_YAW": ((90, 10, 1, 0), (90, 0, -1, 1), (90, -5, 0, 0), (-1,), (361,), (90, 10, 1, 2), (90, 10, 7, 0)),
    "DO_CHANGE_SPEED": tuple((kind, speed) for kind in (0, 1, 2, 3, 4, 5, 9) for speed in (-2, -1, 0, 3)),
    "NAV_SET_YAW_SPEED": ((45, 1, 0), (45, 1, 1)),
    "DO_SET_REVERSE": ((1,), (0,), (2,)),
    "DO_PAUSE_CONTINUE": ((1,), (2,), (0,)),
    "BATTERY_RESET": ((1, 50), (1, 101), (1, -1), (2, 50), (3, 50), (65535, 50), (65536, 50), (0, 50)),
    "DO_SET_MISSION_CURRENT": ((0,), (1,), (2,), (3,), (99,), (-1,), (1, 1), (65536,)),
    "DO_JUMP_TAG": ((1,), (0,), (-1,)),
    "MISSION_START": ((1, 0), (0, 1), (1, 1)),
    "SET_MESSAGE_INTERVAL": (
        (30, -1),
        (30, -2),
        (30, 0),
        (30, 1),
        (30, 999),
        (30, 1000),
        (30, 2500),
        (30, 3000),
        (30, 3125),
        (30, 4000),
        (30, 20000),
        (30, 24000),
        (30, 25000),
        (30, 1e6),
        (30, 6e7),
        (30, 7e7),
        (30, 1e5, 1),
        (9999, 1e5),
        (-1, 1e5),
    ),
    "GET_MESSAGE_INTERVAL": ((0,), (30,), (9999,), (-1,)),
    "REQUEST_MESSAGE": ((0,), (148,), (9999,), (-1,), (244, 30), (244, 9999)),
    "COMPONENT_ARM_DISARM": ((2,), (0.5,)),
    "DO_SET_MODE": ((0, 4), (1, 99), (1, -1), (1, 4.5), (1, 14), (1, 29)),
    "DO_FENCE_ENABLE": ((1,), (2,), (3,), (0,), (1, 1), (0, 1), (1, 16), (0,)),
    "DO_AUX_FUNCTION": ((9, 0), (9, 3), (9, -1), (0, 0), (999, 0), (31, 0), (62, 0), (65, 0)),
    "DO_SET_SERVO": ((1, 1500), (9, 1500), (9, 0), (9, 3001), (0, 1500), (17, 1500), (33, 1500)),
    "DO_REPEAT_SERVO": ((9, 1500, 1, 1), (1, 1500, 1, 1)),
    "DO_SET_RELAY": ((0, 0), (0, 1), (9, 1), (0, 2)),
    "DO_REPEAT_RELAY": ((0, 1, 1), (9, 1, 1)),
    "DO_GRIPPER": ((1, 0), (1, 1), (1, 2)),
    "DO_SPRAYER": ((0,), (1,), (2,)),
    "DO_WINCH": ((1, 0), (1, 1, 1), (1, 2, 0, 1), (1, 3)),
    "DO_PARACHUTE": ((1,), (3,), (0,)),
    "DO_FLIGHTTERMINATION": ((0,), (0.5,), (-1,)),
    "DO_MOUNT_CONTROL": ((-10, 0, 0, 0, 0, 0, 2), (0, 0, 0, 0, 0, 0, 0), (0, 0, 0, 0, 0, 0, 3)),
    "DO_MOUNT_CONFIGURE": ((2,), (3,), (4,), (9,)),
    "DO_GIMBAL_MANAGER_PITCHYAW": ((-10, 0, _NAN, _NAN), (_NAN, _NAN, _NAN, _NAN)),
    "DO_DIGICAM_CONTROL": ((0, 0, 0, 0, 1),),
    "IMAGE_START_CAPTURE": ((0, 1, 2), (1, 1, 2), (2, 1, 2)),
    "DO_SET_CAM_TRIGG_DIST": ((5,), (-1,)),
    "PREFLIGHT_CALIBRATION": ((0, 1), (0, 0, 0, 1), (0, 0, 0, 0, 3), (0, 0, 0, 0, 0, 0, 1)),
    "PREFLIGHT_STORAGE": ((0,), (1,), (3,)),
    "PREFLIGHT_REBOOT_SHUTDOWN": ((0,), (2,), (4,)),
    "CONTROL_HIGH_LATENCY": ((0,), (1,), (2,)),
    "REQUEST_AUTOPILOT_CAPABILITIES": ((1,), (2,)),
    "DO_SEND_BANNER": ((0,),),
    "DO_FOLLOW": ((0,), (2,)),
    "RUN_PREARM_CHECKS": ((1,),),
    "SCRIPTING": ((0,), (1,), (2,), (9,)),
    "SET_CAMERA_FOCUS": ((0, 1), (1, 1), (2, 50), (3, 1), (4,), (9,)),
    "SET_CAMERA_ZOOM": ((1, 1), (2, 50)),
    "SET_CAMERA_SOURCE": ((1, 1),),
    "CAN_FORWARD": ((1,),),
    "AIRFRAME_CONFIGURATION": ((0, 1),),
    "VIDEO_START_CAPTURE": ((1,),),
    "DO_ADSB_OUT_IDENT": ((0,),),
    "NAV_TAKEOFF": ((0, 0, 0, 0, 0, 0, -1),),
}
_ON_THE_GROUND: dict[str, tuple[tuple[float, ...], ...]] = {
    "DO_MOTOR_TEST": (
        (3, 0, 5, 0.1), (4, 0, 5, 0.1), (1, 1, 2201, 0.1), (0, 0, 5, 0.1), (1, 0, 5, 0.1), (5, 0, 5, 0.1),
        (1, 1, 1100, 0.1), (1, 1, 500, 0.1), (1, 2, 0, 0.1), (1, 3, 5, 0.1), (1, 0, 101, 0.1), (1, 0, -1, 0.1),
        (1, 0, 5, 0.1, 2), (1, 0, 5, 0.1, 5), (1, 0, 5, 0.1, 1, 2), (1.5, 0, 5, 0.1),
    ),
    "FIXED_MAG_CAL_YAW": ((0, 1),),
    "PREFLIGHT_STORAGE": ((2,),),
    "SET_EKF_SOURCE_SET": ((2,), (3,), (4,), (0,), (1,)),
    "DO_SET_SAFETY_SWITCH_STATE": ((0,), (1,), (2,)),
}  # fmt: skip


def _places(command: str | int, first: tuple[tuple[float, ...], ...], z: float = 10.0) -> list[Case]:
    """A place of the globe after each of the first four parameters, in each frame; and places that are none."""
    number, (lat, lon) = command if isinstance(command, int) else command_number(command), HERE
    good = [
        Case(number, (*four, 0, 0, 0, 0)[:4] + (lat, lon, z), frame, True)
        for four, frame in itertools.product(first, (MavFrame.GLOBAL_RELATIVE_ALT, 0, 1, 2, 5, 6, 10, 11))
        if frame == MavFrame.GLOBAL_RELATIVE_ALT or four == first[0]
    ]
    bad = [
        Case(number, (*first[0], 0, 0, 0, 0)[:4] + place, is_location=True)
        for place in ((91.0, 0.0, z), (0.0, 181.0, z))
    ]
    return [*good, *bad]


def _cases(table: dict[str, tuple[tuple[float, ...], ...]]) -> list[Case]:
    return [Case(command_number(name), params) for name, rows in table.items() for params in rows]


CASES = (
    *_cases(_PLAIN),
    *_places("DO_REPOSITION", ((3, 1), (-1, 0), (0, 1), (-1, 1), (-1, 2))),
    *_places("DO_SET_ROI", ((0,),)),
    *_places("DO_SET_ROI_LOCATION", ((0,),)),
    *_places("DO_SET_HOME", ((0,), (2,)), 584.0),
    *_places(SET_GLOBAL_ORIGIN, ((0,),), 584.0),
    *_places("EXTERNAL_POSITION_ESTIMATE", ((0, 0, 1, 0),), 584.0),
)
ON_THE_GROUND = tuple(_cases(_ON_THE_GROUND))
_BY_MODE = (
    "CONDITION_YAW", "DO_CHANGE_SPEED", "NAV_SET_YAW_SPEED", "DO_SET_REVERSE", "DO_PAUSE_CONTINUE", "MISSION_START",
    "DO_SET_MISSION_CURRENT", "NAV_TAKEOFF", "DO_SET_MODE", "DO_MOTOR_TEST", "DO_AUX_FUNCTION",
)  # fmt: skip
BY_MODE = (
    *(case for case in CASES if command_name(case.number) in _BY_MODE),
    *(
        Case(command_number("DO_REPOSITION"), (*speed_and_flags, 0, 0, *HERE, 10.0), is_location=True)
        for speed_and_flags in ((3, 1), (-1, 0), (-1, 1))
    ),
)
"""Those whose results hang on the mode."""
