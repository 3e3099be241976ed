# SPDX-License-Identifier: BSD-3-Clause
"""Properties of sensors that airframes carry, unit and source on each line."""

from __future__ import annotations

ADIS16448: dict[str, float] = {
    # Noise of Analog Devices' ADIS16448 as in the Erle-Copter's simulation model (RotorS' values).
    "acc_noise_density": 0.004,  # [m/s^2/sqrt(Hz)] model
    "acc_random_walk": 0.006,  # [m/s^3/sqrt(Hz)] model
    "acc_bias_time": 300.0,  # [s] model
    "acc_turn_on_bias": 0.0196,  # [m/s^2] a tenth of the model's: what calibration leaves (assumed)
    "acc_scale_error": 0.001,  # [1] left by accelerometer calibration (assumed; ArduPilot's SITL has 0.001)
    "acc_range": 176.0,  # [m/s^2] 18 g, data sheet
    "gyro_noise_density": 3.394e-4,  # [rad/s/sqrt(Hz)] model
    "gyro_random_walk": 3.8785e-5,  # [rad/s^2/sqrt(Hz)] model
    "gyro_bias_time": 1000.0,  # [s] model
    "gyro_turn_on_bias": 0.0087,  # [rad/s] model
    "gyro_scale_error": 0.001,  # [1] (assumed)
    "gyro_range": 17.45,  # [rad/s] 1000 deg/s, data sheet
}

SITL_IMU: dict[str, float] = {
    # ArduPilot's simulated IMU with SIM_ACC1_RND and SIM_GYR1_RND at 0: what is left is about 1 bit of noise.
    "acc_noise_density": 2.9e-4,  # [m/s^2/sqrt(Hz)] uniform +-0.01 m/s^2: 0.0058 m/s^2 a sample at 400 Hz
    "acc_random_walk": 0.0,  # [m/s^3/sqrt(Hz)] none
    "acc_bias_time": 0.0,  # [s]
    "acc_turn_on_bias": 0.001,  # [m/s^2] INS_ACCOFFS of the recording's parameters
    "acc_scale_error": 0.001,  # [1] INS_ACCSCAL of the recording's parameters
    "acc_range": 156.9,  # [m/s^2] 16 g
    "gyro_noise_density": 2.0e-5,  # [rad/s/sqrt(Hz)] uniform +-0.04 deg/s: 0.0004 rad/s a sample at 400 Hz
    "gyro_random_walk": 0.0,  # [rad/s^2/sqrt(Hz)] none
    "gyro_bias_time": 0.0,  # [s]
    "gyro_drift_speed": 1.4544e-5,  # [rad/s^2] SIM_DRIFT_SPEED 0.05 deg/s a minute
    "gyro_drift_time": 300.0,  # [s] SIM_DRIFT_TIME 5 minutes
    "gyro_turn_on_bias": 0.0,  # [rad/s]
    "gyro_range": 34.9,  # [rad/s] 2000 deg/s
}

UBLOX_M8: dict[str, float] = {
    # A single-frequency receiver in the open. Values are this project's estimates where no source is given.
    "gps_rate": 5.0,  # [Hz] usual setting with ArduPilot (GPS1_RATE_MS 200)
    "gps_delay": 0.12,  # [s] ArduPilot's value for u-blox M8 receivers
    "gps_start": 2.0,  # [s] first message
    "gps_fix_time": 9.8,  # [s] ArduPilot SITL's recording: receiver detected 9.8 s after boot
    "gps_noise_horizontal": 0.10,  # [m] white, each axis
    "gps_noise_vertical": 0.20,  # [m]
    "gps_drift_horizontal": 0.40,  # [m] correlated, each axis, over minutes (estimate)
    "gps_drift_vertical": 0.70,  # [m]
    "gps_drift_time": 120.0,  # [s]
    "gps_velocity_noise_horizontal": 0.05,  # [m/s] (estimate)
    "gps_velocity_noise_vertical": 0.08,  # [m/s]
    "gps_satellites": 12,
    "gps_hdop": 0.8,
    "gps_vdop": 1.2,
}

SITL_GPS: dict[str, float] = {
    # ArduPilot's simulated receiver: no noise (SIM_GPS1_NOISE 0, SIM_GPS1_VERR 0), only the integers' steps.
    "gps_rate": 5.0,  # [Hz] SIM_GPS1_HZ
    "gps_delay": 0.1325,  # [s] SIM_GPS1_LAG_MS 100, and what comes on top: recorded positions are 33 ms late
    "gps_start": 2.0,  # [s] first message
    "gps_fix_time": 9.8,  # [s] recording: receiver detected 9.8 s after boot
    "gps_noise_horizontal": 0.0,  # [m]
    "gps_noise_vertical": 0.0,
    "gps_drift_horizontal": 0.0,
    "gps_drift_vertical": 0.0,
    "gps_drift_time": 0.0,
    "gps_velocity_noise_horizontal": 0.0,  # [m/s]
    "gps_velocity_noise_vertical": 0.0,
    "gps_satellites": 10,  # SIM_GPS1_NUMSATS
    "gps_hdop": 1.21,  # as ArduPilot's SITL reports (eph 121, epv 200)
    "gps_vdop": 2.0,
}

MS5611: dict[str, float] = {
    "baro_rate": 50.0,  # [Hz]
    "baro_noise": 1.5,  # [Pa] data sheet: 1.2 Pa RMS at the highest oversampling; 0.13 m
    "baro_drift": 3.0,  # [Pa] 0.25 m: weather, temperature and air flow (estimate)
    "baro_drift_time": 300.0,  # [s]
}

SITL_BARO: dict[str, float] = {
    "baro_rate": 50.0,  # [Hz]
    "baro_noise": 0.0,  # [Pa] SIM_BARO_RND 0 in the recording's parameters
    "baro_drift": 0.0,  # [Pa] SIM_BARO_DRIFT 0
    "baro_drift_time": 0.0,  # [s]
}

HMC5883: dict[str, float | tuple[float, float, float]] = {
    "mag_rate": 80.0,  # [Hz] 75 Hz in the data sheet, to the next whole number of ticks
    "mag_noise": 0.003,  # [gauss] data sheet: 2 mG noise floor; and motors (estimate)
    "mag_offset": (0.004, -0.003, 0.005),  # [gauss] left after compass calibration (estimate)
}

SITL_MAG: dict[str, float | tuple[float, float, float]] = {
    "mag_rate": 80.0,  # [Hz] near the usual 75 to 100 Hz
    "mag_noise": 0.0,  # [gauss] SIM_MAG_RND 0
    "mag_offset": (0.0, 0.0, 0.0),  # [gauss] SIM_MAG1_OFS is what the recording's COMPASS_OFS takes off
}

ERLE_BRAIN: dict[str, float | tuple[float, float, float]] = {**ADIS16448, **UBLOX_M8, **MS5611, **HMC5883}
"""IMU, receiver, barometer and compass of the airframes around an Erle-Brain."""
