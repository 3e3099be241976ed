# SPDX-License-Identifier: BSD-3-Clause
"""Records that the physics of every vehicle has.

SI units; NED frame from the home ground point, in a world from its origin on the floor (pos[2] negative up); FRD body
frame; quaternions body to NED.
Only physics and the shell read them; the autopilot sees ``sensors``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.records import record
from .obstacles import OBSTACLES_DTYPE

DERIVED_SHARED = (  # follows from the figures (prepare.py), so that a tick needs no exp
    ("charge_per_amp", "f8"),  # loss of charge (of 1) per ampere and tick
    ("acc_noise", "f8"),  # standard deviation of one sample [m/s^2]
    ("gyro_noise", "f8"),
    ("acc_bias_decay", "f8"),  # first-order Gauss-Markov step of the in-run bias: left over, and noise added
    ("acc_bias_step", "f8"),
    ("gyro_bias_decay", "f8"),
    ("gyro_bias_step", "f8"),
    ("gps_period", "i8"),  # [ticks]
    ("gps_delay", "i8"),
    ("gps_start", "i8"),
    ("gps_fix", "i8"),
    ("gps_drift_decay", "f8"),
    ("gps_drift_step", "f8"),  # for a drift of standard deviation 1
    ("baro_period", "i8"),
    ("baro_drift_decay", "f8"),
    ("baro_drift_step", "f8"),
    ("mag_period", "i8"),
)

BODY_DTYPE = record(  # truth
    ("pos", "f8", 3),  # NED from the home ground point [m]
    ("vel", "f8", 3),  # NED [m/s]
    ("q", "f8", 4),  # body to NED
    ("rates", "f8", 3),  # body [rad/s], now
    ("rates_mean", "f8", 3),  # mean over the last tick, what an integrating gyro measures
    ("acc_ned", "f8", 3),  # acceleration NED, mean over the last tick [m/s^2]
    ("specific_force", "f8", 3),  # body, mean over the last tick; at rest and level (0, 0, -9.80665)
)

MOTION_DTYPE = record(  # between the common laws and an engine that moves the body (sitl.physics.engine)
    ("force", "f8", 3),  # on the body but gravity and ground, FRD [N]
    ("torque", "f8", 3),  # FRD [N m]
    ("contact", "f8", 3),  # change of velocity in this tick that hard contacts gave, NED [m/s]
    ("vel", "f8", 3),  # body.vel before this tick
    ("q", "f8", 4),  # body.q before this tick
)

BATTERY_STATE_DTYPE = record(
    ("charge", "f8"),  # 1 full .. 0 empty
    ("voltage", "f8"),  # at the terminals [V]
    ("current", "f8"),  # [A]
)

AIR_DTYPE = record(
    ("density", "f8"),  # at the vehicle [kg/m^3]
    ("density_root", "f8"),  # its square root
)

WIND_DTYPE = record(
    ("speed", "f8"),  # steady wind [m/s] (SIM_WIND_SPD)
    ("direction", "f8"),  # where it comes from [deg] (SIM_WIND_DIR)
    ("turbulence", "f8"),  # standard deviation of each axis [m/s] (SIM_WIND_TURB)
    ("time_constant", "f8"),  # correlation time of turbulence and lag of changes [s] (SIM_WIND_TC)
    ("steady", "f8", 3),  # NED, after the lag [m/s]
    ("gust", "f8", 3),  # NED [m/s]
    ("vel", "f8", 3),  # NED, steady and gust: what the vehicle meets
)

GPS_RING = 8
"""Fixes under way to the reader: delay times rate must stay below this."""

SENSOR_STATE_DTYPE = record(  # hidden from the autopilot
    ("acc_bias", "f8", 3),  # turn-on bias [m/s^2]
    ("acc_walk", "f8", 3),  # in-run bias
    ("acc_scale", "f8", 3),  # 1 + error
    ("gyro_bias", "f8", 3),
    ("gyro_walk", "f8", 3),
    ("gyro_scale", "f8", 3),
    ("gps_drift", "f8", 3),  # in standard deviations
    ("gps_off", "i8"),  # the receiver is switched off
    ("gps_head", "i8"),  # fixes taken so far
    ("gps_tail", "i8"),  # fixes delivered so far
    ("gps_due", "i8", GPS_RING),  # tick of delivery
    ("gps_fix", "i8", GPS_RING),
    ("gps_lat", "i8", GPS_RING),  # [degE7]
    ("gps_lon", "i8", GPS_RING),
    ("gps_alt", "i8", GPS_RING),  # [mm]
    ("gps_vel_n", "i8", GPS_RING),  # [cm/s]
    ("gps_vel_e", "i8", GPS_RING),
    ("gps_vel_d", "i8", GPS_RING),
    ("baro_drift", "f8"),  # in standard deviations
)

PLACE_DTYPE = record(  # the home ground point, known to the simulator alone
    ("lat", "i8"),  # [degE7]
    ("lon", "i8"),  # [degE7]
    ("alt", "f8"),  # above mean sea level [m]
    ("field", "f8", 3),  # geomagnetic field NED [gauss]
)


def physics_dtype(airframe: np.dtype[Any], derived: np.dtype[Any], *own: tuple[str, np.dtype[Any]]) -> np.dtype[Any]:
    """The physics of a kind of vehicle: what all have, and the kind's own records."""
    return record(
        ("airframe", airframe),
        ("derived", derived),
        ("place", PLACE_DTYPE),
        ("body", BODY_DTYPE),
        ("motion", MOTION_DTYPE),
        ("battery", BATTERY_STATE_DTYPE),
        ("air", AIR_DTYPE),
        ("wind", WIND_DTYPE),
        ("sensors", SENSOR_STATE_DTYPE),
        ("obstacles", OBSTACLES_DTYPE),
        *own,
    )
