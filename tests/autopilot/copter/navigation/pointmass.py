# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle without attitude: follows the position controllers' acceleration with a lag.

Missions fly it in plain Python.
"""

from __future__ import annotations

from typing import Any

from sitl.autopilot.copter.control import position
from sitl.autopilot.copter.mission import COMMANDS
from sitl.autopilot.copter.navigation import command
from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.sequencer import Sequencer
from sitl.autopilot.navigation.command import check_condition, complete
from sitl.autopilot.navigation.state import LAND, NONE, TAKEOFF
from sitl.core.constants import TICK_US
from sitl.core.vectors import Vec2
from sitl.vehicle.copter import Copter

ORIGIN = (-353632621, 1491652371, 584.0)
DT = TICK_US * 1e-6


class PointMass:
    """One vehicle in AUTO, at ``pos`` (NED)."""

    def __init__(
        self,
        mission: Mission,
        pos: tuple[float, float, float] = (0.0, 0.0, 0.0),
        lag: float = 0.25,
        follow: bool = True,
    ) -> None:
        self.fleet = Copter.fleet(1)
        self.v: Any = Copter.of(self.fleet, 0)
        self.lag = lag
        self.follow = follow
        """Fly by the controllers; else be on the target always."""
        self.stuck = False
        """Do not move at all."""
        self.acc = [0.0, 0.0, 0.0]
        self.begun = -1
        self.notes: list[tuple[float, Any]] = []
        ap = self.v.autopilot
        TABLE.set_defaults(ap.params)
        ap.estimate.origin_set = 1
        ap.estimate.origin_lat, ap.estimate.origin_lon, ap.estimate.origin_alt = ORIGIN
        ap.estimate.pos = pos
        ap.control.attitude.lean_max = 0.6
        ap.home.is_set = 1
        ap.home.lat, ap.home.lon, ap.home.alt = ORIGIN
        ap.modes.number = 3
        self.mission = mission
        self.sequencer = Sequencer(self, COMMANDS)

    @property
    def time(self) -> float:
        """Seconds since boot."""
        return int(self.v.time_us) * 1e-6

    def note(self, notes: list[Any]) -> None:
        """Keep what the sequencer said, with its time."""
        self.notes += [(self.time, n) for n in notes]

    def tick(self) -> None:
        """One control period: command, controllers, motion."""
        v = self.v
        ap = v.autopilot
        nav = ap.modes.nav
        v.time_us += TICK_US
        ap.control.tick += 1
        now = int(v.time_us)
        if self.begun != nav.command_count:
            self.begun = int(nav.command_count)
            command.begin(ap.modes.nav, ap.control, ap.estimate, ap.params, now)
        kind = int(nav.command_kind)
        if kind == TAKEOFF:
            self._jump_to(nav.target)
            complete(ap.modes.nav, ap.events, now)
        elif kind in (NONE, LAND):
            self.acc = [0.0, 0.0, 0.0]
        elif command.follows_path(kind):
            if command.run(nav, ap.control, ap.estimate, ap.params, now):
                complete(nav, ap.events, now)
            if self.follow and not self.stuck:
                position.update_ne(ap.control, ap.estimate, ap.params)
                self._move()
            elif not self.stuck:
                ap.estimate.pos, ap.estimate.vel = nav.pos, nav.vel
        check_condition(ap.modes.nav, ap.events, now, ap.estimate.pos, True)
        self.note(self.sequencer.attend())
        ap.events.attention = 0

    def _jump_to(self, target: Any) -> None:
        self.v.autopilot.estimate.pos = target
        self.v.autopilot.estimate.vel = (0.0, 0.0, 0.0)
        self.acc = [0.0, 0.0, 0.0]

    def _move(self) -> None:
        ap = self.v.autopilot
        nav, estimate = ap.modes.nav, ap.estimate
        wanted = [float(a) for a in ap.control.pos_ne.accel_target]
        # the vertical axis is followed as it is
        for k in range(2):
            self.acc[k] += (wanted[k] - self.acc[k]) * DT / (self.lag + DT)
        vel = Vec2(*estimate.vel[:2]) + Vec2(*self.acc[:2]) * DT
        pos = Vec2(*estimate.pos[:2]) + vel * DT
        estimate.vel, estimate.pos = (*vel, nav.vel[2]), (*pos, nav.pos[2])
