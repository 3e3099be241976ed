# SPDX-License-Identifier: BSD-3-Clause
"""Gripper, winch, sprayer, parachute and mount: numbers and parameters. The core does not read these."""

from __future__ import annotations

OUTPUTS = 16

# SERVOn_FUNCTION
MOUNT_YAW, MOUNT_PITCH, MOUNT_ROLL, CAMERA_TRIGGER, PUMP, SPINNER, PARACHUTE, GRIPPER, WINCH = (
    6,
    7,
    8,
    10,
    22,
    23,
    27,
    28,
    88,
)

# RCn_OPTION of switches
SWITCH_CAMERA, SWITCH_SPRAYER, SWITCH_GRIPPER, SWITCH_FOLD, SWITCH_WINCH, SWITCH_WINDING = 9, 15, 19, 27, 44, 45
SWITCH_LOCK = 163
SWITCH_PARACHUTE_ENABLE, SWITCH_PARACHUTE_RELEASE, SWITCH_PARACHUTE = 21, 22, 23
SWITCH_RELAYS = {28: 0, 34: 1, 35: 2, 36: 3, 66: 4, 67: 5}
"""Relay, from 0, by function."""

BY_SERVO = 1
"""GRIP_TYPE, WINCH_TYPE and MNT1_TYPE."""
BY_MAGNET = 2
"""GRIP_TYPE."""
PARACHUTE_BY_SERVO = 10
"""CHUTE_TYPE."""

MEANINGS = {
    "GRIP_ENABLE": "1: there is a gripper, from the next boot on; 0 refuses its commands at once",
    "GRIP_TYPE": "1: a gripper moved by the outputs of function 28, 2: an electromagnet (EPM) on them; at boot",
    "GRIP_GRAB": "Pulse that closes the gripper [us]",
    "GRIP_RELEASE": "Pulse that opens the gripper [us]",
    "GRIP_NEUTRAL": "Pulse of the gripper from boot until it first moves; of an EPM, at rest [us]",
    "GRIP_REGRAB": "An EPM that holds grabs again so often [s]; 0: it does not",
    "GRIP_AUTOCLOSE": "The gripper closes by itself so long after it was told to open [s]; 0: it stays open",
    "WINCH_TYPE": "1: a winch driven by the outputs of function 88, from the next boot on",
    "WINCH_RATE_MAX": "Fastest winding of the winch's line [m/s]",
    "WINCH_POS_P": "Winding rate for each metre of line that is still missing or too much [1/s]",
    "SPRAY_ENABLE": "1: there is a sprayer, from the next boot on: function 22 of an output its pump, 23 its spinner",
    "SPRAY_SPINNER": "Pulse of the spinner while the sprayer sprays [us]",
    "SPRAY_PUMP_RATE": "Pump's rate for each m/s over the ground [%]",
    "SPRAY_PUMP_MIN": "Least rate of the pump while the sprayer sprays [%]",
    "SPRAY_SPEED_MIN": "The sprayer pauses below this speed over the ground [cm/s]",
    "CHUTE_ENABLED": "1: there is a parachute",
    "CHUTE_TYPE": "What releases the parachute: 0 to 3 relay 1 to 4, 10 the outputs of function 27",
    "CHUTE_SERVO_ON": "Pulse that releases the parachute [us]",
    "CHUTE_SERVO_OFF": "Pulse while the parachute is packed, and from two seconds after its release on [us]",
    "CHUTE_ALT_MIN": "The parachute is not released below this height above home [m]; 0: at any height",
    "CHUTE_DELAY_MS": "Time from the stop of the motors until the parachute is released [ms]",
    "CHUTE_CRT_SINK": "A vehicle that sinks faster for a second releases its parachute [m/s]; 0: it does not",
    "CHUTE_OPTIONS": "Bits: 1 the output stays at CHUTE_SERVO_ON, 2 the motors are not stopped",
    "MNT1_TYPE": "1: a gimbal of outputs of functions 6 (yaw), 7 (pitch), 8 (roll), from the next boot on; 0: none",
    "MNT1_DEFLT_MODE": "What the gimbal does at boot: 0 folded, 1 neutral, 2 angles of commands, 3 sticks",
    "MNT1_RC_RATE": "0: sticks of the gimbal give angles; else angular rates, at most this [deg/s]",
    **{
        f"MNT1_{axis}_{end}": f"{side} {axis.lower()} of the gimbal [deg]"
        for axis in ("ROLL", "PITCH", "YAW")
        for end, side in (("MIN", "Least"), ("MAX", "Greatest"))
    },
    **{
        f"MNT1_{stance}_{letter}": f"{axis} of the gimbal {text} [deg]"
        for stance, text in (("RETRACT", "when it is folded"), ("NEUTRAL", "in its neutral place"))
        for letter, axis in (("X", "Roll"), ("Y", "Pitch"), ("Z", "Yaw"))
    },
    **{
        f"SERVO{n}_FUNCTION": f"What output {n} does: 6, 7, 8 yaw, pitch, roll of the gimbal; 10 the camera's trigger; "
        "22, 23 pump and spinner of the sprayer; 27 parachute; 28 gripper; 88 winch; 0 nothing (free for DO_SET_SERVO)"
        for n in range(5, OUTPUTS + 1)
    },
    **{
        f"SERVO{n}_{name}": f"{text} of output {n}, for gimbal, sprayer and winch [us]"
        for n in range(5, OUTPUTS + 1)
        for name, text in (("MIN", "Shortest pulse"), ("MAX", "Longest pulse"))
    },
}
"""Parameters that are read outside the core, and what they do."""
