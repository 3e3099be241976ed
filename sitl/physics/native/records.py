# SPDX-License-Identifier: BSD-3-Clause
"""Records that the physics of every vehicle has.

SI units; NED frame from the home ground point, in a world from its origin on the floor (pos[2] negative up); FRD body
frame; quaternions body to NED.
Only physics and the shell read them; the autopilot sees ``sensors``.
"""

from __future__ import annotations

from ...core.records import Floats, Ints, Record, array
from ...vehicles.figures.common import Figures
from .obstacles import Obstacles


class Derived(Record):
    """What follows from the figures (``prepare``), so that a tick needs no exp: what all vehicles have."""

    charge_per_amp: float  # loss of charge (of 1) per ampere and tick
    acc_noise: float  # standard deviation of one sample [m/s^2]
    gyro_noise: float
    acc_bias_decay: float  # first-order Gauss-Markov step of the in-run bias: left over, and noise added
    acc_bias_step: float
    gyro_bias_decay: float
    gyro_bias_step: float
    gps_period: int  # [ticks]
    gps_delay: int
    gps_start: int
    gps_fix: int
    gps_drift_decay: float
    gps_drift_step: float  # for a drift of standard deviation 1
    baro_period: int
    baro_drift_decay: float
    baro_drift_step: float
    mag_period: int


class Body(Record):
    """Where the body really is and how it moves."""

    pos: Floats = array(3)  # NED from the home ground point [m]
    vel: Floats = array(3)  # NED [m/s]
    q: Floats = array(4)  # body to NED
    rates: Floats = array(3)  # body [rad/s], now
    rates_mean: Floats = array(3)  # mean over the last tick, what an integrating gyro measures
    acc_ned: Floats = array(3)  # acceleration NED, mean over the last tick [m/s^2]
    specific_force: Floats = array(3)  # body, mean over the last tick; at rest and level (0, 0, -9.80665)


class Motion(Record):
    """What passes between the common laws and an engine that moves the body (``sitl.physics.engine``)."""

    force: Floats = array(3)  # on the body but gravity and ground, FRD [N]
    torque: Floats = array(3)  # FRD [N m]
    contact: Floats = array(3)  # change of velocity in this tick that hard contacts gave, NED [m/s]
    vel: Floats = array(3)  # body.vel before this tick
    q: Floats = array(4)  # body.q before this tick


class BatteryState(Record):
    """The battery."""

    charge: float  # 1 full .. 0 empty
    voltage: float  # at the terminals [V]
    current: float  # [A]


class Air(Record):
    """The air around the vehicle."""

    density: float  # at the vehicle [kg/m^3]
    density_root: float  # its square root


class Wind(Record):
    """Wind and gusts."""

    speed: float  # steady wind [m/s] (SIM_WIND_SPD)
    direction: float  # where it comes from [deg] (SIM_WIND_DIR)
    turbulence: float  # standard deviation of each axis [m/s] (SIM_WIND_TURB)
    time_constant: float  # correlation time of turbulence and lag of changes [s] (SIM_WIND_TC)
    steady: Floats = array(3)  # NED, after the lag [m/s]
    gust: Floats = array(3)  # NED [m/s]
    vel: Floats = array(3)  # NED, steady and gust: what the vehicle meets


GPS_RING = 8
"""Fixes under way to the reader: delay times rate must stay below this."""


class SensorState(Record):
    """What is wrong with the sensors; hidden from the autopilot."""

    acc_bias: Floats = array(3)  # turn-on bias [m/s^2]
    acc_walk: Floats = array(3)  # in-run bias
    acc_scale: Floats = array(3)  # 1 + error
    gyro_bias: Floats = array(3)
    gyro_walk: Floats = array(3)
    gyro_scale: Floats = array(3)
    gps_drift: Floats = array(3)  # in standard deviations
    gps_off: int  # the receiver is switched off
    gps_head: int  # fixes taken so far
    gps_tail: int  # fixes delivered so far
    gps_due: Ints = array(GPS_RING, stored="i8")  # tick of delivery
    gps_fix: Ints = array(GPS_RING, stored="i8")
    gps_lat: Ints = array(GPS_RING, stored="i8")  # [degE7]
    gps_lon: Ints = array(GPS_RING, stored="i8")
    gps_alt: Ints = array(GPS_RING, stored="i8")  # [mm]
    gps_vel_n: Ints = array(GPS_RING, stored="i8")  # [cm/s]
    gps_vel_e: Ints = array(GPS_RING, stored="i8")
    gps_vel_d: Ints = array(GPS_RING, stored="i8")
    baro_drift: float  # in standard deviations


class Place(Record):
    """The home ground point, known to the simulator alone."""

    lat: int  # [degE7]
    lon: int  # [degE7]
    alt: float  # above mean sea level [m]
    field: Floats = array(3)  # geomagnetic field NED [gauss]


class Physics(Record):
    """The physics of a vehicle: what all have."""

    airframe: Figures
    derived: Derived
    place: Place
    body: Body
    motion: Motion
    battery: BatteryState
    air: Air
    wind: Wind
    sensors: SensorState
    obstacles: Obstacles
