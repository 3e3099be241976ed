# SPDX-License-Identifier: BSD-3-Clause
"""What tells a vehicle where it is: named sets of sensors, with their real errors, in place of an airframe's own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TypeVar

from ..errors import OptionError, did_you_mean
from . import sensor_sets
from .airframe import Airframe

A = TypeVar("A", bound=Airframe)
AS_IT_IS = "gps"


@dataclass(frozen=True)
class SensorSet:
    """Properties and parameters that stand over an airframe's."""

    description: str
    properties: Mapping[str, float | tuple[float, float, float]] = field(default_factory=dict)
    parameters: Mapping[str, float] = field(default_factory=dict)


RTK: dict[str, float] = {
    # u-blox ZED-F9P with a base station nearby, ambiguities fixed. u-blox's manual (UBX-18010802): 0.01 m + 1 ppm CEP;
    # data sheets of the F9 family say the same of the vertical median. That is 0.0085 m an axis and 0.015 m vertical,
    # here half of the variance white and half correlated (estimate). The rest is as of UBLOX_M8.
    "gps_noise_horizontal": 0.006,  # [m]
    "gps_noise_vertical": 0.0105,  # [m]
    "gps_drift_horizontal": 0.006,  # [m]
    "gps_drift_vertical": 0.0105,  # [m]
    "gps_drift_time": 60.0,  # [s] multipath (estimate)
    "gps_velocity_noise_horizontal": 0.05,  # [m/s] data sheets of the F9 family (50 % at 30 m/s)
    "gps_velocity_noise_vertical": 0.05,  # [m/s] (estimate)
    "gps_satellites": 20,
    "gps_hdop": 0.6,
    "gps_vdop": 0.9,
}
MOCAP: dict[str, float] = {
    # Cameras that track markers. Merriaux et al., "A Study of Vicon System Positioning Performance", Sensors 17 (2017)
    # 1591: below 2 mm while moving. They reach the autopilot as a receiver's fixes (GPS_INPUT), in steps of 1e-7 deg.
    "gps_rate": 20.0,  # [Hz] usual on a telemetry link
    "gps_delay": 0.05,  # [s] tracking, network and link (estimate)
    "gps_noise_horizontal": 0.002,  # [m]
    "gps_noise_vertical": 0.002,  # [m]
    "gps_drift_horizontal": 0.001,  # [m] calibration of the cameras (estimate)
    "gps_drift_vertical": 0.001,  # [m]
    "gps_drift_time": 300.0,  # [s]
    "gps_velocity_noise_horizontal": 0.02,  # [m/s] of differences of filtered positions (estimate)
    "gps_velocity_noise_vertical": 0.02,  # [m/s]
    "gps_satellites": 20,
    "gps_hdop": 0.6,
    "gps_vdop": 0.9,
}
UWB: dict[str, float] = {
    # Ultra-wideband beacons around the arena, as kits with two-way ranging give it in the line of sight. All properties
    # are this project's estimates. They reach the autopilot as a receiver's fixes; height stays the barometer's.
    "gps_rate": 10.0,  # [Hz]
    "gps_delay": 0.1,  # [s] ranging and solution (estimate)
    "gps_noise_horizontal": 0.05,  # [m] with the next: 0.10 m in the plane
    "gps_drift_horizontal": 0.05,  # [m] bias of ranges by position (estimate)
    "gps_drift_time": 30.0,  # [s] (estimate)
    "gps_velocity_noise_horizontal": 0.1,  # [m/s] of differences (estimate)
    "gps_velocity_noise_vertical": 0.1,  # [m/s] (estimate)
}

SETS: dict[str, SensorSet] = {
    AS_IT_IS: SensorSet("as the airframe has them"),
    "rtk": SensorSet("u-blox ZED-F9P with RTK, fixed: 1 cm", RTK, {"EK3_POSNE_M_NSE": 0.1, "EK3_SRC1_POSZ": 3}),
    "mocap": SensorSet(
        "motion capture: 2 mm, in steps of 1 cm",
        MOCAP,
        {"EK3_POSNE_M_NSE": 0.1, "EK3_SRC1_POSZ": 3, "EK3_VELNE_M_NSE": 0.15, "EK3_VELD_M_NSE": 0.15,
         "GPS1_DELAY_MS": 50},
    ),
    "uwb": SensorSet(
        "ultra-wideband beacons: 10 cm in the plane, height by barometer",
        UWB,
        {"EK3_POSNE_M_NSE": 0.3, "EK3_VELNE_M_NSE": 0.6, "EK3_VELD_M_NSE": 0.6, "GPS1_DELAY_MS": 100},
    ),
    "ardupilot": SensorSet(
        "as ArduPilot's own simulator with its noise at 0",
        {**sensor_sets.SITL_IMU, **sensor_sets.SITL_GPS, **sensor_sets.SITL_BARO, **sensor_sets.SITL_MAG,
         "gyro_scale_error": 0.0},
        {"GPS1_DELAY_MS": 100},
    ),
}  # fmt: skip
"""Name -> sensor set."""


def equipped(airframe: A, name: str) -> A:
    """An airframe with a sensor set in place of its own.

    Raises:
        OptionError: there is no such set, or the airframe has no receiver.
    """
    if not isinstance(name, str) or name not in SETS:
        raise OptionError(f"sensors {name!r} is not known; it is one of {', '.join(SETS)}{did_you_mean(name, SETS)}")
    if name == AS_IT_IS:
        return airframe
    if not airframe.has("gps_rate"):
        raise OptionError(f"sensors {name!r}: airframe {airframe.name!r} has no receiver")
    chosen = SETS[name]
    return replace(
        airframe,
        properties={**airframe.properties, **chosen.properties},
        parameters={**airframe.parameters, **chosen.parameters},
    )
