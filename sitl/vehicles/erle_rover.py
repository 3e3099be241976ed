# SPDX-License-Identifier: BSD-3-Clause
"""Erle-Rover as the gym-gazebo paper's environments drove it: five times as large as the real one, 882 kg.

Sources: [model] erlerobot/gym-gazebo, urdf/erlerover/rover.urdf; [derived] from it; [estimate] this project's, where
nothing was published.
"""

from __future__ import annotations

import math

from ..core.constants import GRAVITY
from . import sensor_sets
from .properties.ground_vehicle import STEERING_FRONT_WHEELS
from .rover_airframe import RoverAirframe

MASS = 882.0  # [kg] chassis 800, wheels 4 x 20, steering blocks 2 x 1 [model]
WHEELBASE = 1.95222  # [m] axles at x = +1.20222 and -0.75 [model]
CENTRE = 0.114  # [m] centre of mass ahead of base_link, wheels included [derived]
REAR_AXLE = 0.75 + CENTRE  # [m]
SPEED = 5.0 * 0.3175  # [m/s] wheels of 0.3175 m turn at 5 rad/s at PWM 1900 [model]
TIME_CONSTANT = 0.3  # [s] the model's wheels take any speed at once; a drive of this weight does not [estimate]
ROLLING = 0.015  # tyres on hard ground [estimate]

AIRFRAME = RoverAirframe(
    name="erle_rover",
    description="Erle-Rover at five times its size, as the paper's environments have it, 882 kg",
    properties={
        "mass": MASS,
        # [kg m^2] chassis 140, 550, 550; about z also wheels and blocks at their axles [model, derived]
        "inertia": (200.0, 610.0, 677.0),
        "control_full": 0.8,  # 1100 and 1900 us are the ends [model]
        "speed_max": SPEED + TIME_CONSTANT * ROLLING * GRAVITY,  # [m/s] so that it drives at SPEED under its load
        "time_constant": TIME_CONSTANT,
        "drive_accel": 2.5,  # [m/s^2] 2.2 kN at the rims [estimate]
        "rolling_resistance": ROLLING,
        "efficiency": 0.7,  # motor, controller and gears [estimate]
        "grip": 1.0,  # [model]
        "driven_load": 0.56,  # rear axle [derived]
        "steering_model": STEERING_FRONT_WHEELS,
        "rear_axle": REAR_AXLE,
        "wheelbase": WHEELBASE,
        "front_load": REAR_AXLE / WHEELBASE,  # 0.44 [derived]
        "track": 1.50,  # [m] rear wheels, which drive [model]
        "steering_angle": 0.7727,  # [rad] both front wheels alike [model]
        "steering_rate": 7.5,  # [rad/s] a servo of 0.14 s for 60 degrees; the model's has no limit [estimate]
        "wheel_radius": 0.3175,  # [m] [model]
        "centre_height": 0.40,  # [m] [estimate]
        "battery_voltage_full": 50.4,  # [V] twelve lithium-polymer cells [estimate]
        "battery_capacity": 40.0,  # [Ah] [estimate]
        "battery_resistance": 0.02,  # [ohm] [estimate]
        "avionics_current": 0.8,  # [A] Erle-Brain, receiver, lidar [estimate]
        "encoder_rate": 50.0,  # [Hz] [estimate]
        "encoder_step": 0.002,  # [m] 1000 counts a turn of the wheel [estimate]
        "contact_discs": 3,
        "contact_along": (0.506, 0.111, -0.284),  # [m] from bumper to bumper 2.59 m, wheels included [derived]
        "contact_radius": 0.90,  # [m] 1.78 m over the rear wheels [derived]
        "contact_top": 0.85,  # [m] the lidar [derived]
        "base_along": -CENTRE,  # [m] base_link, which the world's start pose means
        "lidar_rays": 542,  # [model] 542 samples at a horizontal resolution of 0.5
        "lidar_samples": 271,  # [model]
        "lidar_fov": math.radians(270.0),  # [model]
        "lidar_min": 0.06,  # [m] [model]
        "lidar_max": 20.0,  # [m] [model]
        "lidar_rate": 10.0,  # [Hz] [model]
        "lidar_at": (0.5 - CENTRE, 0.0, -0.8),  # [m] [model]
        **sensor_sets.ERLE_BRAIN,
    },
    parameters={
        "EK3_MAG_CAL": 4,  # its compass is good: the filter learns what is left of its bias from the start
        "CRUISE_SPEED": 1.2,  # [m/s]
        "CRUISE_THROTTLE": 76,  # [%] for it: (1.2 + 0.044) / 1.632, of what MOT_THR_MIN leaves
        "MOT_THR_MIN": 3,  # [%] less does not overcome the rolling resistance
        "WP_SPEED": 1.2,  # [m/s]
        # A corner between two legs is cut along a parabola, at its tightest 1.2^2 / (2 sqrt(2) 0.5) = 1.0 m with
        # little speed left: with twice the acceleration it needs turns that no steering gives, and runs wide by 1.1 m.
        "WP_ACCEL": 0.5,  # [m/s^2]
        "WP_JERK": 1.0,  # [m/s^3]
        "WP_RADIUS": 2.0,  # [m] the airframe's own parameter file
        "TURN_RADIUS": 2.0,  # [m] wheelbase / tan(0.7727 rad) [derived]
        # Steering of one rad/s at speed v: wheelbase / 0.7727 rad / v, and less for large angles (a tangent). The
        # firmware multiplies it by MOT_SPD_SCA_BASE / v above that speed; below it the loop does not learn.
        "MOT_SPD_SCA_BASE": 0.5,  # [m/s]
        "ATC_STR_RAT_FF": 4.8,
        "ATC_STR_RAT_P": 0.6,
        "ATC_STR_RAT_I": 1.0,
        "ATC_STR_RAT_MAX": 45.0,  # [deg/s] what full steering gives at top speed
        "ATC_TURN_MAX_G": 0.1,  # full steering at 1.2 m/s gives 0.07, so that legs are planned with wide corners
        # The estimate is that of the IMU, 0.86 m ahead of the axle that follows the path. Driving backwards its motion
        # sideways feeds the turn: PSC_VEL_P times 0.86 m must stay well below the speed (at 1.5 it weaves).
        "PSC_POS_P": 0.4,
        "PSC_VEL_P": 1.0,
        "ATC_SPEED_P": 0.4,
        "ATC_SPEED_I": 0.4,
        "BATT_MONITOR": 4,  # voltage and current
        "BATT_CAPACITY": 40000,  # [mAh]
        "BATT_LOW_VOLT": 40.8,  # [V] 3.4 a cell; ArduPilot's 10.5 V is three cells
        "GPS1_DELAY_MS": 120,  # as gps_delay
    },
)
