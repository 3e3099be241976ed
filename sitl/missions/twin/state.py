# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle is put into the state that a log shows of one moment, as far as it shows it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from sitl.autopilot.inertial_filter import settle
from sitl.core.algebra import quat_from_euler
from sitl.core.vectors import Euler, Vec2, Vec3
from sitl.physics.native.copter.state import ALL_DRIVEN
from sitl.physics.native.copter.trim import speed_at_full
from sitl.physics.native.records import GROUND_AIRBORNE
from sitl.simulation import Simulation

from . import streams
from .flight_log import FlightLog, TwinError

Array = np.ndarray[Any, Any]

_FRESH_S = 0.3
"""A controller whose last message is older did not work then."""
_NEAR_M, _NEAR_MS = 2.0, 1.0
"""Targets that are farther apart are not the same point of a path [m], [m/s]."""
_NE, _D = ("N", "E"), ("D",)


class Series(NamedTuple):
    """Values over time since arming."""

    time: Array
    values: Array

    def at(self, time: float) -> list[float]:
        """By straight lines."""
        return [float(np.interp(time, self.time, column)) for column in self.values.T]

    def is_fresh(self, time: float) -> bool:
        """Whether there is a sample near."""
        return bool(len(self.time)) and float(np.abs(self.time - time).min()) < _FRESH_S


class LoggedState:
    """The states of a log's vehicle.

    Raises:
        TwinError: the log lacks what makes a state.
    """

    def __init__(self, log: FlightLog) -> None:
        self.log = log
        if not log.has("ATT", "Roll", "Pitch", "Yaw"):
            raise TwinError(f"log {log.name!r} has no ATT: its vehicle's attitude is not known")
        table = log.estimate()
        time = log.since_arming(table)
        self.start = np.array([log.at_arming(time, table[name]) for name in ("PN", "PE", "PD")])
        self.motion = Series(time, np.stack([table[name] for name in ("PN", "PE", "PD", "VN", "VE", "VD")], 1))
        self.attitude = self._angles("Roll", "Pitch", "Yaw")
        self.asked = self._angles("DesRoll", "DesPitch", "DesYaw") if log.has("ATT", "DesRoll", "DesYaw") else None
        self.rates = self._rates()
        found = streams.motors(log) if log.kind == "copter" else None
        self.motors = Series(*found) if found is not None else None
        """[%]"""
        self.position = [self._position(axis) for axis in (*_NE, *_D)]

    @property
    def times(self) -> Array:
        """Moments at which attitude and rates were logged [s]."""
        return self.rates.time

    def _angles(self, *names: str) -> Series:
        table = self.log.table("ATT")
        return Series(self.log.since_arming(table), np.stack([np.unwrap(np.radians(table[name])) for name in names], 1))

    def _rates(self) -> Series:
        log = self.log
        if log.kind == "copter" and log.has("RATE", "R", "P", "Y"):
            table = log.table("RATE")
            values = np.stack([np.radians(table[name]) for name in ("R", "P", "Y")], 1)
        elif log.has("IMU", "GyrX", "GyrY", "GyrZ"):
            table = log.table("IMU", 0)
            values = np.stack([table[name] for name in ("GyrX", "GyrY", "GyrZ")], 1)
        else:
            raise TwinError(f"log {log.name!r} has neither RATE nor IMU: its vehicle's rates are not known")
        return Series(log.since_arming(table), values)

    def _position(self, axis: str) -> Series | None:
        """What the position controller asked for along an axis: position, velocity, acceleration."""
        name = f"PSC{axis}"
        sets = (tuple(f"{first}{kind}{axis}" for kind in "PVA") for first in "DT")
        fields = next((fields for fields in sets if self.log.has(name, *fields)), None)
        if fields is None:
            return None
        table = self.log.table(name)
        return Series(self.log.since_arming(table), np.stack([table[field] for field in fields], 1))

    # ------------------------------------------------------------------

    def put(self, simulation: Simulation, time: float, position: Vec3, driven: bool = False) -> None:
        """Put a copter that flies by its true state there.

        Args:
            simulation: the vehicle, armed and in the air.
            time: since arming [s].
            position: where its body was when it was armed.
            driven: its rotors do from now on what ``drive`` says, not what the autopilot wants.
        """
        v: Any = simulation.v
        if driven:
            v.physics.rotors.stuck = ALL_DRIVEN
        v.physics.ground.state = GROUND_AIRBORNE  # else a simulation that stands stays on its ground
        body, control = v.physics.body, v.autopilot.control
        motion = np.array(self.motion.at(time))
        origin = np.array(position)
        wanted = np.concatenate([origin + motion[:3] - self.start, motion[3:]])
        was = body.pos
        follows = self._follow_targets(control, time, wanted)
        body.pos, body.vel = Vec3(*map(float, wanted[:3])), Vec3(*map(float, wanted[3:]))
        body.q = quat_from_euler(Euler(*self.attitude.at(time)))
        rates = Vec3(*self.rates.at(time))
        body.rates = body.rates_mean = rates
        settle(v.autopilot.inertial_filter.gyro, rates)
        self.drive(simulation, time, at_once=True)
        if self.asked is not None:
            control.attitude.target_q = quat_from_euler(Euler(*self.asked.at(time)))
        moved = body.pos - was
        if not follows[0]:
            control.pos_ne.pos_desired += Vec2(moved.x, moved.y)
        if not follows[1]:
            control.pos_d.pos_desired += moved.z

    def _follow_targets(self, control: Any, time: float, wanted: Array) -> tuple[bool, bool]:
        """Where a controller follows a path, put the vehicle as far from its own target as the log's was from its: two
        flights come to the same point of a path some hundredths of a second apart, which is no error of the state.

        Args:
            control: the controllers.
            time: since arming [s].
            wanted: position and velocity, changed in place, shape (6,).

        Returns:
            Whether that was done of north and east, and of down.
        """
        level, height = control.pos_ne, control.pos_d
        own = (
            (float(level.pos_desired[0]), float(level.vel_desired[0])),
            (float(level.pos_desired[1]), float(level.vel_desired[1])),
            (float(height.pos_desired), float(height.vel_desired)),
        )
        found = [False, False]
        for part, axes in enumerate(((0, 1), (2,))):
            series = [self.position[axis] for axis in axes]
            if any(one is None or not one.is_fresh(time) for one in series):
                continue
            moves = []
            for axis, one in zip(axes, series):
                assert one is not None
                pos, vel = one.at(time)[:2]
                moves.append((own[axis][0] - (pos - float(self.start[axis])), own[axis][1] - vel))
            if all(abs(by) < _NEAR_M and abs(faster) < _NEAR_MS for by, faster in moves):
                for axis, (by, faster) in zip(axes, moves):
                    wanted[axis] += by
                    wanted[axis + 3] += faster
                found[part] = True
        return found[0], found[1]

    def drive(self, simulation: Simulation, time: float, at_once: bool = False) -> None:
        """Command the rotors as the log's motors were; ``at_once``: their speeds follow without lag."""
        if self.motors is None:
            return
        v: Any = simulation.v
        physics, params = v.physics, v.autopilot.params.MOT
        rotors, airframe = physics.rotors, physics.airframe
        low, high = (params.PWM_MIN, params.PWM_MAX) if params.PWM_MAX > params.PWM_MIN else (1000.0, 2000.0)
        top = speed_at_full(physics)
        full = 1.0 if top == 1.0 else float(airframe.speed_max)
        outputs = v.autopilot.control.motors.output
        for k, percent in enumerate(self.motors.at(time)):
            rotor = int(outputs[k])
            if not 0 <= rotor < airframe.rotor_count:
                continue
            control = (low + 0.01 * percent * (high - low) - 1000.0) / 1000.0 * rotors.share[rotor]
            command = (control - airframe.control_min) / (airframe.control_max - airframe.control_min)
            rotors.command[rotor] = min(max(command, 0.0), 1.0)
            if at_once:
                rotors.speed[rotor] = min(rotors.command[rotor] * full, top)
