# SPDX-License-Identifier: BSD-3-Clause
"""Turtlebot as the gym-gazebo paper's environments had it: Kobuki base, plates, a planar lidar on top. No autopilot.

Sources: [model] kobuki.urdf.xacro and kobuki_gazebo.urdf.xacro of erlerobot/gym-gazebo and turtlebot_description;
[guide] the Kobuki user guide.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from ..core.records import Record
from ..deprecation import renamed
from .airframe import Airframe
from .properties.property import described, properties


class Properties(Record):
    """What a Turtlebot is."""

    wheel_radius: float = described("m", "that the drive turns speeds into wheel rates with", 0.001, 1.0)
    wheel_radius_left: float = described("m", "true one", 0.001, 1.0)
    wheel_radius_right: float = described("m", "true one", 0.001, 1.0)
    wheel_separation: float = described("m", "between the wheels", 0.01, 10.0)
    wheel_speed_max: float = described("m/s", "greatest speed of a rim, forward and backward", 0.0, 100.0)
    command_timeout: float = described("s", "after which the wheels stand unless another command came", 0.0)
    radius: float = described("m", "of the cylinder that touches walls", 0.001, 10.0)
    bottom: float = described("m", "height of its underside above the floor", 0.0, 10.0)
    top: float = described("m", "height of its top above the floor", 0.0, 10.0)
    lidar_ahead: float = described("m", "lidar ahead of the axle", -1.0, 1.0, 0.0)
    lidar_height: float = described("m", "lidar above the floor", 0.0, 10.0)
    range_max: float = described("m", "greatest reading of the lidar; what is farther is inf", 0.001, 10000.0)
    range_noise: float = described("m", "standard deviation of a reading", 0.0, 10.0, 0.0)


@renamed("figures", "properties", since="0.2", removed_in="0.4")
@dataclass(frozen=True, kw_only=True)
class TurtlebotAirframe(Airframe):
    """A robot on two driven wheels with a planar lidar and no autopilot."""

    kind: ClassVar[str] = "turtlebot"
    known = properties(Properties)
    dtype = Properties.dtype


@dataclass(frozen=True)
class Lidar:
    """What the shape of a planar lidar's scan follows from; its ranges and noise are properties of the airframe."""

    rays: int
    """That are cast."""
    readings: int
    """That are published: weighted means of neighbouring rays, see ``sitl.worlds.planar``."""
    field_of_view: float
    """[rad], symmetric to straight ahead; the first and the last ray are its ends."""


LIDAR = Lidar(rays=40, readings=20, field_of_view=math.radians(270.0))
"""[model] 40 samples at a horizontal resolution of 0.5."""

AIRFRAME = TurtlebotAirframe(
    name="turtlebot",
    description="Turtlebot 2 (Kobuki) with a planar lidar, as the paper's environments have it",
    properties={
        "wheel_radius": 0.035,  # [model]
        "wheel_radius_left": 0.0352,  # [model] 0.6 % larger: a straight command drifts to the right
        "wheel_radius_right": 0.0350,  # [model]
        "wheel_separation": 0.230,  # [model]
        "wheel_speed_max": 0.7,  # [guide]; the model has no limit, the environments command 0.33 at most
        "command_timeout": 0.6,  # [model]
        "radius": 0.178,  # [model] base, the widest part
        "bottom": 0.0152,  # [model] 0.0597 - 0.10938 / 2 above base_link, which is 0.0102 above ground
        "top": 0.510,  # [model] lidar on top of the plates
        "lidar_height": 0.510,  # [model]
        "range_max": 20.0,  # [model]
        "range_noise": 0.0,  # [model]
    },
)
