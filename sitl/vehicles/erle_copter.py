# SPDX-License-Identifier: BSD-3-Clause
"""Erle-Copter: the 1.1 kg quadrotor of Erle Robotics, X frame, as its Gazebo model describes it.

Sources: [model] erlerobot/gym-gazebo, urdf/erlecopter/erlecopter.xacro and erlecopter_base.xacro; [derived]
from those; [estimate] this project's, where nothing was published.
"""

from __future__ import annotations

import math

from . import sensor_sets
from .copter_airframe import CCW, CW, CopterAirframe, Rotor
from .properties.multicopter import THRUST_SPEED_SQUARED

REACH = 0.141  # [m] rotors from the centre along x and y [model]
ABOVE = -0.030  # [m] rotors 3 cm above the centre [model]

AIRFRAME = CopterAirframe(
    name="erle_copter",
    description="Erle-Copter, X frame, 1.14 kg",
    rotors=(
        Rotor(REACH, REACH, ABOVE, CCW),  # motor 1, front right [model]
        Rotor(-REACH, -REACH, ABOVE, CCW),  # motor 2, back left [model]
        Rotor(REACH, -REACH, ABOVE, CW),  # motor 3, front left [model]
        Rotor(-REACH, REACH, ABOVE, CW),  # motor 4, back right [model]
    ),
    properties={
        "mass": 1.14,  # [kg] 1.1 body, 4 x 0.005 rotors, 0.02 lidar and sonar [model, derived]
        "inertia": (0.0347563, 0.0458929, 0.0977),  # [kg m^2] [model]
        "drag_area": (0.015, 0.018, 0.030),  # [m^2] the 0.18 x 0.12 x 0.10 m box and the arms [estimate]
        "thrust_model": THRUST_SPEED_SQUARED,
        "control_max": 0.838,  # (PWM - 1000 us) is taken as rad/s: 1838 us gives top speed [derived]
        "time_constant_up": 0.0125,  # [s] [model]
        "time_constant_down": 0.025,  # [s] [model]
        "speed_max": 838.0,  # [rad/s] 6.00 N a rotor [model]
        "speed_voltage": 10.8,  # [V] three cells of 3.6 V still reach top speed [estimate]
        "thrust_coefficient": 8.54858e-6,  # [N/(rad/s)^2] [model]
        "moment_coefficient": 0.016,  # [m] [model]
        "rotor_drag": 8.06428e-5,  # [N/(rad/s)/(m/s)] [model]
        "rolling_moment": 1e-6,  # [N m/(rad/s)/(m/s)] [model]
        "rotor_inertia": 2.41e-5,  # [kg m^2] bar of 0.005 kg, 0.24 x 0.015 m [model, derived]
        "efficiency": 0.75,  # motor and controller [estimate]
        "battery_voltage_full": 12.6,  # [V] three lithium-polymer cells [estimate]
        "battery_capacity": 5.0,  # [Ah] [estimate]
        "battery_resistance": 0.02,  # [ohm] [estimate]
        "avionics_current": 0.8,  # [A] Erle-Brain, receiver, lidar [estimate]
        "ground_friction": 0.8,  # rubber feet [estimate]
        "leg_time_constant": 0.02,  # [s] [estimate]
        "tip_angle": math.radians(60.0),  # [rad] [estimate]
        "hit_speed": 0.1,  # [m/s]
        "contact_radius": 0.32,  # [m] to the tips of the rotors of 0.12 m [model]
        "contact_top": 0.17,  # [m] the lidar [derived]
        "lidar_rays": 140,  # [model] 140 samples at a horizontal resolution of 0.5
        "lidar_samples": 70,  # [model]
        "lidar_fov": math.radians(270.0),  # [model]
        "lidar_min": 0.01,  # [m] [model]
        "lidar_max": 10.0,  # [m] [model]
        "lidar_rate": 10.0,  # [Hz] [model]
        "lidar_at": (0.15, 0.0, -0.15),  # [m] [model]
        "rangefinder_min": 0.01,  # [m] the sonar [model]
        "rangefinder_max": 50.0,  # [m] [model]
        "rangefinder_rate": 10.0,  # [Hz] [model]
        "rangefinder_at": (0.12, 0.0, 0.0),  # [m] [model]
        **sensor_sets.ERLE_BRAIN,
    },
    parameters={
        "EK3_MAG_CAL": 4,  # its compass is good: the filter learns what is left of its bias from the start
        "FRAME_CLASS": 1,  # quad
        "FRAME_TYPE": 1,  # X
        "ANGLE_MAX": 3000,  # [cdeg] the airframe's own parameter file
        # Torque of a unit of command by inertia [rad/s^2]: roll 48.7, pitch 36.9, yaw 2.0; the quad 287,
        # 287, 12. Rate loops cross over near 30 rad/s in roll and pitch, where the rotors' lag costs 30 deg.
        "ATC_RAT_RLL_P": 0.60,
        "ATC_RAT_RLL_I": 0.60,
        "ATC_RAT_RLL_D": 0.018,
        "ATC_RAT_PIT_P": 0.80,
        "ATC_RAT_PIT_I": 0.80,
        "ATC_RAT_PIT_D": 0.024,
        "ATC_RAT_YAW_P": 4.0,  # crosses over at 8 rad/s
        "ATC_RAT_YAW_I": 0.4,
        "ATC_RAT_YAW_FLTE": 10.0,  # [Hz]
        "ATC_ANG_YAW_P": 4.5,
        # [cdeg/s^2] Yaw: two thirds of what the rotors can do at hover thrust. The more roll and pitch have over
        # it, the more a reversal of a full diagonal lean overshoots (the shaping trades one axis for another).
        "ATC_ACCEL_R_MAX": 30000.0,
        "ATC_ACCEL_P_MAX": 30000.0,
        "ATC_ACCEL_Y_MAX": 7000.0,
        "MOT_SPIN_MAX": 0.838,  # top speed at 1838 us
        "MOT_THST_EXPO": 0.7,  # thrust (0.15 + 0.688 x)^2 / 0.838^2 of output x
        "MOT_THST_HOVER": 0.45,  # thrust 11.2 N of 24.0 N through that curve
        "BATT_MONITOR": 4,  # voltage and current
        "BATT_CAPACITY": 5000,  # [mAh]
        "GPS1_DELAY_MS": 120,  # as gps_delay
    },
)
