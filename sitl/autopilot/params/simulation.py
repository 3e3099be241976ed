# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of the simulated surroundings."""

from __future__ import annotations

from typing import Any

from ...core.kernels import law
from ...core.vectors import Vec3
from .parameter import INT8, INT16, INT32, ParameterGroup, group, param


class Axes(ParameterGroup):
    """Three axes of the body."""

    X: float = param(0, -10000, 10000, "", "forward")
    Y: float = param(0, -10000, 10000, "", "right")
    Z: float = param(0, -10000, 10000, "", "down")


DELIVERED = Vec3(5.0, 13.0, -18.0)
"""Hard iron of the simulated compasses, and the offsets that vehicles are delivered with [mGauss]: ArduPilot's."""


@law
def axes(group: Axes) -> Vec3:
    """Three parameters as a vector."""
    return Vec3(group.X, group.Y, group.Z)


def hard_iron(label: str) -> Any:
    """Three axes of an offset of a compass, with ArduPilot's default."""
    rows = {
        k: {"default": value, "unit": "mGauss", "doc": f"{label}, {k}"}
        for k, value in zip("XYZ", (DELIVERED.x, DELIVERED.y, DELIVERED.z), strict=True)
    }
    return group(label, **rows)


_NOISE = "Noise of the {} while motors turn: its amplitude where the frame vibrates, ten standard deviations elsewhere"


class SimulatedCompass(ParameterGroup):
    """SIM_MAG1_, SIM_MAG2_, SIM_MAG3_: what is wrong with a compass."""

    OFS: Axes = hard_iron("What this compass shows too little")
    DIA: Axes = group("Soft iron: COMPASS_DIA that makes up for it; 0, 0, 0: there is none")
    ODI: Axes = group("Soft iron: COMPASS_ODI that makes up for it")
    FAIL: float = param(0, 0, 1, "", "1: it sends nothing", INT8)
    SCALING: float = param(1, 0, 10, "", "Share of the field that it shows")


class Receiver(ParameterGroup):
    """SIM_GPS1_, SIM_GPS2_: what is wrong with a GPS receiver."""

    ENABLE: float = param(1, 0, 1, "", "0 switches the GPS receiver off", INT8)
    LAG_MS: float = param(100, 0, 1000, "ms", "Age of a fix when it arrives; 100: the airframe's", INT16)
    TYPE: float = param(1, -128, 127, "", "0: there is no GPS receiver", INT8)
    BYTELOS: float = param(0, 0, 100, "%", "Bytes of the receiver that are lost; a fix takes 100")
    NUMSATS: float = param(10, 0, 127, "", "Satellites that are told; 10: the airframe's", INT8)
    GLTCH: Axes = group(
        X={"unit": "deg", "doc": "Added to the latitude", "low": -30, "high": 30},
        Y={"unit": "deg", "doc": "Added to the longitude", "low": -30, "high": 30},
        Z={"unit": "m", "doc": "Added to the altitude"},
    )
    DRFTALT: float = param(0, -10000, 10000, "m", "Altitude comes and goes by this in 314 s")
    NOISE: float = param(0, -10000, 10000, "m", "Altitude comes and goes by this in 12.6 s")
    ALT_OFS: float = param(0, -10000, 10000, "m", "Added to the altitude", INT16)
    VERR: Axes = group("Added to the velocity, north, east, down [m/s]")
    JAM: float = param(0, 0, 1, "", "1 jams the GPS receiver", INT8)


class Wcf(ParameterGroup):
    """SIM_BARO_WCF_: what air that comes from a side adds to the pressure."""

    FWD: float = param(
        0, -10, 10, "", "Share of the dynamic pressure that the barometer shows too much, in air from the front"
    )
    BAK: float = param(0, -10, 10, "", "The same, in air from behind")
    RGT: float = param(0, -10, 10, "", "The same, in air from the right")
    LFT: float = param(0, -10, 10, "", "The same, in air from the left")
    UP: float = param(0, -10, 10, "", "The same, in air from above")
    DN: float = param(0, -10, 10, "", "The same, in air from below")


class SecondBarometer(ParameterGroup):
    """SIM_BAR2_: what is wrong with a barometer."""

    RND: float = param(0.2, 0, 1000, "m", "Noise, standard deviation; 0.2: the airframe's, else it comes on top")
    DRIFT: float = param(0, -1000, 1000, "m/s", "Speed at which the height drifts away")
    DISABLE: float = param(0, 0, 1, "", "1: no more samples", INT8)
    GLITCH: float = param(0, -10000, 10000, "m", "Added to the height")
    FREEZE: float = param(0, 0, 1, "", "1: the same height for ever", INT8)
    DELAY: float = param(0, 0, 1000, "ms", "Age of a sample", INT16)
    WCF: Wcf


class Barometer(SecondBarometer):
    """SIM_BARO_: the same, and how many there are."""

    COUNT: float = param(
        2, -128, 127, "", "Barometers at power-on, two at most; below 1: none, and nothing starts", INT8
    )


class LandingBeacon(ParameterGroup):
    """SIM_PLD_: a beacon that sensors of precision landing see."""

    ENABLE: float = param(0, 0, 1, "", "1: the beacon is on", INT8)
    LAT: float = param(0, -90, 90, "deg", "Latitude of the beacon")
    LON: float = param(0, -180, 180, "deg", "Longitude of the beacon")
    HEIGHT: float = param(0, -100000, 100000, "m", "Height of the beacon over the position of power-on")
    RATE: float = param(100, 1, 400, "Hz", "Measurements a second", INT32)
    TYPE: float = param(
        0, 0, 2, "", "Where it is seen: 0 in a cylinder, 1 in a cone, 2 in half a sphere of radius DIST_LMT", INT8
    )
    ALT_LMT: float = param(15.0, 0.0, 100000, "m", "Length of cylinder and cone")
    DIST_LMT: float = param(10.0, 0.0, 100000, "m", "Radius of the cylinder, of the cone at its end, of the sphere")
    ORIENT: float = param(
        24, 0, 43, "", "Where it shines: 0 north, 1 north-east, ... 7 north-west, 24 up, 25 down", INT8
    )
    OPTIONS: float = param(0, 0, 1, "", "1: distances are measured, too, not directions alone", INT8)


class Simulated(ParameterGroup):
    """SIM_: wind, and what fails."""

    WIND_SPD: float = param(0, 0, 50, "m/s", "Speed of the steady wind")
    WIND_DIR: float = param(180, 0, 360, "deg", "Where the wind comes from")
    WIND_TURB: float = param(0, 0, 20, "m/s", "Turbulence, standard deviation of each axis")
    WIND_TC: float = param(5, 0.1, 300, "s", "Correlation time of the turbulence and lag of wind changes")
    WIND_DIR_Z: float = param(0, -90, 90, "deg", "How far the wind blows upwards")
    WIND_T: float = param(
        1,
        0,
        2,
        "",
        "Speed by height: 0 root of height / SIM_WIND_T_ALT below that, 1 the same, 2 linear",
        INT8,
    )
    WIND_T_ALT: float = param(60, 1, 10000, "m", "Height above home at which the wind has its full speed")
    WIND_T_COEF: float = param(0.01, -10, 10, "1/s", "SIM_WIND_T 2: gain of speed by height")
    ACC1_BIAS: Axes = group("What the accelerometer shows too much [m/s/s]")
    ACC1_SCAL: Axes = group("The accelerometer shows its share 1 / this of an acceleration; 0: all of it")
    ACC2_BIAS: Axes = group("What the second accelerometer shows too much [m/s/s]")
    ACC2_SCAL: Axes = group("The second accelerometer shows its share 1 / this of an acceleration; 0: all of it")
    ACC1_RND: float = param(0, 0, 1000, "m/s/s", _NOISE.format("accelerometer"))
    ACC2_RND: float = param(0, 0, 1000, "m/s/s", _NOISE.format("second accelerometer"))
    ACCEL1_FAIL: float = param(0, -1000, 1000, "m/s/s", "What all axes of the accelerometer show; 0: it works")
    ACCEL2_FAIL: float = param(0, -1000, 1000, "m/s/s", "What all axes of the second accelerometer show; 0: it works")
    ACC_FAIL_MSK: float = param(
        0, 0, 127, "", "Accelerometers that send nothing: bit 0 the first, bit 1 the second", INT8
    )
    ACC_TRIM: Axes = group("How far the accelerometer is turned in the vehicle: the AHRS_TRIM that it needs [rad]")
    GYR1_BIAS: Axes = group("What the gyro shows too much [rad/s]")
    GYR2_BIAS: Axes = group("What the second gyro shows too much [rad/s]")
    GYR1_SCALE: Axes = group("What the gyro shows too much [% of the rate]")
    GYR2_SCALE: Axes = group("What the second gyro shows too much [% of the rate]")
    GYR1_RND: float = param(0, 0, 1000, "deg/s", _NOISE.format("gyro"))
    GYR2_RND: float = param(0, 0, 1000, "deg/s", _NOISE.format("second gyro"))
    GYR_FAIL_MSK: float = param(0, 0, 127, "", "Gyros that send nothing: bit 0 the first, bit 1 the second", INT8)
    VIB_FREQ: Axes = group("Frequency at which the frame vibrates while motors turn; 0, 0, 0: not at all [Hz]")
    BARO: Barometer
    BAR2: SecondBarometer
    BATT_VOLTAGE: float = param(12.6, 0, 1000, "V", "Voltage of the full battery; 12.6: that of the airframe")
    BATT_CAP_AH: float = param(0, 0, 10000, "Ah", "Charge of the full battery; 0: the airframe's")
    BATT_RES: float = param(0, 0, 10, "Ohm", "Inner resistance of the battery besides the airframe's")
    GPS1: Receiver
    GPS2: Receiver = group(ENABLE=0)
    MAG1: SimulatedCompass
    MAG2: SimulatedCompass
    MAG3: SimulatedCompass
    MAG_MOT: Axes = group("Field of the motors' current at the compasses [mGauss/A]")
    MAG_RND: float = param(0, 0, 1000, "mGauss", "Noise of the compasses; its standard deviation is 0.3 of this")
    ENGINE_FAIL: float = param(0, 0, 255, "", "Outputs that fail: 1 the first, 2 the second, 4 the third, ...", INT32)
    ENGINE_MUL: float = param(0, 0, 1, "", "Share of their pulse beyond its rest that failing outputs keep")
    ENGINE_STUCK: float = param(0, 0, 255, "", "Outputs that stay as they are: 1 the first, 2 the second, ...", INT32)
    ENGINE_LAG: float = param(0, 0, 10, "s", "Time constant of all motors; 0: the airframe's")
    SONAR_GLITCH: float = param(0, -1000, 1000, "m", "Added to the reading of the range-finder")
    SONAR_RND: float = param(0, 0, 1000, "m", "Noise of the range-finder besides the airframe's")
    SONAR_LOSS: float = param(0, 0, 1, "", "Share of the range-finder's readings that see nothing")
    LIDAR_LOSS: float = param(0, 0, 1, "", "Share of the lidar's readings that see nothing")
    SPEEDUP: float = param(
        1, -1, 100000, "", "Simulated seconds a second; 0 or less: as fast as it goes (drop-in executables only)"
    )
    FLOW_ENABLE: float = param(0, 0, 1, "", "1: there is an optical flow sensor that looks down", INT8)
    FLOW_RATE: float = param(10, 1, 400, "Hz", "Samples of optical flow a second", INT16)
    FLOW_DELAY: float = param(0, 0, 127, "ms", "Age of a sample of optical flow when it arrives", INT8)
    FLOW_RND: float = param(0.05, 0, 10, "rad/s", "Noise of the optical flow, greatest")
    PLD: LandingBeacon
    RC_FAIL: float = param(0, 0, 2, "", "1 switches the transmitter off; 2: sticks centred, throttle 950 us", INT8)
    RC_STUCK: float = param(0, 0, 65535, "", "Channels that stay as they are: 1 the first, 2 the second, ...", INT32)
    RC_NOISE: float = param(0, 0, 1000, "us", "Noise of all channels, at most")
