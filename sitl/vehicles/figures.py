# SPDX-License-Identifier: BSD-3-Clause
"""The figures that describe an airframe and its sensors, as a record: SI units, FRD body frame, origin at
the centre of mass.

They are part of every vehicle's record, so that each vehicle of a fleet may differ.
"""

from __future__ import annotations

from ..core.records import record

ROTORS_MAX = 8

THRUST_SPEED_SQUARED = 0
"""Thrust model: thrust = coefficient * speed^2 with first-order speed lag (RotorS)."""
THRUST_MOMENTUM = 1
"""Thrust model: momentum theory, outflow against inflow (ArduPilot's SITL multicopter)."""

FIGURES_DTYPE = record(
    # body
    ("mass", "f8"),  # [kg], rotors and battery included
    ("inertia", "f8", 3),  # about body x, y, z [kg m^2]
    ("drag_area", "f8", 3),  # drag coefficient times area along body x, y, z [m^2]
    ("angular_damping", "f8"),  # rotational air resistance, angular acceleration per rate [1/s]
    ("substeps", "i8"),  # integration steps a tick
    # rotors
    ("rotor_count", "i8"),
    ("rotor_x", "f8", ROTORS_MAX),  # hub positions in the body frame [m]
    ("rotor_y", "f8", ROTORS_MAX),
    ("rotor_z", "f8", ROTORS_MAX),
    ("rotor_direction", "f8", ROTORS_MAX),  # +1 counter-clockwise seen from above, -1 clockwise
    ("thrust_model", "i8"),  # THRUST_SPEED_SQUARED or THRUST_MOMENTUM
    ("control_min", "f8"),  # actuator control that gives command 0 ...
    ("control_max", "f8"),  # ... and command 1
    ("command_slew", "f8"),  # fastest change of command [1/s], 0 unlimited
    ("time_constant_up", "f8"),  # first-order lag of the rotor speed [s], 0 none
    ("time_constant_down", "f8"),
    # rotors, THRUST_SPEED_SQUARED
    ("speed_max", "f8"),  # at command 1 [rad/s]
    ("speed_voltage", "f8"),  # battery voltage below which top speed falls in proportion [V], 0 never
    ("thrust_coefficient", "f8"),  # [N/(rad/s)^2]
    ("moment_coefficient", "f8"),  # drag torque by thrust [m]
    ("rotor_drag", "f8"),  # in-plane drag, force by rotor speed and air speed [N/(rad/s)/(m/s)]
    ("rolling_moment", "f8"),  # torque by rotor speed and in-plane air speed [N m/(rad/s)/(m/s)]
    ("rotor_inertia", "f8"),  # of one rotor about its axis [kg m^2]
    ("efficiency", "f8"),  # rotor shaft power by battery power
    # rotors, THRUST_MOMENTUM
    ("outflow_area", "f8"),  # effective area of one rotor [m^2]
    ("outflow_speed_max", "f8"),  # at command 1 and full battery [m/s]
    ("thrust_expo", "f8"),  # outflow^2 goes with (1 - expo) c + expo c^2 of command c
    ("yaw_lever", "f8"),  # yaw torque by thrust and command [m]
    ("momentum_drag", "f8"),  # drag coefficient of a rotor's momentum flow, each axis
    ("disc_area", "f8"),  # true area of one rotor [m^2]
    ("power_by_thrust", "f8"),  # battery power by thrust [W/N]
    # battery
    ("battery_voltage_full", "f8"),  # open circuit, full [V]
    ("battery_capacity", "f8"),  # [Ah]; 0: an ideal source of battery_voltage_full
    ("battery_resistance", "f8"),  # [ohm]
    ("avionics_current", "f8"),  # drawn by everything but the motors [A]
    # ground contact
    ("ground_friction", "f8"),  # Coulomb coefficient
    ("leg_time_constant", "f8"),  # time in which the legs take up an impact or a lean [s]
    ("tip_angle", "f8"),  # touching with more lean than this tips it over [rad]
    ("hit_speed", "f8"),  # slowest touch that is reported [m/s]
    # sensors: all noise, biases and drifts are multiplied by noise_scale
    ("noise_scale", "f8"),
    ("acc_noise_density", "f8"),  # [m/s^2/sqrt(Hz)]
    ("acc_random_walk", "f8"),  # of the in-run bias [m/s^2/s/sqrt(Hz)]
    ("acc_bias_time", "f8"),  # correlation time of the in-run bias [s]
    ("acc_turn_on_bias", "f8"),  # standard deviation [m/s^2]
    ("acc_scale_error", "f8"),  # standard deviation, relative
    ("acc_range", "f8"),  # saturation [m/s^2]
    ("gyro_noise_density", "f8"),  # [rad/s/sqrt(Hz)]
    ("gyro_random_walk", "f8"),  # [rad/s/s/sqrt(Hz)]
    ("gyro_bias_time", "f8"),  # [s]
    ("gyro_turn_on_bias", "f8"),  # standard deviation [rad/s]
    ("gyro_scale_error", "f8"),
    ("gyro_range", "f8"),  # [rad/s]
    ("gps_rate", "f8"),  # [Hz]
    ("gps_delay", "f8"),  # from the fix to the reader [s]
    ("gps_start", "f8"),  # first message after boot [s]
    ("gps_fix_time", "f8"),  # first 3D fix after boot [s]
    ("gps_noise_horizontal", "f8"),  # white, standard deviation an axis [m]
    ("gps_noise_vertical", "f8"),
    ("gps_drift_horizontal", "f8"),  # correlated error, standard deviation an axis [m]
    ("gps_drift_vertical", "f8"),
    ("gps_drift_time", "f8"),  # its correlation time [s]
    ("gps_velocity_noise_horizontal", "f8"),  # white, standard deviation an axis [m/s]
    ("gps_velocity_noise_vertical", "f8"),
    ("gps_satellites", "f8"),
    ("gps_hdop", "f8"),
    ("gps_vdop", "f8"),
    ("baro_rate", "f8"),  # [Hz]
    ("baro_noise", "f8"),  # white, standard deviation [Pa]
    ("baro_drift", "f8"),  # correlated, standard deviation [Pa]
    ("baro_drift_time", "f8"),  # [s]
    ("mag_rate", "f8"),  # [Hz]
    ("mag_noise", "f8"),  # white, standard deviation an axis [gauss]
    ("mag_offset", "f8", 3),  # hard iron left after calibration, body [gauss]
)
