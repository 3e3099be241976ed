# SPDX-License-Identifier: BSD-3-Clause
"""Faults in flight, by MAVSDK 4's failure plugin."""

from mavsdk.plugins.failure import Failure, FailureType, FailureUnit
from mavsdk.plugins.param import Param
from sdk import Session, refused, wait

session = Session()
failure, parameters = Failure(session.system), Param(session.system)
refused("a fault before they are switched on", failure.inject, FailureUnit.SENSOR_GPS, FailureType.OFF, 0)
parameters.set_param_int("SYS_FAILURE_EN", 1)
session.take_off()
session.telemetry.set_rate_gps_info(2.0)
failure.inject(FailureUnit.SENSOR_GPS, FailureType.OFF, 0)
wait("no GPS", lambda: session.telemetry.gps_info().fix_type.name in ("NO_GPS", "NO_FIX"))
wait("LAND", lambda: session.telemetry.flight_mode().name == "LAND", 60.0)
failure.inject(FailureUnit.SENSOR_GPS, FailureType.OK, 0)
wait("GPS", lambda: session.telemetry.gps_info().fix_type.name in ("FIX_3D", "RTK_FIXED"))
refused("a type that is not there", failure.inject, FailureUnit.SENSOR_GPS, FailureType.SLOW, 0)
refused("a motor that is not there", failure.inject, FailureUnit.SYSTEM_MOTOR, FailureType.OFF, 99)
session.mavsdk.destroy()
