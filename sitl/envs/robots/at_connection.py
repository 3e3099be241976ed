# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle at a connection, in another process or a real one: what may be done to it, and how it is left."""

from __future__ import annotations

import atexit
import contextlib
import math
import time
from typing import ClassVar

from gymnasium import logger

from sitl.client.connection import ACCEPTED, Connection, Lockstep, connect
from sitl.errors import LinkLostError, NotReadyError, OptionError
from sitl.vehicle.kinds import KINDS
from sitl.worlds.shapes import from_ned, to_ned

from ..mavlink.guard import Guard, Watch, guard_of
from ..mavlink.preparation import (
    AIRBORNE,
    BY_FORCE,
    CUSTOM_MODE_ENABLED,
    NONE,
    RETURN,
    height_above_home,
    is_simulator,
    join,
    reboot,
    refusal,
)
from ..mavlink.setpoints import LOCAL, LOCAL_NED, PLACE_ONLY, VELOCITY_ONLY, YAWS_IGNORED
from ..options import EnvOptionError, unknown
from .robot import Pose
from .vehicles import EpisodeState, Vehicles, VehicleSetup

GCS, INVALID, ACTIVE = 6, 8, 4
"""MAV_TYPE, MAV_AUTOPILOT, MAV_STATE of the environment's heartbeat."""
NEAR = 1.0
"""A vehicle that goes back is back at such a distance [m]."""
_SINKING = 0.3
"""Speed at which a copter on the ground is to sink until it knows that it has landed [m/s]."""
Origin = tuple[float, float, float]


class SocketVehicles(Vehicles):
    """See ``Vehicles``; there is one vehicle."""

    simulates: ClassVar[bool] = False

    def __init__(self, setup: VehicleSetup) -> None:
        options = setup.options
        self._connection = options.connection
        if setup.count > 1 or options.gcs is not None or options.params:
            raise EnvOptionError(
                f"connection {self._connection!r} leads to one vehicle as it is: no count, gcs or params"
            )
        self._safe = self._mode_of(guard_of(options.guard, False) or Guard(), setup)
        super().__init__(setup)
        self._pose: Pose | None = None
        self._origin: Origin | None = None
        """Of the vehicle's local frame in the world, of one that was taken over in flight: NED [m]."""
        self._first = (0.0, 0.0, 0.0)
        """Where that was, in its local frame: NED [m]."""
        self._height = 0.0
        """How high that was above its home [m]."""
        self._heard_ms = -1000

    @staticmethod
    def _mode_of(guard: Guard, setup: VehicleSetup) -> int:
        """Number of the mode that takes over.

        Raises:
            EnvOptionError: the vehicle has none of that name.
        """
        names = {name: number for number, name in KINDS[setup.airframe.kind].firmware.mode_names.items()}
        wanted = guard.hand_over or ("BRAKE" if setup.kind.takes_off else "HOLD")
        if wanted not in names:
            raise unknown("guard: hand_over", wanted, names)
        return names[wanted]

    @property
    def where(self) -> str:
        return f"connection {self._connection!r}"

    def begin(self, index: int, pose: Pose, seed: int) -> EpisodeState:
        if self._pose not in (None, pose):
            name = self.setup.world.start(self.setup.airframe.name).name
            raise EnvOptionError(
                f"{self.where}: the vehicle starts where it was started: all episodes begin at one pose; "
                f"start={name!r} (sitl evaluate --option start={name}, which moves no starts)"
            )
        self._pose = pose
        link = self.links[0]
        if link is None:
            try:
                link = connect(self._connection, self.setup.inbox(), self.options.patience, warn=logger.warn)
            except OptionError as error:
                raise EnvOptionError(str(error)) from None
            link.inbox.scans_used = self.scans_used
            self.links[0] = link
        else:
            if self.watch is not None and self.watch.in_charge and link.inbox.mode == self.setup.kind.guided:
                self._stop(link)  # the last set-point would act on, for GUID_TIMEOUT
            link.is_simulator = is_simulator(link)
        if self.options.reset in (NONE, RETURN):
            origin = self._joined(link, pose)
        else:
            if not link.is_simulator and self.options.reset != BY_FORCE:
                self.close()
                raise refusal(link)
            reboot(link)
            origin = self.prepare(link, pose)
            if isinstance(link, Lockstep):
                link.reseed(seed)
        self._guard(link, origin)
        return self.begun(0, origin)

    def _joined(self, link: Connection, pose: Pose) -> Origin:
        """Take over a vehicle that somebody else has brought up; its place at the first episode is the world's start
        pose. Returns its local origin in the world: north, east, down [m]."""
        kind, inbox, wait = self.setup.kind, link.inbox, self.options.wait
        if self._origin is not None and self.options.reset == RETURN:
            self._go_back(link)
        join(link, kind.guided, kind.takes_off, wait)
        north, east, down = inbox.position[1:4]
        if self._origin is None:
            above = height_above_home(link) if kind.takes_off else 0.0
            x, y, floor = to_ned(*pose[:3])
            self._origin, self._first = (x - north, y - east, floor - above - down), (north, east, down)
            self._height = above
        return self._origin

    def _lift_off(self, link: Connection) -> None:
        """A copter that has landed and is still armed takes off. Before it knows that it has landed, it refuses: until
        then it is to sink."""
        inbox = link.inbox
        for _ in range(max(round(self.options.wait), 1)):
            if not inbox.armed or inbox.mode != self.setup.kind.guided:
                return
            if link.command("NAV_TAKEOFF", altitude=self._height) == ACCEPTED:
                if self.watch is not None:
                    self.watch.note(1e-3 * inbox.time_ms, "take-off", "it flies back")
                break
            self._stop(link, sinking=_SINKING)
            link.pause(1_000_000)
        for _ in range(max(round(self.options.wait), 1)):
            if height_above_home(link) > self._height - NEAR:
                return
            link.pause(1_000_000)

    def _stop(self, link: Connection, sinking: float = 0.0) -> None:
        """Ask for no speed, in GUIDED, but ``sinking`` [m/s]."""
        mask = VELOCITY_ONLY | YAWS_IGNORED
        fields = {"coordinate_frame": LOCAL_NED, "type_mask": mask, "vx": 0, "vy": 0, "vz": sinking}
        link.endpoint.send_payload(LOCAL, LOCAL.payload(target_system=link.inbox.system, **fields))

    def _go_back(self, link: Connection) -> None:
        """In GUIDED, if the vehicle still is."""
        inbox, place = link.inbox, self._first
        if not inbox.armed or inbox.mode != self.setup.kind.guided:
            return
        if self.setup.kind.takes_off and height_above_home(link) < AIRBORNE:
            self._lift_off(link)
        x, y, z = place
        mask = PLACE_ONLY | YAWS_IGNORED
        for _ in range(max(round(self.options.wait), 1)):
            fields = {"coordinate_frame": LOCAL_NED, "type_mask": mask, "x": x, "y": y, "z": z}
            link.endpoint.send_payload(LOCAL, LOCAL.payload(target_system=inbox.system, **fields))
            link.pause(1_000_000)
            away = math.dist(inbox.position[1:4], place)
            if away < NEAR or inbox.mode != self.setup.kind.guided:
                return
        raise NotReadyError(f"{link.name}: the vehicle is still {away:.1f} m away from where the first episode began")

    def _guard(self, link: Connection, origin: Origin) -> None:
        """The agent is in charge from now on, within the guard's limits."""
        guard = guard_of(self.options.guard, link.is_simulator)
        if guard is None:
            return
        if self.watch is None:
            self.watch = Watch(guard, self.setup.kind.takes_off, time.monotonic)
            atexit.register(self.close)
        north, east, down = link.inbox.position[1:4]
        self.watch.take_over(1e-3 * link.inbox.time_ms, from_ned(origin[0] + north, origin[1] + east, origin[2] + down))

    def taken(self) -> str:
        """Why the vehicle is not the agent's any more; "": it is. Once a second it hears that we are there."""
        link = self.links[0]
        assert link is not None
        inbox = link.inbox
        if inbox.time_ms - self._heard_ms >= 1000:
            self._heard_ms = inbox.time_ms
            link.endpoint.send("HEARTBEAT", type=GCS, autopilot=INVALID, system_status=ACTIVE, mavlink_version=3)
        if not inbox.armed:
            return "the vehicle is disarmed"
        if inbox.mode != self.setup.kind.guided:
            return f"the vehicle is in mode {inbox.mode}: its pilot or a failsafe has it"
        return ""

    def hand_over(self, why: str) -> None:
        """The vehicle goes into the guard's mode; the agent is not in charge any more."""
        link, watch = self.links[0], self.watch
        if link is None or watch is None or not watch.in_charge:
            return
        inbox = link.inbox
        watch.give_up(1e-3 * inbox.time_ms, why)
        if inbox.armed and inbox.mode == self.setup.kind.guided:
            with contextlib.suppress(LinkLostError):
                if link.command("DO_SET_MODE", CUSTOM_MODE_ENABLED, self._safe) != ACCEPTED:
                    watch.note(1e-3 * inbox.time_ms, "refused", f"mode {self._safe}; the vehicle stops by itself")

    def close(self) -> None:
        """Close the connection; a vehicle that the agent is in charge of goes into the guard's mode."""
        self.hand_over("closed")
        if self.watch is not None:
            atexit.unregister(self.close)
        super().close()

    def time_us(self, index: int) -> int:
        link = self.links[index]
        assert link is not None
        return link.time_us
