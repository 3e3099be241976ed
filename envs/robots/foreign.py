# SPDX-License-Identifier: BSD-3-Clause
"""A robot's options for an autopilot that is not ours, and how an episode of it begins."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from sitl import vehicles
from sitl.foreign.choice import PX4, Choice
from sitl.option_error import OptionError
from sitl.physics.engine import EngineError
from sitl.plants.alone import stand_alone
from sitl.vehicles import Airframe, AirframeError
from sitl.worlds import World

from ..mavlink.connection import Connection
from ..mavlink.foreign import Foreign, launch
from ..options import EnvOptionError
from .robot import Pose

INPROCESS = "inprocess"


def check(choice: Choice, options: Mapping[str, Any], count: int) -> None:
    """EnvOptionError for options that do not go with a foreign autopilot."""
    airframe = vehicles.load(options["frame"])
    if choice.kind == PX4 and airframe.kind != "copter":
        raise EnvOptionError(f"autopilot {choice.name} flies copters here; {airframe.name} is a {airframe.kind}")
    if options["connection"] != INPROCESS:
        raise EnvOptionError(f"autopilot {choice.name}: it needs no connection besides")
    if options["gcs"] is not None:
        raise EnvOptionError(f"autopilot {choice.name}: gcs is for our own autopilot in process")
    if choice.program is None and (count > 1 or options["params"]):
        raise EnvOptionError(f"autopilot {choice.name} is one vehicle as it is: no count or params")


def begin(
    choice: Choice,
    options: Mapping[str, Any],
    link: Connection | None,
    airframe: Airframe,
    world: World,
    pose: Pose,
    seed: int,
) -> Foreign:
    """A foreign autopilot that has just booted on physics at power-on.

    Args:
        choice: the autopilot.
        options: of the robot.
        link: of the episode before: closed, or rebooted when its program is not ours to start.
        airframe: with the figures of this episode.
        world: where.
        pose: that it stands at.
        seed: of the physics.

    Raises:
        EnvOptionError, LinkLostError, NotReadyError: it cannot be simulated, started or rebooted.
    """
    rebooted = link if isinstance(link, Foreign) and choice.program is None else None
    if link is not None and rebooted is None:
        link.close()
    try:
        plant = stand_alone(
            airframe, home=options["home"], backend=options["physics"], seed=seed, world=world,
            start=(*pose[:3], math.degrees(pose[3])),
        )  # fmt: skip
        if rebooted is not None:
            try:
                rebooted.restart(plant)
            except BaseException:
                rebooted.close()
                raise
            return rebooted
        readings = int(airframe.value("lidar_samples"))
        return launch(choice, plant, options["params"] or {}, readings, options["patience"])
    except (OptionError, AirframeError, EngineError) as error:
        raise EnvOptionError(str(error)) from None
