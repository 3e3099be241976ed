# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle is put into the state that a log tells of one moment, as far as it tells it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from sitl.autopilot.inertial_filter import settle
from sitl.core.algebra import quat_from_euler
from sitl.core.vectors import Euler, Vec2, Vec3
from sitl.physics.native.copter.state import ALL_DRIVEN
from sitl.physics.native.copter.trim import speed_at_full
from sitl.simulation import Simulation

from . import streams
from .flight_log import FlightLog, TwinError

Array = np.ndarray[Any, Any]

_FRESH_S = 0.3
"""A controller whose last message is older did not work then."""
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
        return Series(
            self.log.since_arming(table), np.stack([np.unwrap(np.radians(table[name])) for name in names], 1)
        )

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

    def put(self, simulation: Simulation, time: float, place: Vec3, driven: bool = False) -> None:
        """Put a copter that flies by its true state there.

        Args:
            simulation: the vehicle, armed and in the air.
            time: since arming [s].
            place: where its body was when it was armed.
            driven: its rotors do from now on what ``drive`` says, not what the autopilot wants.
        """
        v = simulation.v
        if driven:
            v.physics.rotors.stuck = ALL_DRIVEN
        body = v.physics.body
        motion = np.array(self.motion.at(time))
        was, away = body.pos, motion[:3] - self.start
        body.pos = Vec3(place.x + float(away[0]), place.y + float(away[1]), place.z + float(away[2]))
        body.vel = Vec3(*map(float, motion[3:]))
        body.q = quat_from_euler(Euler(*self.attitude.at(time)))
        rates = Vec3(*self.rates.at(time))
        body.rates = body.rates_mean = rates
        settle(v.autopilot.inertial_filter.gyro, rates)
        self.drive(simulation, time, at_once=True)
        control = v.autopilot.control
        if self.asked is not None:
            control.attitude.target_q = quat_from_euler(Euler(*self.asked.at(time)))
        moved = body.pos - was
        self._put_targets(control, time, moved)

    def _put_targets(self, control: Any, time: float, moved: Vec3) -> None:
        north, east, down = self.position
        level, height = control.pos_ne, control.pos_d
        if north is not None and east is not None and north.is_fresh(time):
            n, e = north.at(time), east.at(time)
            level.pos_desired = Vec2(n[0] - float(self.start[0]), e[0] - float(self.start[1]))
            level.vel_desired, level.accel_desired = Vec2(n[1], e[1]), Vec2(n[2], e[2])
        else:
            level.pos_desired += Vec2(moved.x, moved.y)
        if down is not None and down.is_fresh(time):
            d = down.at(time)
            height.pos_desired = d[0] - float(self.start[2])
            height.vel_desired, height.accel_desired = d[1], d[2]
        else:
            height.pos_desired += moved.z

    def drive(self, simulation: Simulation, time: float, at_once: bool = False) -> None:
        """Command the rotors as the log's motors were; ``at_once``: their speeds follow without lag."""
        if self.motors is None:
            return
        v = simulation.v
        physics, params = v.physics, v.autopilot.params.MOT
        rotors, figures = physics.rotors, physics.airframe
        low, high = (params.PWM_MIN, params.PWM_MAX) if params.PWM_MAX > params.PWM_MIN else (1000.0, 2000.0)
        top = speed_at_full(physics)
        full = 1.0 if top == 1.0 else float(figures.speed_max)
        outputs = v.autopilot.control.motors.output
        for k, percent in enumerate(self.motors.at(time)):
            rotor = int(outputs[k])
            if not 0 <= rotor < figures.rotor_count:
                continue
            control = (low + 0.01 * percent * (high - low) - 1000.0) / 1000.0 * rotors.share[rotor]
            command = (control - figures.control_min) / (figures.control_max - figures.control_min)
            rotors.command[rotor] = min(max(command, 0.0), 1.0)
            if at_once:
                rotors.speed[rotor] = min(rotors.command[rotor] * full, top)

