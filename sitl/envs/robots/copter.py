# SPDX-License-Identifier: BSD-3-Clause
"""The copter as environments drive it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.autopilot.copter.modes.alt_hold import ALT_HOLD
from sitl.autopilot.copter.modes.guided import GUIDED
from sitl.autopilot.copter.modes.loiter import LOITER
from sitl.core.constants import TICK_S
from sitl.physics.native.copter.state import ALL_DRIVEN

from ..actions import ACCELERATION, ATTITUDE, LOITER_STICKS, MOTORS, POSITION, RATES, RC_OVERRIDE, THRUST, VELOCITY
from ..mavlink import betaflight, px4, target_messages
from .kind import FAR, RobotKind, pulses
from .robot import Floats


def drive(records: Any, rows: npt.NDArray[np.int64], commands: Floats) -> None:
    """Write the controls of motors into the physics of copters of a fleet, past the autopilots, which fly on without
    effect. Motors that fail or are stuck do so here, too; a change is not slowed as MOT_SLEW_UP_TIME would.

    Args:
        records: of the fleet.
        rows: numbers of the copters.
        commands: controls, 0 .. 1, a row a copter of the fleet, shape (count, at least as many as rotors).
    """
    physics = records["physics"]
    rotors, properties = physics["rotors"], physics["airframe"]
    count = int(properties["rotor_count"][rows[0]]) if len(rows) else 0
    least, scale = properties["control_min"][rows, None], physics["derived"]["control_scale"][rows, None]
    wanted = np.clip((commands[rows, :count] * rotors["share"][rows, :count] - least) * scale, 0.0, 1.0)
    stuck = records["autopilot"]["params"]["SIM"]["ENGINE_STUCK"][rows].astype(np.int64)
    is_stuck = (stuck[:, None] >> np.arange(count)) & 1 == 1
    rotors["command"][rows, :count] = np.where(is_stuck, rotors["command"][rows, :count], wanted)
    rotors["stuck"][rows] = ALL_DRIVEN


THRUST_IS_THRUST = 8
"""Bit of GUID_OPTIONS: the thrust of SET_ATTITUDE_TARGET is a thrust."""
_ARDUPILOT = RobotKind(
    setpoints=(VELOCITY, RC_OVERRIDE, LOITER_STICKS, POSITION, ATTITUDE, ACCELERATION, THRUST, RATES, MOTORS),
    modes={
        "rc": ALT_HOLD,
        "loiter": LOITER,
        **dict.fromkeys(("velocity", "position", "attitude", "acceleration", "thrust", "rates", "motors"), GUIDED),
    },
    parameters={"thrust": ("GUID_OPTIONS", THRUST_IS_THRUST), "rates": ("GUID_OPTIONS", THRUST_IS_THRUST)},
    guided=GUIDED,
    encode=target_messages.COPTER,
    tick=TICK_S,
    crash_range=0.2,
    discrete={
        "rc": {  # the paper's
            "forward": pulses(1500, 1400, 1500),
            "left": pulses(1400, 1500, 1500),
            "right": pulses(1600, 1500, 1500),
        },
        "velocity": {
            "forward": (0.5, 0.0, 0.0, 0.0),
            "left": (0.2, 0.0, 0.0, 0.6),
            "right": (0.2, 0.0, 0.0, -0.6),
        },
    },
    continuous={
        "rc": ((1300, 1300, 1300, 1300), (1700, 1700, 1700, 1700), (0, 1, 2, 3)),
        "loiter": ((1300, 1300, 1300, 1300), (1700, 1700, 1700, 1700), (0, 1, 2, 3)),
        "velocity": ((-1.0, -1.0, -0.5, -1.0), (1.0, 1.0, 0.5, 1.0), (0, 1, 2, 3)),
        "position": ((-FAR, -FAR, 0.5, -3.2), (FAR, FAR, 100.0, 3.2), (0, 1, 2, 3)),
        "attitude": ((-0.2, -0.2, -1.0, -1.0), (0.2, 0.2, 1.0, 1.0), (0, 1, 2, 3)),
        "acceleration": ((-2.0, -2.0, -1.0, -1.0), (2.0, 2.0, 1.0, 1.0), (0, 1, 2, 3)),
        "thrust": ((-0.2, -0.2, -1.0, 0.0), (0.2, 0.2, 1.0, 1.0), (0, 1, 2, 3)),
        "rates": ((-2.0, -2.0, -2.0, 0.0), (2.0, 2.0, 2.0, 1.0), (0, 1, 2, 3)),
        "motors": (8 * (0.0,), 8 * (1.0,), tuple(range(8))),
    },
    agile={
        "rc": (4 * (1100.0,), 4 * (1900.0,), (0, 1, 2, 3)),
        "loiter": (4 * (1100.0,), 4 * (1900.0,), (0, 1, 2, 3)),
        "velocity": ((-5.0, -5.0, -2.0, -1.5), (5.0, 5.0, 2.0, 1.5), (0, 1, 2, 3)),
        "attitude": ((-0.5, -0.5, -1.5, -1.0), (0.5, 0.5, 1.5, 1.0), (0, 1, 2, 3)),
        "acceleration": ((-4.0, -4.0, -2.0, -1.5), (4.0, 4.0, 2.0, 1.5), (0, 1, 2, 3)),
        "thrust": ((-0.5, -0.5, -1.5, 0.0), (0.5, 0.5, 1.5, 1.0), (0, 1, 2, 3)),
        "rates": ((-4.0, -4.0, -3.0, 0.0), (4.0, 4.0, 3.0, 1.0), (0, 1, 2, 3)),
    },
    drive=drive,
    takes_off=True,
    feels_wind=True,
)
_PX4 = replace(
    _ARDUPILOT,
    setpoints=(VELOCITY, RC_OVERRIDE, LOITER_STICKS, POSITION, ACCELERATION, THRUST, RATES),
    parameters={},
    drive=None,
    modes={
        "rc": px4.ALTCTL,
        "loiter": px4.POSCTL,
        **dict.fromkeys(("velocity", "position", "acceleration", "thrust", "rates"), px4.OFFBOARD),
    },
    guided=px4.OFFBOARD,
    encode=px4.COPTER,
    repeat_us=px4.REPEAT_US,
    before_mode={
        "rc": px4.show_sticks,
        "loiter": px4.show_sticks,
        **{name: px4.switch(px4.COPTER[name]) for name in ("acceleration", "thrust", "rates")},
    },
)
"""A copter that PX4 flies: it has no climb rate in attitude set-points, and takes sticks in modes of its own."""

_BETAFLIGHT = replace(
    _ARDUPILOT,
    setpoints=(RATES, RC_OVERRIDE),
    parameters={},
    drive=None,
    modes={"rates": betaflight.ACRO, "rc": betaflight.ANGLE},
    guided=betaflight.ACRO,
    prepares=betaflight.prepare,
    encode=betaflight.SETPOINTS,
    discrete={},
    continuous={
        "rates": _ARDUPILOT.continuous["rates"],
        "rc": ((1300.0, 1300.0, 1000.0, 1300.0), (1700.0, 1700.0, 2000.0, 1700.0), (0, 1, 2, 3)),
    },
    agile={"rates": _ARDUPILOT.agile["rates"], "rc": (4 * (1000.0,), 4 * (2000.0,), (0, 1, 2, 3))},
)
"""A copter that Betaflight flies: rates in ACRO, sticks in ANGLE, whose throttle is a thrust. Nothing holds its height
but the agent."""

ROBOT = replace(_ARDUPILOT, with_px4=_PX4, with_betaflight=_BETAFLIGHT)
