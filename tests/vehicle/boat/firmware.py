# SPDX-License-Identifier: BSD-3-Clause
"""The boat's autopilot: one mode, in which it goes ahead while it is armed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sitl.autopilot import state
from sitl.autopilot.firmware import Firmware
from sitl.autopilot.mission.item_runners import Commands
from sitl.autopilot.modes import Mode
from sitl.autopilot.navigation.planner import Planner
from sitl.autopilot.params import firmware_parameters
from sitl.autopilot.params.parameter import param
from sitl.autopilot.params.table import Table
from sitl.core.kernels import law

AHEAD = 0


class Parameters(firmware_parameters.Parameters):
    """The boat's parameters: those of all firmwares, and its own."""

    BOAT_THROTTLE: float = param(0.5, 0.0, 1.0, "", "Throttle while it is armed")


TABLE = Table(Parameters)


class Autopilot(state.Autopilot):
    """The boat's firmware."""

    params: Parameters


@law
def run(v: Any) -> None:
    """Ahead."""
    v.actuators.armed = v.autopilot.arming.armed
    v.actuators.controls[0] = v.autopilot.params.BOAT_THROTTLE if v.autopilot.arming.armed != 0 else 0.0


MODES = (Mode(number=AHEAD, name="AHEAD", run=run),)


@law
def update(fleet: Sequence[Any], index: int) -> None:
    """One tick, from sensors to actuators."""
    run(fleet[index])


class NoPlanner(Planner):
    """It follows no legs."""

    active_us = 0

    def limits(self, ap: Any, direction: Any) -> Any:
        raise NotImplementedError

    def stopping_point(self, ap: Any) -> Any:
        raise NotImplementedError

    def start(self, ap: Any, time_us: int) -> None:
        raise NotImplementedError


class NoMissions(Commands):
    """It runs no missions."""

    auto = -1
    taken = frozenset()
    planner = NoPlanner()

    def enter(self, v: Any) -> None: ...
    def reset(self, v: Any) -> None: ...
    def look_ahead(self, v: Any, item: Any, after: Any) -> None: ...
    def give(self, v: Any, seq: int, item: Any) -> Any:
        return []

    def finish(self, v: Any) -> Any:
        return []

    def change_speed(self, v: Any, kind: int, speed: float) -> bool:
        return False


def power_on(v: Any) -> None:
    """AHEAD is its only mode."""
    v.autopilot.modes.number = AHEAD


FIRMWARE = Firmware("boat", TABLE, {AHEAD: "AHEAD"}, power_on, NoMissions())
