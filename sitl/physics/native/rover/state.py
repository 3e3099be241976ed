# SPDX-License-Identifier: BSD-3-Clause
"""Record of a rover's physics: what every vehicle has (``records``), and its wheels."""

from __future__ import annotations

from ....core.records import record
from ....vehicles.figures.rover import FIGURES_DTYPE
from ..records import DERIVED_SHARED, physics_dtype

DERIVED_DTYPE = record(  # follows from the figures (prepare.py), so that a tick divides little
    ("control_scale", "f8"),  # 1 / control_full
    ("speed_decay", "f8"),  # what is left of a wheel-speed error after a tick
    ("speed_step", "f8"),  # largest change of wheel speed a tick that the motors give [m/s]
    ("rolling_step", "f8"),  # what rolling resistance takes off a tick [m/s]
    ("grip", "f8"),  # greatest acceleration on these tyres [m/s^2]
    ("drive_grip", "f8"),  # the same, of the driven wheels along
    ("yaw_step", "f8"),  # largest change of the yaw rate a tick that the tyres give [rad/s]
    ("steering_step", "f8"),  # largest turn of the front wheels a tick [rad]
    ("inverse_wheelbase", "f8"),  # STEERING_FRONT_WHEELS [1/m]
    ("circle_scale", "f8"),  # STEERING_TURNING_CIRCLE: curvature by sine of the angle [1/m]
    ("inverse_track", "f8"),  # STEERING_SKID: yaw rate by difference of the sides' speeds [1/m]
    ("power_by_accel", "f8"),  # battery power by acceleration and speed at no load [W/(m/s^2)/(m/s)]
    ("encoder_period", "i8"),  # [ticks], 0 no encoder
    *DERIVED_SHARED,
)

WHEELS_DTYPE = record(
    ("angle", "f8"),  # of the front wheels, to the right [rad]
    ("speed", "f8", 2),  # rolling speed that the motors give [m/s]: of the axle, or of the left and right side
    ("distance", "f8", 2),  # rolled by the left and right driven wheel [m]
    ("power", "f8"),  # taken from the battery by the motors [W]
    ("forward", "f8"),  # speed of the driven axle over the ground [m/s]; less than the wheels' when they slip
)

PHYSICS_DTYPE = physics_dtype(FIGURES_DTYPE, DERIVED_DTYPE, ("wheels", WHEELS_DTYPE))
