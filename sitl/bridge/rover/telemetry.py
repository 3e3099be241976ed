# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry that the rover has in its own way: HEARTBEAT, EXTENDED_SYS_STATE, VFR_HUD, outputs and wheels."""

from __future__ import annotations

from ...autopilot.rover.control.servos import LEFT, OUTPUTS, RIGHT
from ...autopilot.rover.modes.hold import HOLD
from ...autopilot.rover.modes.initialising import INITIALISING
from ...autopilot.rover.modes.table import AUTONOMOUS, MODES
from ..dialect import message
from ..telemetry import motion
from ..telemetry.builder import Build, Builder, Context, boot_ms, int16
from ..telemetry.status import ATTITUDE, MOTORS, POSITION, RATE, YAW

A, M, C = "autopilot.arming.", "autopilot.modes.", "autopilot.control."
GROUND_ROVER, ARDUPILOTMEGA = 10, 3
CUSTOM_MODE, IS_GUIDED, MANUAL_INPUT, ARMED = 1, 8, 64, 128
CALIBRATING, STANDBY, ACTIVE, CRITICAL = 2, 3, 4, 5

_BASE_MODES = {
    mode.number: CUSTOM_MODE
    | (IS_GUIDED if mode.autonomous else 0)
    | (MANUAL_INPUT if mode.manual_input or mode.number == INITIALISING else 0)
    for mode in MODES
}
_STATES = {INITIALISING: CALIBRATING, HOLD: STANDBY}


def heartbeat(context: Context) -> Build:
    """HEARTBEAT: ground rover, ArduPilot, mode number, armed bit; STANDBY in HOLD, CRITICAL in a failsafe."""
    read = context.fields(
        A + "armed", M + "number", M + "links.acted", M + "failsafe.ekf", "autopilot.params.STICK_MIXING"
    )
    pack = message("HEARTBEAT").pack

    def build() -> bytes:
        armed, mode, links, ekf, mixing = read()
        base = _BASE_MODES.get(mode, CUSTOM_MODE) | (ARMED if armed and mode != INITIALISING else 0)
        base |= MANUAL_INPUT if mixing > 0.0 and mode != INITIALISING else 0
        state = CRITICAL if links or ekf else _STATES.get(mode, ACTIVE)
        return pack(mode & 0xFFFFFFFF, GROUND_ROVER, ARDUPILOTMEGA, base, state, 3)

    return build


CONTROLLERS = RATE | ATTITUDE | YAW | POSITION | MOTORS
"""Bits of SYS_STATUS"""
CONTROLLED_MODES = frozenset(mode.number for mode in MODES if mode.controlled)


def controllers_at_work(mode: int, armed: bool) -> int:
    """Bits of the controllers that a mode uses."""
    bits = RATE | ATTITUDE if mode in CONTROLLED_MODES else 0
    return bits | (YAW | POSITION if mode in AUTONOMOUS else 0) | (MOTORS if armed else 0)


def extended_sys_state(context: Context) -> Build:
    """EXTENDED_SYS_STATE: both states undefined, a rover does not fly."""
    payload = message("EXTENDED_SYS_STATE").pack(0, 0)
    return lambda: payload


def vfr_hud(context: Context) -> Build:
    """VFR_HUD: ground speed in both speeds [m/s], heading [deg], throttle without sign [%], altitude [m]."""
    return motion.vfr_hud(context, C + "motors.throttle")


def rc_channels_scaled(context: Context) -> Build:
    """RC_CHANNELS_SCALED: outputs to steering (1) and throttle (3), skid-steered to left and right, -10000 .. 10000."""
    names = ("steering", "throttle", "left", "right")
    functions = (f"autopilot.params.SERVO[{k}].FUNCTION" for k in range(OUTPUTS))
    read = context.fields("time_us", *(C + "motors.out_" + name for name in names), *functions)
    pack = message("RC_CHANNELS_SCALED").pack

    def build() -> bytes:
        t, steering, throttle, left, right, *assigned = read()
        first, third = (left, right) if LEFT in assigned and RIGHT in assigned else (steering, throttle)
        return pack(boot_ms(t), int16(first * 1e4), -1, int16(third * 1e4), -1, -1, -1, -1, -1, 0, 255)

    return build


def wheel_distance(context: Context) -> Build:
    """WHEEL_DISTANCE: rolled by the left and right driven wheel [m]; nothing without encoders."""
    read = context.fields("time_us", "sensors.wheel_count", "sensors.wheel_distance")
    pack = message("WHEEL_DISTANCE").pack

    def build() -> bytes:
        t, count, left, right = read()
        return pack(t, left, right, *(0.0,) * 14, 2) if count > 0 else b""

    return build


BUILDERS: dict[str, Builder] = {
    "HEARTBEAT": heartbeat,
    "EXTENDED_SYS_STATE": extended_sys_state,
    "VFR_HUD": vfr_hud,
    "RC_CHANNELS_SCALED": rc_channels_scaled,
    "WHEEL_DISTANCE": wheel_distance,
}
