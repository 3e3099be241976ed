# SPDX-License-Identifier: BSD-3-Clause
"""Our physics for Paparazzi's simulator NPS, by the Python interface of its flight model ``pybullet``.

NPS compiles a flight model into the autopilot's process. The one called pybullet embeds Python: it imports the module
NPS_PYBULLET_MODULE, makes its ``BulletFDM``, and calls ``step`` once a step. So this module takes the place of its own
(docs/foreign-autopilots.md). Not tried with Paparazzi itself. Source: paparazzi/paparazzi,
sw/simulator/nps/nps_fdm_pybullet.c and sw/simulator/nps/pybullet, read in November 2026.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

from ..core.algebra import Quat, Vec3, multiply, rotate
from ..core.constants import GRAVITY, TICK_US
from ..errors import OptionError
from ..plants.local import stand_alone

THEIR_GRAVITY = 10.0
"""What NPS takes off the vertical acceleration to get what an accelerometer measures [m/s^2]."""
LOWEST, RANGE = 1000, 1000
"""Pulse of the command 0, and how much longer that of 1 is [us]."""


class BulletFDM:
    """A copter at power-on, moved step by step by Paparazzi's commands.

    Args:
        dt: length of a step [s]: one tick of our physics (1/400 s) or a whole number of them.
        GUI: of PyBullet; not used.
        urdf: NPS_PYBULLET_URDF, here the name of an airframe.

    Raises:
        OptionError: the step is no whole number of ticks, or the airframe is no copter.
        AirframeError: there is no such airframe.
    """

    options: ClassVar[dict[str, Any]] = {}
    """Options of the scenario (``sitl.scenario.Options``), for a class of one's own: world, params, seed."""

    def __init__(self, dt: float, GUI: bool = False, urdf: str = "erle_copter") -> None:
        self._ticks = round(1e6 * dt / TICK_US)
        if self._ticks < 1 or abs(1e6 * dt - self._ticks * TICK_US) > 1e-3:
            raise OptionError(
                f"a step of {dt:.6g} s is no whole number of {1e-6 * TICK_US} s: set SYS_TIME_FREQUENCY to 400 or 200"
            )
        plant = stand_alone(urdf, **self.options)
        vehicle = plant.vehicle
        if vehicle.kind.name != "copter":
            plant.close()
            raise OptionError(f"airframe {urdf} is a {vehicle.kind.name}: this interface has copters")
        self._plant, self._body = plant, vehicle.v.physics.body
        self._actuators = vehicle.v.actuators

    def step(self, commands: Sequence[float]) -> dict[str, tuple[float, ...]]:
        """Make one step.

        Args:
            commands: of the rotors in the airframe's order (ArduPilot's), 0 standstill .. 1 full speed.

        Returns:
            At its end: pos, vel, accel of the centre of mass, east, north, up [m, m/s, m/s^2]; quat, from the body
            (front, left, up) to east, north, up, as x, y, z, w; ang_v [rad/s] and ang_accel [rad/s^2], east, north,
            up. accel is such that NPS's accelerometer measures the mean of the last tick.
        """
        parts = [min(max(float(part), 0.0), 1.0) for part in commands]
        self._actuators.controls[: len(parts)] = parts
        self._actuators.pwm[: len(parts)] = [round(LOWEST + RANGE * part) for part in parts]
        before = self._turning()
        for _ in range(self._ticks):
            self._plant.tick()
        now, b, seconds = self._turning(), self._body, 1e-6 * TICK_US * self._ticks
        q = multiply(multiply(_ENU_OF_NED, Quat(*b.q)), _FRD_OF_FLU)
        acc = b.acc_ned
        return {
            "pos": _enu(b.pos),
            "vel": _enu(b.vel),
            "accel": _enu(Vec3(acc.x, acc.y, acc.z + THEIR_GRAVITY - GRAVITY)),
            "quat": (q.x, q.y, q.z, q.w),
            "ang_v": now,
            "ang_accel": tuple((after - ago) / seconds for after, ago in zip(now, before)),
        }

    def _turning(self) -> tuple[float, ...]:
        b = self._body
        return _enu(rotate(Quat(*b.q), Vec3(*b.rates)))


def _enu(v: Any) -> tuple[float, ...]:
    return v.y, v.x, -v.z


_FRD_OF_FLU = Quat(0.0, 1.0, 0.0, 0.0)
"""Half a turn about the nose: left becomes right, and up down."""
_ENU_OF_NED = Quat(0.0, math.sqrt(0.5), math.sqrt(0.5), 0.0)
"""Half a turn about north-east: north and east change places, and down becomes up."""
