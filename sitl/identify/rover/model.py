# SPDX-License-Identifier: BSD-3-Clause
"""A rover's properties as a fit moves them, and the airframe that they are."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ... import vehicles
from ...core.constants import GRAVITY
from ...vehicles import RoverAirframe
from ...vehicles.properties.ground_vehicle import STEERING_FRONT_WHEELS, STEERING_SKID, STEERING_TURNING_CIRCLE
from .courses import Courses, drive
from .stretches import Stretches

BASES = {True: "skid_rover", False: "erle_rover"}
"""Whether it skids -> the airframe that lends what no property shows."""
_NO_SLIP = 1000.0
_GYRATION = 0.2
"""Square of the radius of gyration about the vertical by that of the wheelbase, or of the track where the rover skids.

It counts only on slippery ground, where tyres turn the vehicle slowly. The package's airframes have 0.11 to 0.26.
"""

Array = np.ndarray[Any, Any]

DRIVE = ("speed", "back", "lag", "loss")
CAR = ("bend", "shape", "trim")
SKID = ("track", "differ")
LIMITS = ("weakness", "slip", "servo")
"""1 / greatest acceleration of the motors; 1 / grip; time of the servo from straight to full."""
LEAST = {"speed": 0.02, "back": 0.02, "lag": 0.0, "loss": 0.0, "bend": 1e-4, "shape": -2.2, "trim": -0.5}
LEAST |= {"track": 0.02, "differ": -0.5, "weakness": 0.0, "slip": 0.0, "servo": 0.0}
MOST = {"speed": 99.0, "back": 99.0, "lag": 20.0, "loss": 10.0, "bend": 50.0, "shape": 1.7, "trim": 0.5}
MOST |= {"track": 19.0, "differ": 0.5, "weakness": 50.0, "slip": 100.0, "servo": 2.0}


@dataclass(frozen=True)
class Model:
    """Properties by name; those that are missing are not in the model."""

    values: dict[str, float]
    skids: bool

    def value(self, name: str) -> float:
        """A property within what is possible; 0: not in the model."""
        return min(max(self.values.get(name, 0.0), LEAST[name]), MOST[name])

    @property
    def steering_angle(self) -> float:
        """Of the front wheels at full steering [rad], of which a curve has this shape."""
        return max(math.sqrt(abs(self.value("shape"))), 0.05, math.atan(0.0101 * self.value("bend")))

    @property
    def steering_model(self) -> int:
        """Front wheels turn more than in proportion (tangent), a turning circle less (sine)."""
        if self.skids:
            return STEERING_SKID
        return STEERING_FRONT_WHEELS if self.value("shape") >= 0.0 else STEERING_TURNING_CIRCLE

    @property
    def rolling_resistance(self) -> float:
        """By weight: what takes ``loss`` off the speed."""
        return self.value("loss") / GRAVITY / max(self.value("lag"), 1e-3)

    def properties(self) -> dict[str, float]:
        """Of the airframe whose outputs -1 .. 1 are its own."""
        slip = self.value("slip")
        found = {
            "speed_max": max(self.value("speed"), self.value("back")),
            "time_constant": self.value("lag"),
            "drive_accel": 1.0 / self.value("weakness") if self.value("weakness") > 0.0 else 0.0,
            "rolling_resistance": min(self.rolling_resistance, 1.0),
            "grip": 1.0 / slip if slip > 0.0 else _NO_SLIP,
            "steering_model": self.steering_model,
        }
        if self.skids:
            return found | {"track": self.value("track"), "track_slip": 1.0}
        angle, full = self.steering_angle, self.value("bend")
        servo = self.value("servo")
        return found | {
            "steering_angle": angle,
            "steering_rate": angle / servo if servo > 0.0 else 0.0,
            "wheelbase": min(max(math.tan(angle) / full, 0.01), 20.0),
            "turning_diameter": 2.0 / full,
        }

    def courses(self, data: Stretches, base: Array) -> Courses:
        """What it does under a log's outputs; all other properties are those of the record ``base``."""
        first, second = data.inputs()
        if self.skids:
            first, second = (1.0 + self.value("differ")) * first, (1.0 - self.value("differ")) * second
        else:
            first = np.clip(first - self.value("trim"), -1.0, 1.0)
        ahead, back = self.value("speed"), self.value("back")
        forth, aft = ahead / max(ahead, back), back / max(ahead, back)
        second = np.where(second < 0.0, aft, forth) * second
        if self.skids:
            first = np.where(first < 0.0, aft, forth) * first
        record = base.copy()
        properties = self.properties()
        for name, value in properties.items():
            record[name] = value
        across = properties["track"] if self.skids else properties["wheelbase"]
        record["inertia"][2] = _GYRATION * across * across  # of one kilogram
        return drive(record, first, second, data.start_speed, data.start_yaw_rate)


def base_of(skids: bool) -> Array:
    """The record of the airframe of all models: outputs -1 .. 1, one kilogram, whose work is its power."""
    found = vehicles.load(BASES[skids])
    assert isinstance(found, RoverAirframe)
    changes: dict[str, float | tuple[float, ...]] = {
        "mass": 1.0,
        "inertia": (1e-4, 1e-4, 1e-4),
        "control_full": 1.0,
        "efficiency": 1.0,
        "power_full": 0.0,
        "driven_load": 1.0,
        "rear_axle": 0.0,
    }
    return replace(found, properties={**found.properties, **changes}).record()
