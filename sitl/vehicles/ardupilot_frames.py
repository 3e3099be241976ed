# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's other SITL multicopters (``ardupilot_quad`` describes their model), and vehicles on a bench."""

from __future__ import annotations

from dataclasses import replace

from . import ardupilot_quad, ardupilot_rover
from .airframe import Airframe
from .ardupilot_quad import multicopter
from .copter_airframe import CCW, CW


def _on_bench(airframe: Airframe, name: str) -> Airframe:
    """A vehicle that a bench turns, for calibrations (``sitl.physics.native.bench``)."""
    description = f"{airframe.description}, on a bench that turns it"
    return replace(airframe, name=name, description=description, properties={**airframe.properties, "on_bench": 1})


FRAMES: dict[str, Airframe] = {
    airframe.name: airframe
    for airframe in (
        _on_bench(ardupilot_quad.AIRFRAME, "calibration_copter"),
        _on_bench(ardupilot_rover.AIRFRAME, "calibration_rover"),
        multicopter("ardupilot_x", "SITL quad, X frame", ((45, CCW), (-135, CCW), (-45, CW), (135, CW)), 1, 1),
        multicopter(
            "ardupilot_hexa",
            "SITL hexacopter, plus frame",
            ((0, CW), (180, CCW), (-120, CW), (60, CCW), (-60, CCW), (120, CW)),
            2,
            0,
        ),
        multicopter(
            "ardupilot_hexa_x",
            "SITL hexacopter, X frame",
            ((90, CW), (-90, CCW), (-30, CW), (150, CCW), (30, CCW), (-150, CW)),
            2,
            1,
        ),
        multicopter(
            "ardupilot_octa",
            "SITL octocopter, plus frame",
            ((0, CW), (180, CW), (45, CCW), (135, CCW), (-45, CCW), (-135, CCW), (-90, CW), (90, CW)),
            3,
            0,
        ),
        multicopter(
            "ardupilot_octa_quad",
            "SITL octocopter of four pairs, X frame",
            ((45, CCW), (-45, CW), (-135, CCW), (135, CW), (-45, CCW), (45, CW), (135, CCW), (-135, CW)),
            4,
            1,
        ),
        multicopter(
            "ardupilot_y6",
            "SITL Y6: three pairs of rotors",
            ((60, CCW), (-60, CW), (-60, CCW), (180, CW), (60, CW), (180, CCW)),
            5,
            0,
        ),
    )
}
"""By name. See ``multicopter`` for the properties."""
