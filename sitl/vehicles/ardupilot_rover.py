# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's default SITL rover, so that drives can be held against recordings of it.

Facts of its model, read from its documentation and measured on an unmodified simulator (4.7-dev, July 2025): forward
acceleration 10 (20 throttle - v) / 20 m/s^2, a turning circle of 1.8 m at full lock, no slip, no lag.
"""

from __future__ import annotations

import math

from . import sensor_sets
from .properties.ground_vehicle import STEERING_TURNING_CIRCLE
from .rover_airframe import RoverAirframe

SPEED = 20.0  # [m/s]
ACCELERATION = 10.0  # [m/s^2]
BATTERY_CURRENT = 50.0  # [A] at full throttle
BATTERY_SAG = 0.7  # [V] at full throttle

AIRFRAME = RoverAirframe(
    name="ardupilot_rover",
    description="ArduPilot's default SITL rover",
    properties={
        "mass": 1.0,  # [kg] of no effect
        "inertia": (0.01, 0.01, 0.01),  # [kg m^2] of no effect
        "control_full": 1.0,  # 1000 and 2000 us are the ends
        "speed_max": SPEED,
        "time_constant": SPEED / ACCELERATION,  # [s]
        "efficiency": 0.0,  # its battery knows only the throttle
        "power_full": BATTERY_CURRENT * 12.6,  # [W]
        "grip": 1000.0,  # no slip
        "steering_model": STEERING_TURNING_CIRCLE,
        "steering_angle": math.radians(35.0),
        "turning_diameter": 1.8,  # [m]
        "track": 0.296,  # [m] of the wheel encoders alone, which are off
        # A point neither tips over nor pitches: as a car it is low, and its wheelbase gives what turns it takes.
        "wheelbase": 0.3,  # [m] (assumed)
        "wheel_radius": 0.05,  # [m] (assumed)
        "centre_height": 0.02,  # [m] (assumed)
        "battery_voltage_full": 12.6,  # [V] SIM_BATT_VOLTAGE
        "battery_capacity": 0.0,  # [Ah] SIM_BATT_CAP_AH 0: it never empties
        "battery_resistance": BATTERY_SAG / BATTERY_CURRENT,  # [ohm]
        "contact_radius": 0.25,  # [m] (assumed)
        "contact_top": 0.3,  # [m] (assumed)
        **sensor_sets.SITL_IMU,
        **sensor_sets.SITL_GPS,
        **sensor_sets.SITL_BARO,
        **sensor_sets.SITL_MAG,
    },
    parameters={  # ArduPilot's rover defaults for SITL, where they differ from the firmware's
        "ATC_SPEED_P": 0.1,
        "ATC_STR_RAT_FF": 0.75,
        "CRUISE_SPEED": 5.0,  # [m/s]
        "CRUISE_THROTTLE": 30,  # [%]
        "WP_SPEED": 5.0,  # [m/s]
        "WP_RADIUS": 3.0,  # [m]
        "MODE3": 11,  # RTL
        "MODE4": 10,  # AUTO
        "MODE5": 2,
        "RC1_MIN": 1000,
        "RC1_MAX": 2000,
        "RC3_MIN": 1000,
        "RC3_MAX": 2000,
        "SERVO1_MIN": 1000,
        "SERVO1_MAX": 2000,
        "SERVO3_MIN": 1000,
        "SERVO3_MAX": 2000,
        "BATT_MONITOR": 4,  # voltage and current
        "BATT_CAPACITY": 3300,  # [mAh]
        "BATT_LOW_VOLT": 0.0,  # no such failsafe
        "WP_PIVOT_ANGLE": 0,  # it steers by its front wheels
        "AHRS_OPTIONS": 3,
        "GPS1_DELAY_MS": 100,  # as gps_delay
    },
)
