# SPDX-License-Identifier: BSD-3-Clause
"""Messages of the copter."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...autopilot.copter.modes.autotune import AUTOTUNE
from .. import plot
from ..kind import KindLogs
from . import bits, board, common, derived, escs, surface
from .derived import DEG
from .formats import Field, Message
from .samples import Array

RC_IN, RC_OUT, PID, COMPASS = 1 << 6, 1 << 10, 1 << 12, 1 << 13
"""LOG_BITMASK"""
A, E, S = "autopilot.", "autopilot.estimate.", "sensors."
C = "autopilot.control."
_MOTORS, _ATTITUDE, _NE, _D = C + "motors.", C + "attitude.", C + "pos_ne.", C + "pos_d."
_TARGET = _ATTITUDE + "target_q"
_LOOP_HZ = 400
_SHAPED_TICKS = 8
"""Number of ticks without a run after which a position controller counts as inactive."""


_ANGLES = (
    Field("DesRoll", "f", "d", "0", derived.euler(_TARGET, 0), DEG),
    Field("Roll", "f", "d", "0", derived.euler(E + "q", 0), DEG),
    Field("DesPitch", "f", "d", "0", derived.euler(_TARGET, 1), DEG),
    Field("Pitch", "f", "d", "0", derived.euler(E + "q", 1), DEG),
    Field("DesYaw", "f", "h", "0", derived.wrapped(derived.euler(_TARGET, 2))),
    Field("Yaw", "f", "h", "0", derived.wrapped(derived.euler(E + "q", 2))),
)
"""Wanted and estimated."""


def _attitude(rate: float, bit: int) -> tuple[Message, ...]:
    return (
        Message("ATT", rate, bit).of(
            *_ANGLES,
            Field("AEKF", "B", source=3),
        ),
        Message("ANG", rate, bit).of(
            *_ANGLES,
            Field("Dt", "f", "s", "0", 1.0 / _LOOP_HZ),
        ),
        Message("RATE", rate, bit).of(
            *(
                field
                for k, (letter, axis) in enumerate((("R", "roll"), ("P", "pitch"), ("Y", "yaw")))
                for field in (
                    Field(letter + "Des", "f", "k", "?", f"{_ATTITUDE}rate_target[{k}]", DEG),
                    Field(letter, "f", "k", "?", f"{E}rates[{k}]", DEG),
                    Field(letter + "Out", "f", "-", "?", _MOTORS + axis),
                )
            ),
            Field("ADes", "f", "o", "B", _D + "accel_target", -100.0),
            Field("A", "f", "o", "B", E + "acc_ned[2]", -100.0),
            Field("AOut", "f", source=_MOTORS + "throttle"),
            Field("AOutSlew", "f"),
        ),
    )


def _boost(s: Any) -> Array:
    """Additional throttle for the lean angle."""
    return s(_MOTORS + "throttle_in") - s(_ATTITUDE + "throttle_in")


T = A + "terrain."


def _over_ground(s: Any) -> Array:
    """Height over the ground [m]."""
    return s(A + "home.pos[2]") - s(E + "pos[2]") - s(T + "difference")


def _over_terrain(s: Any) -> Array:
    """The same as far as terrain is known, else the altitude above mean sea level [m]."""
    is_known = (s.raw(T + "was_known") != 0) | (s.raw(T + "asked") == 0)
    return np.where(is_known, _over_ground(s), s(E + "origin_alt") - s(E + "pos[2]"))


CONTROL = Message("CTUN", bits.MEDIUM, bits.CONTROL).of(
    Field("ThI", "f", source=_ATTITUDE + "throttle_in"),
    Field("ABst", "f", source=_boost),
    Field("ThO", "f", source=_MOTORS + "throttle_out"),
    Field("ThH", "f", source=A + "params.MOT.THST_HOVER"),
    Field("DAlt", "f", "m", "0", _D + "pos_desired", -1.0),
    Field("Alt", "f", "m", "0", E + "pos[2]", -1.0),
    Field("BAlt", "f", "m", "0", derived.baro_altitude("sensors.abs_pressure")),
    Field("DSAlt", "f", "m", "0", math.nan),
    Field("SAlt", "f", "m", "0"),
    Field("TAlt", "f", "m", "0", _over_terrain),
    Field("DCRt", "h", "n", "B", _D + "vel_target", -100.0),
    Field("CRt", "h", "n", "B", E + "vel[2]", -100.0),
)


def _ground(s: Any) -> Array:
    """Height of the ground as TERRAIN_REPORT reports it [m]."""
    return s(T + "home") + s(T + "difference") + s(T + "offset")


TERRAIN = Message("TERR", 1.0, bits.GPS, when=T + "was_known").of(
    Field("Status", "B", source=2),
    Field("Lat", "L", "D", "G", derived.latitude(E + "origin_", E + "pos")),
    Field("Lng", "L", "U", "G", derived.longitude(E + "origin_", E + "pos")),
    Field("Spacing", "H", source=T + "spacing"),
    Field("TerrH", "f", "m", "0", _ground),
    Field("CHeight", "f", "m", "0", _over_ground),
    Field("Pending", "H", source=T + "pending"),
    Field("Loaded", "H", source=T + "loaded"),
    Field("ROfs", "f", "m", "0", T + "offset"),
)


def _at_work(path: str) -> Any:
    return lambda s: s.raw(C + "tick") - s.raw(path + "last_tick") < _SHAPED_TICKS


_NE_AT_WORK, _D_AT_WORK = _at_work(_NE), _at_work(_D)


def _position(axis: str, k: int) -> Message:
    base, end, when = (_D, "", _D_AT_WORK) if axis == "D" else (_NE, f"[{k}]", _NE_AT_WORK)
    return common.position_control(axis, k, lambda name: base + name + end, "pos_desired", when)


_TWITCH = A + "modes.autotune."


def _is_twitching(s: Any) -> Array:
    """Whether AUTOTUNE twitches, shape (rows,)."""
    return (s.raw(A + "modes.number") == AUTOTUNE) & (s.raw(_TWITCH + "twitching") != 0)


def _twitched(s: Any) -> Array:
    """Angle since the twitch of AUTOTUNE began, in its direction [deg]."""
    axis, q = np.minimum(s.raw(_TWITCH + "axis"), 2).astype(np.int64), E + "q"
    angle = np.choose(axis, [derived.roll(q)(s), derived.pitch(q)(s), derived.yaw(q)(s)])
    sign = np.where(s.raw(_TWITCH + "backwards") != 0, -1.0, 1.0)
    return np.remainder(sign * angle - s(_TWITCH + "start_angle") * DEG + 180.0, 360.0) - 180.0


def twitch(rate: float) -> Message:
    """ATDE: angle and rate of a twitch, as AUTOTUNE judges them."""
    fields = (Field("Angle", "f", "d", "0", _twitched), Field("Rate", "f", "k", "0", _TWITCH + "rate", DEG))
    return Message("ATDE", rate, bits.IMU | bits.ATTITUDE_FAST, when=_is_twitching).of(*fields)


def messages(bitmask: int, boot_unix_us: int, simulated: bool = True) -> tuple[Message, ...]:
    """Messages that LOG_BITMASK enables; ``simulated``: the record holds the true state."""
    fast = bool(bitmask & bits.ATTITUDE_FAST)
    pids = tuple(
        common.pid(name, f"{C}rate.{axis}", f"ATC.RAT_{short}.", f"{E}rates[{k}]", PID)
        for k, (name, axis, short) in enumerate(
            (("PIDR", "roll", "RLL"), ("PIDP", "pitch", "PIT"), ("PIDY", "yaw", "YAW"))
        )
    )
    every = (
        *_attitude(bits.FAST if fast else bits.MEDIUM, bits.ATTITUDE | bits.ATTITUDE_FAST),
        *common.SENSORS,
        common.FLOW,
        common.battery(derived.resting_voltage, _MOTORS + "resistance"),
        CONTROL,
        *(_position(axis, k) for k, axis in enumerate("NED")),
        common.POSITION,
        *common.gps(boot_unix_us),
        common.magnetometer(COMPASS),
        common.pulses_in(RC_IN),
        common.pulses_out(RC_OUT),
        Message("MOTB", bits.MEDIUM, escs.MOTORS).of(
            Field("LiftMax", "f", source=_MOTORS + "lift_max"),
            Field("BatVolt", "f", source=_MOTORS + "voltage_ratio"),
            Field("ThLimit", "f", source=1.0),
            Field("ThrAvMx", "f", source=_MOTORS + "throttle_avg_max"),
            Field("ThrOut", "f", source=_MOTORS + "throttle_out"),
            Field("FailFlags", "B", source=2),
        ),
        *pids,
        twitch(bits.FAST if fast else bits.IMU_RATE),
        common.LANDING_TARGET,
        TERRAIN,
        *common.FILTER,
        common.AHR2,
        board.loop(_LOOP_HZ, boot_unix_us),
        board.more_pulses_in(RC_IN),
        board.more_pulses_out(RC_OUT),
        *escs.MESSAGES,
        surface.MESSAGE,
        *((common.TRUTH, common.TRUE_MOTION) if simulated else ()),
    )
    return tuple(m for m in every if m.bits & bitmask)


_MODES = (
    "STABILIZE ACRO ALT_HOLD AUTO GUIDED LOITER RTL CIRCLE - LAND - DRIFT - SPORT FLIP AUTOTUNE POSHOLD BRAKE THROW "
    "AVOID_ADSB GUIDED_NOGPS SMART_RTL FLOWHOLD FOLLOW ZIGZAG SYSTEMID AUTOROTATE AUTO_RTL TURTLE"
)
"""https://mavlink.io/en/messages/ardupilotmega.html#COPTER_MODE"""

_LEARN_AND_SAVE = 2.0
"""MOT_HOVER_LEARN"""


def _saved(v: Any) -> tuple[str, ...]:
    return ("MOT_THST_HOVER",) if v.autopilot.params.MOT.HOVER_LEARN == _LEARN_AND_SAVE else ()


LOGS = KindLogs(
    messages=messages,
    title="ArduCopter",
    build_type=2,
    word="Copter",
    mav_types=(2, 3, 4, 13, 14, 15, 29),
    mode_names=tuple(_MODES.split()),
    saved=_saved,
    parameters=("RTL_ALT", "RTL_ALT_M", "PHLD_BRAKE_RATE"),
    panels=(plot.altitude, plot.attitude, plot.motors),
)
