# SPDX-License-Identifier: BSD-3-Clause
"""Record of a multicopter's physics: what every vehicle has (``records``), rotors and contact with the ground."""

from __future__ import annotations

from ....core.records import Float32, Floats, Int32, Record, array
from ....core.vectors import Vec3
from ....vehicles.properties.multicopter import ROTORS_MAX, Properties
from .. import records as shared


class Derived(shared.Derived):
    """What follows from the properties (``prepare``)."""

    dt: float  # substep [s]
    inverse_mass: float  # [1/kg]
    inverse_inertia: Vec3  # about body x, y, z [1/(kg m^2)]
    control_scale: float  # 1 / (control_max - control_min)
    command_step: float  # largest change of command a tick
    motor_lag: float  # time constant of all rotors in place of the properties' [s]; 0: theirs
    decay_up: float  # what is left of a speed error after a substep
    decay_down: float
    speed_per_volt: float  # speed_max / speed_voltage [rad/s/V], 0 without limit
    voltage_scale: float  # 1 / battery_voltage_full [1/V]
    leg_release: float  # share of an impact that the legs take up in a tick


DRIVEN = 1 << 62
"""Bit of ``Rotors.stuck``: somebody else than the autopilot writes the commands (``sitl.envs.robots.copter``)."""
ALL_DRIVEN = DRIVEN | (1 << ROTORS_MAX) - 1


class Rotors(Record):
    """The rotors."""

    command: Floats = array(ROTORS_MAX)  # 0 .. 1
    speed: Floats = array(ROTORS_MAX)  # [rad/s]; THRUST_MOMENTUM: the lagged command 0 .. 1
    thrust: Floats = array(ROTORS_MAX)  # [N]
    share: Floats = array(ROTORS_MAX)  # of their controls that is left (SIM_ENGINE_FAIL)
    stuck: int  # bits of those whose command stays (SIM_ENGINE_STUCK)
    telemetry: bool  # speed controllers report speeds
    rpm_armed: float  # they tell so much at least while armed
    rpm_max: float  # of a rotor at full command, where the model has no speeds
    power: float  # taken from the battery by all [W]
    # vibration (SIM_VIB_MOT_*)
    shakes: bool  # an IMU shows it
    vibrating: Int32  # bits of those that make it; 0: all
    harmonics: Int32  # bits of the multiples of their speed that it has; the lowest: the speed itself
    phase: Floats = array(ROTORS_MAX, stored="f4")  # how far each has turned [rad]
    acc_shake: Floats = array(2, stored="f4")  # amplitude that each rotor adds to what an accelerometer shows [m/s^2]
    gyro_shake: Floats = array(2, stored="f4")  # and a gyro [rad/s]


class Ground(Record):
    """Contact of the legs with the ground."""

    state: int  # GROUND_*
    hit_count: int  # touches so far that were faster than the airframe's hit_speed
    hit_speed: Float32  # of the last one, vertical [m/s]
    hit_time_us: int  # when it was
    impulse: float  # vertical impact that the legs still have to take up [m/s]


class Shove(Record):
    """Something pushes or twists the vehicle (SIM_SHOVE_*, SIM_TWIST_*)."""

    accel: Vec3  # FRD [m/s^2]
    until_us: int  # 0: nothing does
    twist: Vec3  # FRD [rad/s^2]
    twist_until_us: int


class Physics(shared.Physics):
    """The physics of a copter."""

    airframe: Properties
    derived: Derived
    ground: Ground
    rotors: Rotors
    shove: Shove
