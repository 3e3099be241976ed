# SPDX-License-Identifier: BSD-3-Clause
"""Erle-Rover in its real size: the geometry of the paper's later model ("real dimensions"), with a weight to match.

Sources: [model] erlerobot/gym-gazebo, urdf/erlerover of 2016-11-21, which kept the 800 kg of the large one; [derived];
[estimate] this project's, where nothing was published or the model cannot be meant.
"""

from __future__ import annotations

import math

from ..core.constants import GRAVITY
from . import sensor_sets
from .properties.ground_vehicle import STEERING_FRONT_WHEELS
from .rover_airframe import RoverAirframe

MASS = 3.0  # [kg] a 1:10 car with Erle-Brain and lidar; the model's 882 kg cannot be meant [estimate]
WHEELBASE = 0.390444  # [m] axles at x = +0.240444 and -0.15 [model]
CENTRE = 0.0228  # [m] centre of mass ahead of base_link, a fifth of the large one's [derived]
REAR_AXLE = 0.15 + CENTRE  # [m]
SPEED = 5.0 * 0.0635  # [m/s] wheels of 0.0635 m turn at 5 rad/s at PWM 1900 [model]
TIME_CONSTANT = 0.2  # [s] [estimate]
ROLLING = 0.015  # [estimate]

AIRFRAME = RoverAirframe(
    name="erle_rover_small",
    description="Erle-Rover in its real size, 3 kg",
    properties={
        "mass": MASS,
        "inertia": (0.019, 0.083, 0.092),  # [kg m^2] the large one's by mass and size squared [derived]
        "control_full": 0.8,  # 1100 and 1900 us are the ends [model]
        "speed_max": SPEED + TIME_CONSTANT * ROLLING * GRAVITY,  # [m/s] so that it drives at SPEED under its load
        "time_constant": TIME_CONSTANT,
        "drive_accel": 2.5,  # [m/s^2] [estimate]
        "rolling_resistance": ROLLING,
        "efficiency": 0.6,  # [estimate]
        "grip": 1.0,  # rubber on hard ground; the model has 10 behind [estimate]
        "driven_load": 0.56,  # rear axle [derived]
        "steering_model": STEERING_FRONT_WHEELS,
        "rear_axle": REAR_AXLE,
        "wheelbase": WHEELBASE,
        "front_load": REAR_AXLE / WHEELBASE,
        "track": 0.30,  # [m] rear wheels, which drive [model]
        "steering_angle": 0.7727,  # [rad] both front wheels alike [model]
        "steering_rate": 7.5,  # [rad/s] a servo of 0.14 s for 60 degrees [estimate]
        "wheel_radius": 0.0635,  # [m] [model]
        "centre_height": 0.08,  # [m] a fifth of the large one's [estimate]
        "battery_voltage_full": 8.4,  # [V] two lithium-polymer cells [estimate]
        "battery_capacity": 5.0,  # [Ah] [estimate]
        "battery_resistance": 0.03,  # [ohm] [estimate]
        "avionics_current": 0.8,  # [A] Erle-Brain, receiver, lidar [estimate]
        "encoder_rate": 50.0,  # [Hz] [estimate]
        "encoder_step": 0.0004,  # [m] 1000 counts a turn of the wheel [estimate]
        "contact_discs": 3,  # a fifth of the large one's
        "contact_along": (0.1012, 0.0222, -0.0568),  # [m] [derived]
        "contact_radius": 0.18,  # [m] [derived]
        "contact_top": 0.45,  # [m] the lidar [derived]
        "base_along": -CENTRE,  # [m] base_link, which start poses mean
        "lidar_rays": 542,  # [model] 542 samples at a horizontal resolution of 0.5
        "lidar_samples": 271,  # [model]
        "lidar_fov": math.radians(270.0),  # [model]
        "lidar_min": 0.06,  # [m] [model]
        "lidar_max": 20.0,  # [m] [model]
        "lidar_rate": 10.0,  # [Hz] [model]
        "lidar_at": (-CENTRE, 0.0, -0.4),  # [m] [model]
        **sensor_sets.ERLE_BRAIN,
    },
    parameters={
        "EK3_MAG_CAL": 4,  # its compass is good: the filter learns what is left of its bias from the start
        "CRUISE_SPEED": 0.25,  # [m/s]
        "CRUISE_THROTTLE": 79,  # [%] for it: (0.25 + 0.029) / 0.347, of what MOT_THR_MIN leaves
        "MOT_THR_MIN": 8,  # [%] less does not overcome the rolling resistance
        "WP_SPEED": 0.25,  # [m/s]
        "WP_ACCEL": 0.1,  # [m/s^2] so that the steering gives the turns of its corners
        "WP_JERK": 0.2,  # [m/s^3]
        "WP_RADIUS": 0.5,  # [m]
        "TURN_RADIUS": 0.4,  # [m] wheelbase / tan(0.7727 rad) [derived]
        "MOT_SPD_SCA_BASE": 0.15,  # [m/s] steering shrinks above it; below it the loop does not learn
        "ATC_STR_RAT_FF": 3.1,  # wheelbase / 0.7727 rad / 0.15 m/s, and less for large angles
        "ATC_STR_RAT_P": 0.6,
        "ATC_STR_RAT_I": 1.0,
        "ATC_STR_RAT_MAX": 45.0,  # [deg/s]
        "ATC_TURN_MAX_G": 0.1,  # full steering at top speed gives 0.03
        # The firmware plans turns as if no slower than 1 m/s, a quarter of the turn rate that this one needs. Half
        # circles of 0.8 m at 0.25 m/s are held to 0.12 m (with the default of 1 it leaves them by a metre).
        "PSC_POS_P": 0.5,
        "PSC_VEL_P": 4.0,
        "ATC_STOP_SPEED": 0.03,  # [m/s]
        "ATC_SPEED_P": 1.0,
        "ATC_SPEED_I": 1.0,
        "BATT_MONITOR": 4,  # voltage and current
        "BATT_CAPACITY": 5000,  # [mAh]
        "BATT_LOW_VOLT": 6.8,  # [V] of two cells; ArduPilot's 10.5 V is three
        "GPS1_DELAY_MS": 120,  # as gps_delay
    },
)
