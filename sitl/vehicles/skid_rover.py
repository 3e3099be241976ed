# SPDX-License-Identifier: BSD-3-Clause
"""A skid-steered rover: four wheels, each side driven as one, 17 kg. Of no maker; the size is that of a field robot
such as Clearpath's Jackal.

All values are this project's estimates; [like] from what is published of such robots.
"""

from __future__ import annotations

from . import sensor_sets
from .properties.ground_vehicle import STEERING_SKID
from .rover_airframe import RoverAirframe

AIRFRAME = RoverAirframe(
    name="skid_rover",
    description="Skid-steered rover, 17 kg, 2 m/s",
    properties={
        "mass": 17.0,  # [kg] [like]
        "inertia": (0.35, 0.45, 0.63),  # [kg m^2] a box of 0.51 x 0.43 x 0.25 m
        "control_full": 0.8,  # 1100 and 1900 us are the ends
        "speed_max": 2.1,  # [m/s] 2.0 under its load [like]
        "time_constant": 0.2,  # [s] geared motors
        "drive_accel": 5.0,  # [m/s^2] motors' torque limit: 85 N in all
        "rolling_resistance": 0.05,  # gears and soft tyres
        "efficiency": 0.6,
        "power_full": 15.0,  # [W] controllers
        "grip": 0.7,  # tyres on gravel
        "steering_model": STEERING_SKID,
        "track": 0.376,  # [m] [like]
        "track_slip": 1.5,  # wheels scrub: it turns as if the track were this much wider [like]
        "wheel_radius": 0.098,  # [m] [like]
        "centre_height": 0.11,  # [m]
        "battery_voltage_full": 29.4,  # [V] seven lithium-ion cells [like]
        "battery_capacity": 9.2,  # [Ah] 270 Wh [like]
        "battery_resistance": 0.1,  # [ohm]
        "avionics_current": 0.5,  # [A]
        "encoder_rate": 50.0,  # [Hz]
        "encoder_step": 0.0008,  # [m]
        "contact_discs": 2,
        "contact_along": (0.04, -0.04, 0.0),  # [m]
        "contact_radius": 0.22,  # [m]
        "contact_top": 0.25,  # [m]
        **sensor_sets.ERLE_BRAIN,
    },
    parameters={
        "EK3_MAG_CAL": 4,  # its compass is good: the filter learns what is left of its bias from the start
        "SERVO1_FUNCTION": 73,  # left motors
        "SERVO3_FUNCTION": 74,  # right motors
        "CRUISE_SPEED": 1.0,  # [m/s]
        "CRUISE_THROTTLE": 50,  # [%] for it: (1.0 + 0.1) / 2.1, of what MOT_THR_MIN leaves
        "MOT_THR_MIN": 4,  # [%] less does not overcome the rolling resistance
        "WP_SPEED": 1.0,  # [m/s]
        "WP_RADIUS": 1.0,  # [m]
        "TURN_RADIUS": 0.0,  # [m] turns on the spot
        # Full steering turns on the spot by 7.4 rad/s.
        "ATC_STR_RAT_FF": 0.135,
        "ATC_STR_RAT_P": 0.05,
        "ATC_STR_RAT_I": 0.1,
        "ATC_STR_RAT_MAX": 120.0,  # [deg/s]
        "PSC_POS_P": 0.5,  # half circles of 2 m at 1 m/s are held to 0.09 m
        "ATC_SPEED_P": 0.3,
        "ATC_SPEED_I": 0.3,
        "BATT_MONITOR": 4,  # voltage and current
        "BATT_CAPACITY": 9200,  # [mAh]
        "BATT_LOW_VOLT": 21.7,  # [V] 3.1 a cell
        "GPS1_DELAY_MS": 120,  # as gps_delay
    },
)
