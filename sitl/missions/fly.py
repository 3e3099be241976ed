# SPDX-License-Identifier: BSD-3-Clause
"""Flies one mission from power-on to its end."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from sitl.autopilot.mission.item import COMMANDS, MissionItem, home_item
from sitl.autopilot.mission.mission import Mission, MissionError
from sitl.autopilot.navigation.state import COMPLETE
from sitl.client import Text
from sitl.client.session import STEP_US
from sitl.core.elementary import hypot
from sitl.core.geodesy import offset_ne
from sitl.core.mavlink import MavCmd
from sitl.errors import OptionError
from sitl.simulation import Simulation

from .path import Deviation, PathWatch
from .station import Station, StationError

READY_S = 120.0
"""Time within which a vehicle must be ready to arm [simulated s]."""
LIMIT_S = 1800.0
"""Time limit of a flight unless another is given [simulated s since arming]."""
FARTHEST = 20_000.0
"""Greatest distance of a mission item from the vehicle's home: farther items were planned for another home [m]."""
STANDS, STANDING_S = 0.1, 1.0
"""A rover has arrived when it is slower than STANDS [m/s] for STANDING_S [s]."""
STOPPING_S = 30.0
"""Time that a rover may take to stop after its mission [simulated s]."""


class MissionRefused(OptionError):
    """A mission that this vehicle cannot fly; names the item."""


@dataclass
class Outcome:
    """Result of a mission. Times are simulated seconds since the start of the simulation."""

    completed: bool = False
    reason: str = ""
    """Reason why it was not completed, or a remark on its end."""
    ready: float = math.nan
    started: float = math.nan
    """Time at which AUTO started [s]."""
    ended: float = math.nan
    """Time of disarming, or of giving up [s]."""
    items: list[tuple[float, int]] = field(default_factory=list)
    """(time [s], number of the item) for each item reached."""
    distance: float = 0.0
    """Distance since the start of AUTO [m]."""
    energy: float = 0.0
    """Energy from the battery since the start of AUTO [Wh]."""
    top_speed: float = 0.0
    """Greatest ground speed [m/s]."""
    top_height: float = 0.0
    """Greatest height above home [m]."""
    deviation: Deviation = field(default_factory=Deviation)
    """Deviation from the straight lines of the mission."""
    hits: int = 0
    """Number of contacts with solids of the world."""
    texts: list[Text] = field(default_factory=list)

    @property
    def duration(self) -> float:
        """Time from the start of AUTO to the end [s]."""
        return self.ended - self.started


OnStep = Callable[[float, str], None]
"""Called with each step of the flight: (time [s], text)."""


def checked(mission: Mission, simulation: Simulation) -> Mission:
    """``mission`` as this vehicle's firmware takes it.

    Raises:
        MissionRefused: there is nothing to fly, an item that the firmware does not take, a position far away.
    """
    if not mission.present:
        raise MissionRefused("the mission has no items: nothing to fly")
    taken = simulation.firmware.commands.taken
    try:
        Mission.of(mission.items, taken)
    except MissionError as error:
        item = mission.items[error.seq] if error.seq < len(mission) else None
        if item is None or item.command in taken:
            raise MissionRefused(str(error)) from None
        known = ", ".join(f"{number} {COMMANDS[number].name}" for number in sorted(taken))
        raise MissionRefused(
            f"mission item {error.seq}: a {simulation.kind.name} does not fly command {item.command} {item.name}; "
            f"it flies {known}"
        ) from None
    lat, lon, _, _ = simulation.home
    for seq, item in enumerate(mission.items):
        if seq and COMMANDS[item.command].has_location and not item.no_location and ":" not in simulation.physics:
            away = hypot(*offset_ne(lat * 1e7, lon * 1e7, item.x, item.y))
            if away > FARTHEST:
                raise MissionRefused(
                    f"mission item {seq}: {away / 1000:.0f} km from home ({lat}, {lon}); it is within "
                    f"{FARTHEST / 1000:.0f} km, or the home is not the mission's"
                )
    return mission


def fly(
    simulation: Simulation,
    mission: Mission,
    *,
    fence: Sequence[MissionItem] = (),
    rally: Sequence[MissionItem] = (),
    limit_s: float = LIMIT_S,
    advance: Callable[[int], object] | None = None,
    on_step: OnStep = lambda time, text: None,
) -> Outcome:
    """Wait until the vehicle is ready, upload, arm, AUTO, until it is disarmed; a rover is disarmed where it arrives.

    Args:
        simulation: at power-on.
        mission: home first; home (0, 0) becomes the vehicle's.
        fence, rally: areas and rally points, as items; they are uploaded when there are some.
        limit_s: simulated time after which it is given up, since arming.
        advance: lets simulated time pass until a time [us]; None: as fast as it can.
        on_step: called with each step.

    Raises:
        MissionRefused: the vehicle cannot fly it.
    """
    flight = _Flight(simulation, checked(mission, simulation), limit_s, advance, on_step)
    flight.fence, flight.rally = fence, rally
    try:
        flight.run()
    except StationError as error:
        flight.outcome.reason = str(error)
    return flight.result()


class _Flight:
    """A flight in progress."""

    def __init__(
        self,
        simulation: Simulation,
        mission: Mission,
        limit_s: float,
        advance: Callable[[int], object] | None,
        on_step: OnStep,
    ) -> None:
        self.simulation, self.limit_s, self.on_step = simulation, limit_s, on_step
        lat, lon, alt, _ = simulation.home
        home = home_item(round(lat * 1e7), round(lon * 1e7), alt) if mission.items[0].no_location else mission.items[0]
        self.items = (home, *mission.items[1:])
        self.fence: Sequence[MissionItem] = ()
        self.rally: Sequence[MissionItem] = ()
        self.last = max((seq for seq, item in enumerate(self.items) if seq and item.is_nav), default=0)
        """Number of the last navigation command."""
        self.outcome = Outcome()
        self.station = Station(simulation, advance, self._look)
        self.watch: PathWatch | None = None
        self._seen = self._current = 0
        self._mode = ""
        self._is_complete = False

    def run(self) -> None:
        """Fly the mission; raises StationError when the vehicle refuses a step."""
        station, outcome = self.station, self.outcome
        station.wait_ready(READY_S)
        outcome.ready = station.now
        self.on_step(station.now, "ready to arm")
        if self.fence:
            station.upload_fence(self.fence)
        if self.rally:
            station.upload_rally_points(self.rally)
        station.transfer(self.items)
        self.on_step(station.now, f"mission of {len(self.items) - 1} items uploaded")
        station.set_mode("GUIDED")
        station.arm()
        self.on_step(station.now, "armed")
        self._wh = float(self.simulation.v.autopilot.battery.consumed_wh)
        outcome.started = station.now
        self.watch = PathWatch(self.simulation)
        station.start_mission()
        if not station.passes(self._is_over, self.limit_s):
            outcome.reason = f"not ended after {self.limit_s:g} s, at item {self._current} of {len(self.items) - 1}"
            return
        if station.armed and not self.simulation.kind.flies:
            self._stop_rover()
        self._judge()

    def _is_over(self) -> bool:
        """Disarmed, or the mission is complete and nothing more will come (a copter on the ground disarms)."""
        ap = self.simulation.v.autopilot
        stays = not self.simulation.kind.flies or int(ap.arming.landed) == 0
        self._is_complete = int(ap.modes.nav.mission_state) == COMPLETE
        return not self.station.armed or (self._is_complete and stays)

    def _stop_rover(self) -> None:
        """Wait until the rover stands, and disarm it."""
        self.on_step(self.station.now, "mission complete")
        stood: list[int] = [0]

        def stands() -> bool:
            vel = self.simulation.v.autopilot.estimate.vel
            stood[0] = stood[0] + 1 if hypot(float(vel[0]), float(vel[1])) < STANDS else 0
            return stood[0] * STEP_US >= STANDING_S * 1e6

        self.station.passes(stands, STOPPING_S)
        self.station.disarm()

    def _judge(self) -> None:
        """Decide whether the mission was completed."""
        outcome, station = self.outcome, self.station
        crash = next((text for _, _, text in station.texts if "Crash" in text), None)
        came_down = self._current == self.last and self.items[self.last].command in (
            MavCmd.NAV_LAND,
            MavCmd.NAV_RETURN_TO_LAUNCH,
        )
        at = f"at item {self._current} {self.items[self._current].name} of {len(self.items) - 1}"
        if crash is not None:
            outcome.reason = f"{crash} ({at})"
        elif self._is_complete or (came_down and self._mode == "AUTO"):
            outcome.completed = True
            if station.armed:
                outcome.reason = "ends in the air: the mission has no landing"
        elif self._mode != "AUTO":
            outcome.reason = f"left AUTO for {self._mode} {at}{station.why(outcome.started)}"
        else:
            outcome.reason = f"disarmed {at}{station.why(outcome.started)}"

    def _look(self) -> None:
        """Called ten times a second: collect data for the result."""
        if self.watch is None:
            return
        station, nav = self.station, self.simulation.v.autopilot.modes.nav
        if station.armed:
            self.watch.look()
            if station.mode != "GUIDED" and station.mode != self._mode:
                if self._mode:
                    self.on_step(station.now, f"mode {station.mode}{station.why(station.now - 2.0)}")
                self._mode = station.mode
            if int(nav.command_seq) and station.mode == "AUTO":
                self._current = int(nav.command_seq)
        for time, seq in station.telemetry.reached[self._seen :]:
            item = self.items[seq] if seq < len(self.items) else home_item(0, 0, 0.0)
            self.on_step(time, f"item {seq} of {len(self.items) - 1} {item.name} done")
        self._seen = len(station.telemetry.reached)

    def result(self) -> Outcome:
        """The result so far."""
        outcome, station, watch = self.outcome, self.station, self.watch
        outcome.ended, outcome.texts, outcome.items = station.now, station.texts, station.telemetry.reached
        if watch is not None:
            outcome.energy = float(self.simulation.v.autopilot.battery.consumed_wh) - self._wh
            outcome.distance, outcome.deviation = watch.distance, watch.deviation
            outcome.top_speed, outcome.top_height = watch.top_speed, watch.top_height
        outcome.hits = int(self.simulation.v.physics.obstacles.hit_count)
        self.on_step(station.now, "armed still" if station.armed else "disarmed")
        return outcome
