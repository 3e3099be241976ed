# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle at a connection, in another process or a real one: what may be done to it, and how it is left."""

from __future__ import annotations

import contextlib
import time
from typing import ClassVar

from gymnasium import logger

from sitl.client.connection import Connection, Lockstep, Remote, connect
from sitl.client.endpoint import AUTOPILOT
from sitl.core.algebra import quat_from_euler
from sitl.core.mavlink import MavAutopilot, MavFrame, MavResult, MavState, MavType
from sitl.core.sums import separation
from sitl.core.vectors import Euler
from sitl.errors import NotReadyError, OptionError
from sitl.vehicle.kinds import KINDS
from sitl.worlds.shapes import from_ned, to_ned

from ..mavlink import px4
from ..mavlink.endings import ENDINGS
from ..mavlink.guard import NOT_HANDED_OVER, Guard, Watch, append, guard_of, say
from ..mavlink.hand_over import HandOver
from ..mavlink.preparation import (
    AIRBORNE,
    BY_FORCE,
    NONE,
    RETURN,
    has_landed,
    height_above_home,
    join,
    reboot,
    refusal,
)
from ..mavlink.reports import LANDED
from ..mavlink.target_messages import ATTITUDE_ALONE, LOCAL, POSITION_ONLY, TARGET, VELOCITY_ONLY, YAWS_IGNORED
from ..options import EnvOptionError, unknown
from .robot import Pose
from .vehicles import EpisodeState, Vehicles, VehicleSetup

NEAR = 1.0
"""A vehicle that goes back is back at such a distance [m]."""
_SINKING = 0.3
"""Speed at which a copter on the ground is to sink until it knows that it has landed [m/s]."""
_SINKING_THRUST = 0.4
"""The same as the thrust of an attitude: 0.5 is no climb, 0 the greatest speed of sinking."""
_FALLS_SHORT, _FALLS_SHORT_MS, _GETS_GOING_MS = 0.1, 500, 1000
"""A vehicle that is to sink stands on the ground when it has not sunk so fast for so long, from the time on at which it
must be sinking at the latest [m/s, ms, ms]."""
_PAUSE_US, _PAUSES = 200_000, 5
"""Wall time from one such set-point to the next, much less than GUID_TIMEOUT at four times real time, too [us]; number
of them in a second."""
Origin = tuple[float, float, float]


def _meant(link: Connection) -> dict[str, int]:
    """The target of a message: the autopilot of this vehicle."""
    return {"target_system": link.system, "target_component": AUTOPILOT}


class SocketVehicles(Vehicles):
    """See ``Vehicles``; there is one vehicle."""

    simulates: ClassVar[bool] = False

    def __init__(self, setup: VehicleSetup) -> None:
        options = setup.options
        self._connection = options.connection
        self._is_px4 = setup.kind.guided == px4.OFFBOARD
        if self._is_px4 and options.reset not in (NONE, RETURN):
            raise EnvOptionError(
                f"reset {options.reset!r}: a PX4 at a connection is not rebooted; it is taken over where it flies with "
                f'reset="{NONE}" or "{RETURN}"'
            )
        if setup.count > 1 or options.gcs is not None or options.params:
            raise EnvOptionError(
                f"connection {self._connection!r} leads to one vehicle as it is: no count, gcs or params"
            )
        guard = guard_of(options.guard, False) or Guard()
        self._safe = self._mode_of(guard, setup)
        self._check_log(guard)
        super().__init__(setup)
        self._pose: Pose | None = None
        self._origin: Origin | None = None
        """Of the vehicle's local frame in the world, of one that was taken over in flight: NED [m]."""
        self._first = (0.0, 0.0, 0.0)
        """Where that was, in its local frame: NED [m]."""
        self._height = 0.0
        """How high that was above its home [m]."""
        self._received_ms = -1000
        self._is_put_down = self._is_warned = False
        self._sank_ms = 0
        """When the vehicle that is put down was last seen to sink [ms]."""
        self._may_sink_level: bool | None = None
        """Whether ``sink_level`` does what it says, once that is known."""

    @staticmethod
    def _mode_of(guard: Guard, setup: VehicleSetup) -> int:
        """Number of the mode that takes over.

        Raises:
            EnvOptionError: the vehicle has none of that name.
        """
        if setup.kind.guided == px4.OFFBOARD:
            names, usual = px4.MODES, "HOLD"
        else:
            names = {name: number for number, name in KINDS[setup.airframe.kind].firmware.mode_names.items()}
            usual = "BRAKE" if setup.kind.takes_off else "HOLD"
        wanted = guard.hand_over or usual
        if wanted not in names:
            raise unknown("guard: hand_over", wanted, names)
        return names[wanted]

    @staticmethod
    def _check_log(guard: Guard) -> None:
        if guard.log is not None:
            try:
                append(guard.log, "")
            except (OSError, ValueError) as error:
                why = getattr(error, "strerror", "") or error
                raise EnvOptionError(f"guard: log {str(guard.log)!r} cannot be written: {why}") from None

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
        self._pose, self._is_put_down = pose, False
        link, was_open = self.links[0], self.links[0] is not None
        if link is None:
            try:
                link = connect(self._connection, self.setup.inbox(), self.options.patience, warn=logger.warn)
            except OptionError as error:
                raise EnvOptionError(str(error)) from None
            link.inbox.scans_used = self.scans_used
            self.links[0] = link
            self._check_autopilot(link)
        elif self.watch is not None and self.watch.in_charge and link.inbox.mode == self.setup.kind.guided:
            self._stop(link)  # the last set-point would act on, for GUID_TIMEOUT
        if self.options.reset in (NONE, RETURN):
            origin = self._joined(link, pose)  # at once: a copter that has landed disarms after DISARM_DELAY
            if link.is_simulator:  # one that may be real stays so
                link.prove()
        else:
            if was_open:
                link.prove()
            if not link.is_simulator and self.options.reset != BY_FORCE:
                self.close()
                raise refusal(link)
            if guard_of(self.options.guard, link.is_simulator) is not None:
                self._owe()  # it takes off
            reboot(link)
            origin = self.prepare(link, pose)
            if isinstance(link, Lockstep):
                link.reseed(seed)
        self._guard(link, origin)
        if self.lets_down:
            self._sinks_level(link)
        return self.begun(0, origin)

    def _check_autopilot(self, link: Connection) -> None:
        """Refuse a PX4 where an ArduPilot is expected, and the other way round, before it is told to do anything."""
        if link.inbox.is_px4 == self._is_px4:
            return
        self.close()
        found, option = ("a PX4", "px4") if link.inbox.is_px4 else ("no PX4", "ardupilot")
        raise EnvOptionError(
            f'{self.where}: the vehicle is {found}: autopilot="{option}" (sitl deploy --autopilot {option})'
        )

    def _joined(self, link: Connection, pose: Pose) -> Origin:
        """Take over a vehicle that somebody else has brought up; its position at the first episode is the world's start
        pose. Returns its local origin in the world: north, east, down [m]."""
        kind, inbox, wait = self.setup.kind, link.inbox, self.options.wait
        if self._origin is not None and self.options.reset == RETURN:
            self._go_back(link)
        if self._is_px4:
            px4.join(link, wait)
        else:
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
        sinks_level = self._sinks_level(link)
        for _ in range(_PAUSES * max(round(self.options.wait), 1)):
            if not inbox.armed or inbox.mode != self.setup.kind.guided:
                return
            stands, down = has_landed(link), inbox.position[3]
            may_stand = stands or inbox.reports[LANDED] == 0.0  # some do not say
            if may_stand and link.command("NAV_TAKEOFF", altitude=self._height) == MavResult.ACCEPTED:
                if stands:
                    self._stands(down)
                if self.watch is not None:
                    self.watch.note(1e-3 * inbox.time_ms, "take-off", "it flies back")
                break
            if sinks_level:
                self.sink_level(link)
            else:
                self._stop(link, sinking=_SINKING)
            link.pause(_PAUSE_US)
        for _ in range(max(round(self.options.wait), 1)):
            if height_above_home(link) > self._height - NEAR:
                return
            link.pause(1_000_000)

    def _stop(self, link: Connection, sinking: float = 0.0) -> None:
        """Ask for no speed, in GUIDED, but ``sinking`` [m/s]."""
        mask = VELOCITY_ONLY | YAWS_IGNORED
        fields = {"coordinate_frame": MavFrame.LOCAL_NED, "type_mask": mask, "vx": 0, "vy": 0, "vz": sinking}
        link.endpoint.send_payload(LOCAL, LOCAL.payload(**_meant(link), **fields))

    def _stands(self, down: float) -> None:
        """The vehicle is on the floor and believes that it is at ``down`` [m]: its height, which drifts with the air
        pressure by decimetres in minutes, counts from there from now on."""
        if self._origin is None or self._pose is None:
            return
        floor = to_ned(*self._pose[:3])[2]
        self._origin = (*self._origin[:2], floor - down)
        self._first = (*self._first[:2], down - self._height)

    def _sinks_level(self, link: Connection) -> bool:
        """Whether thrust is a climb rate to the vehicle; where it is a thrust, ``sink_level`` would be a fall."""
        if self._is_px4:
            return False  # and it lands by asking for speed
        if self._may_sink_level is None:
            name, bit = self.setup.kind.parameters["thrust"]
            self._may_sink_level = not int(link.parameter(name) or 0) & bit
        return self._may_sink_level

    def puts_down(self, height: float) -> bool:
        """Whether the vehicle, at this height above the floor [m], is put down from now on instead of flown."""
        link = self.links[0]
        assert link is not None
        if not self._is_put_down and height < self.lets_down and (self._may_sink_level or self._is_px4):
            self._is_put_down, self._sank_ms = True, link.inbox.time_ms + _GETS_GOING_MS
            if self.watch is not None:
                self.watch.note(1e-3 * link.inbox.time_ms, "put down", f"at a height of {height:.2f} m")
        return self._is_put_down

    def put_down(self, link: Connection) -> None:
        """Ask for sinking on the spot, and from the ground on for ``sink_level``.

        A level vehicle keeps the speed that it has, and the wind takes it along: it would drift off its pad.
        """
        inbox = link.inbox
        if inbox.position[6] > _FALLS_SHORT:
            self._sank_ms = max(self._sank_ms, inbox.time_ms)
        if self._is_px4 or inbox.time_ms < self._sank_ms + _FALLS_SHORT_MS:
            self._stop(link, sinking=_SINKING)
        else:
            self.sink_level(link)

    def sink_level(self, link: Connection) -> None:
        """Ask for no lean and for sinking, in GUIDED.

        An autopilot that is asked for velocities on the ground cannot have them, and its integrators ask for ever more
        lean. With that it does not know that it has landed (more than 15 degrees speak for flight), refuses to take
        off, and after some seconds thinks that it has crashed.
        """
        inbox = link.inbox
        level = quat_from_euler(Euler(0.0, 0.0, inbox.attitude[3]))
        fields = {"type_mask": ATTITUDE_ALONE, "q": level, "thrust": _SINKING_THRUST}
        link.endpoint.send_payload(TARGET, TARGET.payload(**_meant(link), **fields))

    def _go_back(self, link: Connection) -> None:
        """In GUIDED, if the vehicle still is; of one that is not, or is disarmed, ``join`` says so."""
        inbox = link.inbox
        if not inbox.armed or inbox.mode != self.setup.kind.guided:
            return
        if self.setup.kind.takes_off and not self._is_px4 and (has_landed(link) or height_above_home(link) < AIRBORNE):
            self._lift_off(link)
        x, y, z = position = self._first
        mask = POSITION_ONLY | YAWS_IGNORED
        pauses = _PAUSES if self._is_px4 else 1  # it leaves OFFBOARD without set-points
        for _ in range(pauses * max(round(self.options.wait), 1)):
            fields = {"coordinate_frame": MavFrame.LOCAL_NED, "type_mask": mask, "x": x, "y": y, "z": z}
            link.endpoint.send_payload(LOCAL, LOCAL.payload(**_meant(link), **fields))
            link.pause(1_000_000 // pauses)
            away = separation(inbox.position[1:4], position)
            if away < NEAR or not inbox.armed or inbox.mode != self.setup.kind.guided:
                return
        raise NotReadyError(f"{link.name}: the vehicle is still {away:.1f} m away from where the first episode began")

    def _guard(self, link: Connection, origin: Origin) -> None:
        """The agent is in charge from now on, within the guard's limits."""
        guard = guard_of(self.options.guard, link.is_simulator)
        if guard is None:
            return
        if self.watch is None:
            self.watch = Watch(guard, self.setup.kind.takes_off, time.monotonic)
        self._owe()
        north, east, down = link.inbox.position[1:4]
        self.watch.take_over(1e-3 * link.inbox.time_ms, from_ned(origin[0] + north, origin[1] + east, origin[2] + down))

    def taken(self) -> str:
        """Why the vehicle is not the agent's any more; "": it is. Once a second it hears that we are there."""
        link = self.links[0]
        assert link is not None
        inbox = link.inbox
        if inbox.time_ms - self._received_ms >= 1000:
            self._received_ms = inbox.time_ms
            link.endpoint.send(
                "HEARTBEAT",
                type=MavType.GCS,
                autopilot=MavAutopilot.INVALID,
                system_status=MavState.ACTIVE,
                mavlink_version=3,
            )
        if not inbox.armed:
            return "the vehicle is disarmed"
        if inbox.mode != self.setup.kind.guided:
            return f"the vehicle is in mode {inbox.mode}: its pilot or a failsafe has it"
        return ""

    def _owe(self) -> None:
        """From now on the vehicle is to be handed over, however this process ends."""
        if not ENDINGS.owe(self, self.close) and not self._is_warned:
            self._is_warned = True
            say(
                f"the vehicle at {self._connection} is commanded from a thread that is not the main one, where no "
                "signal can be caught: SIGTERM, SIGHUP and others end this process without a hand-over"
            )

    def asked_to_end(self) -> str:
        """Why the agent must not go on: the process was told to end, and the agent has passed over it; "": it was
        not."""
        return f"the process was told to end ({ENDINGS.signal})" if ENDINGS.signal else ""

    def hand_over(self, why: str) -> None:
        """The vehicle goes into the guard's mode; the agent is not in charge any more.

        The vehicle first, then words: nothing is written before it has answered.
        """
        link, watch, deed = self.links[0], self.watch, None
        if link is None or not ENDINGS.owes(self):
            return
        assert isinstance(link, Remote)
        try:
            with ENDINGS.undisturbed():
                if not ENDINGS.owes(self):
                    return  # another thread was quicker
                knows = watch is not None and watch.in_charge
                if watch is not None:
                    watch.in_charge = False
                deed = HandOver(link, self._safe, self.setup.kind.guided, knows)
                deed.run()
                if ENDINGS.signal and ENDINGS.signal not in why:
                    why = f"{why} ({ENDINGS.signal})"
                ENDINGS.forget(self)
        finally:
            if deed is not None:
                with contextlib.suppress(Exception):
                    self._report(link, deed, why)

    def _report(self, link: Remote, deed: HandOver, why: str) -> None:
        """What became of a hand-over: into the guard's log, and aloud where the vehicle is not known to be safe."""
        watch = self.watch
        if watch is not None:
            watch.give_up(why)
        if not deed.is_done:
            stops = "in GUIDED it stops by itself after GUID_TIMEOUT"
            if self._is_px4:
                stops = "it leaves OFFBOARD by itself after COM_OF_LOSS_T, for what COM_OBL_RC_ACT says"
            say(
                f"NOT HANDED OVER: the vehicle at {link.name}: {deed.failure}. Take it over by radio or by a ground "
                f"station; {stops}. It was to be handed over because of: {why}"
            )
        if watch is not None:
            now = 1e-3 * link.inbox.time_ms
            if deed.is_done:
                watch.note(now, "handed over", why)
            else:
                watch.note(now, NOT_HANDED_OVER, f"{why}; {deed.failure}")

    def close(self) -> None:
        """Close the connection; a vehicle that the agent is in charge of goes into the guard's mode."""
        try:
            self.hand_over("closed")
        finally:
            super().close()

    def time_us(self, index: int) -> int:
        link = self.links[index]
        assert link is not None
        return link.time_us
