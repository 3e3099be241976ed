# SPDX-License-Identifier: BSD-3-Clause
"""The vehicle's MAVLink side: channels in, services in the middle, channels out.

All times are simulated microseconds.
"""

from __future__ import annotations

import math
import selectors
import struct
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from ..autopilot.params.table import BY_NAME as PARAMETERS_BY_NAME
from ..core.geodesy import offset_ne
from .autopilot_api import Autopilot, CopterAutopilot, Vector
from .channel import COMPONENT, Channel
from .dialect import MessageType, message
from .frame import Frame
from .links.link import Link, Peer
from .record_reader import RecordReader
from .services import ALL_SERVICES
from .services.command import FRAMES_AMSL
from .services.events import EventService
from .services.service import Sender, Service
from .services.streams import GROUPS, StreamService
from .stream_table import NEVER
from .telemetry import Context, build_all
from .vehicle import Vehicle

EPOCH_US = 1_767_225_600_000_000
"""Unix time at boot unless told otherwise: 2026-01-01 00:00:00 UTC [us]."""


class Tap(Protocol):
    """Sees every frame of every channel (a telemetry log)."""

    def frame(self, time_us: int, raw: bytes) -> None:
        """One frame, sent or received at ``time_us``."""
        ...


class Bridge:
    """Speaks MAVLink for one vehicle to any number of clients.

    The simulation calls ``receive`` whenever it wants clients to be heard, advances the core no further than
    ``next_due_us``, and then calls ``service``. Nothing here reads a wall clock: the same bytes at the same
    simulated times give the same bytes.
    """

    def __init__(
        self, vehicle: Vehicle, *, epoch_us: int = EPOCH_US, autopilot: Autopilot | None = None
    ) -> None:
        self.vehicle = vehicle
        self.epoch_us = epoch_us
        self.reader = RecordReader(vehicle.fleet, vehicle.index)
        self._given_autopilot = autopilot
        self.autopilot: Autopilot = autopilot if autopilot is not None else CopterAutopilot(vehicle)
        self._context = Context(self.reader, vehicle, epoch_us)
        self.telemetry = build_all(self._context)
        self.links: list[Link] = []
        self.channels: list[Channel] = []
        self.dropped: list[str] = []
        """Why channels were lost, for the command line to show."""
        self.taps: list[Tap] = []
        self.failed_builds = 0
        self._selector = selectors.DefaultSelector()
        self._sockets = 0
        self._numbers = 0
        self._system = self.reader.field("autopilot.params.MAV_SYSID")
        self._time_us = self.reader.field("time_us")
        self._match_clocks()
        self._parameters: dict[str, Callable[[], float]] = {}
        origin, home = "autopilot.estimate.origin_", "autopilot.home."
        self._origin = self.reader.fields(origin + "set", origin + "lat", origin + "lon", origin + "alt")
        self._heights = self.reader.fields(home + "is_set", home + "alt", origin + "alt")
        self._handlers: dict[int, tuple[MessageType, int, Callable[[Channel, Any, Sender], None]]] = {}
        self.services: dict[type, Service] = {}
        for kind in ALL_SERVICES:
            service = kind(self)
            self.services[kind] = service
            for name, handler in service.handlers().items():
                self._add_handler(name, handler)
        self._timed = [s for s in self.services.values() if type(s).service is not Service.service]

    def _add_handler(self, name: str, handler: Callable[[Channel, Any, Sender], None]) -> None:
        kind = message(name)
        if kind.id in self._handlers:
            raise ValueError(f"two services handle {name}")
        target = kind.fields.index("target_system") if "target_system" in kind.fields else -1
        self._handlers[kind.id] = (kind, target, handler)

    # ------------------------------------------------------------------ links

    @property
    def now_us(self) -> int:
        """Simulated time [us]."""
        return int(self._time_us())

    @property
    def elapsed_us(self) -> int:
        """Simulated time since the start of the simulation, which a reboot does not set back [us]; for logs."""
        return self.now_us + self._before_boot_us

    def _match_clocks(self) -> None:
        self._before_boot_us = self.vehicle.time_us - self.now_us
        self._context.epoch_us = self.epoch_us + self._before_boot_us

    @property
    def system(self) -> int:
        """Our system id (MAV_SYSID)."""
        return min(max(int(self._system()), 1), 255)

    def add_link(self, link: Link) -> None:
        """Open a way for clients to reach the vehicle."""
        self.links.append(link)
        link.attach(self._selector, self._add_channel)
        self._sockets = len(self._selector.get_map())

    def remove_link(self, link: Link) -> None:
        """Close a link and forget its clients."""
        link.close()
        self.links.remove(link)
        self._forget_closed()
        self._sockets = len(self._selector.get_map())

    def _add_channel(self, peer: Peer) -> None:
        channel = Channel(peer, self._numbers, self.system)
        self._numbers += 1
        self.channels.append(channel)
        for service in self.services.values():
            service.channel_added(channel)

    def _forget_closed(self) -> None:
        for channel in [c for c in self.channels if c.peer.closed]:
            self.channels.remove(channel)
            if channel.peer.why_closed:
                self.dropped.append(f"{channel.name}: {channel.peer.why_closed}")
            for service in self.services.values():
                service.channel_removed(channel)

    def close(self) -> None:
        """Flush and close everything."""
        self.flush()
        for link in list(self.links):
            self.remove_link(link)
        self._selector.close()

    # ------------------------------------------------------------------ in

    def stream_to(self, link: Link, rates_hz: Mapping[str, int]) -> None:
        """Send stream groups to every client of ``link``: {"EXTRA1": 10, ...}, names as in MAV1_EXTRA1.

        Raises:
            KeyError: there is no such group.
        """
        groups = {ending: number for number, (ending, _) in GROUPS.items()}
        for channel in self.channels:
            if channel.peer in link.peers:
                for name, rate in rates_hz.items():
                    self.get(StreamService).set_group(channel, groups[name], rate)

    def wait(self, seconds: float) -> bool:
        """Sleep until a socket has something to read, at most ``seconds`` of wall time. True when one has."""
        return bool(self._selector.select(seconds))

    def receive(self) -> int:
        """Read all links and act on every frame. Returns the number of frames acted on."""
        if self._sockets:
            for key, _ in self._selector.select(0):
                key.data()
        acted = 0
        for channel in self.channels:
            for frame in channel.receive():
                acted += self._dispatch(channel, frame)
        if acted or self._sockets:
            self.flush()
        return acted

    def _dispatch(self, channel: Channel, frame: Frame) -> int:
        if self.taps:
            for tap in self.taps:
                tap.frame(self.elapsed_us, frame.raw)
        entry = self._handlers.get(frame.kind.id)
        if entry is None or (frame.system == channel.system and frame.component == COMPONENT):
            return 0
        kind, target, handler = entry
        fields = kind.decode(frame.payload)
        if target >= 0 and fields[target] not in (0, channel.system):
            return 0
        handler(channel, fields, (frame.system, frame.component))
        return 1

    # ------------------------------------------------------------------ out

    def next_due_us(self) -> int:
        """Earliest simulated time at which something has to be sent."""
        due = NEVER
        for channel in self.channels:
            if channel.streams.next_us < due:
                due = channel.streams.next_us
        for service in self._timed:
            at = service.next_due_us()
            if at < due:
                due = at
        return due

    def service(self) -> None:
        """Send what has fallen due by now."""
        now = self.now_us
        for service in self._timed:
            if service.next_due_us() <= now:
                service.service(now)
        for channel in self.channels:
            if channel.streams.next_us <= now:
                due = channel.streams.take_due(now)
                if not channel.peer.congested:
                    for kind, build in due:
                        self._emit(channel, kind, build)
        self.flush()

    def _emit(self, channel: Channel, kind: MessageType, build: Callable[[], bytes]) -> bool:
        try:
            payload = build()
        except (
            OverflowError,
            ValueError,
            struct.error,
        ):  # a number that the wire cannot carry: leave this message out
            self.failed_builds += 1
            return False
        if payload:
            channel.send(kind, payload)
        return bool(payload)

    def send_now(self, channel: Channel, number: int) -> bool:
        """Send one telemetry message to one channel; False when it does not exist."""
        entry = self.telemetry.get(number)
        if entry is not None:
            self._emit(channel, *entry)
        return entry is not None

    def broadcast(self, kind: MessageType, payload: bytes) -> None:
        """Send to every channel."""
        for channel in self.channels:
            channel.send(kind, payload)

    def flush(self) -> None:
        """Hand everything queued to the links."""
        closed = False
        for channel in self.channels:
            peer = channel.peer
            if self.taps and peer.outbox:
                now = self.elapsed_us
                for tap in self.taps:
                    for raw in peer.outbox:
                        tap.frame(now, raw)
            peer.flush()
            closed = closed or peer.closed
        if closed:
            self._forget_closed()

    # ------------------------------------------------------------------ what services share

    def get(self, kind: type[Any]) -> Any:
        """The service of this class."""
        return self.services[kind]

    def parameter(self, name: str) -> float | None:
        """Present value of a parameter, None when the firmware has none of this name."""
        read = self._parameters.get(name)
        if read is None:
            if name not in PARAMETERS_BY_NAME:
                return None
            read = self._parameters[name] = self.reader.field(f"autopilot.params.{name}")
        return float(read())

    @property
    def ground_station(self) -> int:
        """System id of the pilot's ground station (MAV_GCS_SYSID)."""
        return int(self.parameter("MAV_GCS_SYSID") or 0)

    def home_alt(self) -> float:
        """Altitude that "relative" heights count from.

        Home's, or the origin's before home is set [m above sea level].
        """
        is_set, alt, origin_alt = self._heights()
        return float(alt if is_set else origin_alt)

    def place_ned(self, lat: int, lon: int, z: float, frame: int) -> Vector | None:
        """NED [m] from the origin of a place [degE7, m in a MAV_FRAME].

        None before there is an origin or off the globe.

        Terrain frames count from home: the ground is flat.
        """
        is_set, lat0, lon0, _ = self._origin()
        if not is_set or not (abs(lat) <= 900_000_000 and abs(lon) <= 1_800_000_000 and math.isfinite(z)):
            return None
        n, e = offset_ne(lat0, lon0, lat, lon)
        return self.over_origin(n, e, z if frame in FRAMES_AMSL else self.home_alt() + z)

    def over_origin(self, north: float, east: float, alt: float) -> Vector | None:
        """NED [m] of a point at ``alt`` [m above sea level]; None before there is an origin."""
        is_set, _, _, origin_alt = self._origin()
        return (north, east, origin_alt - alt) if is_set else None

    def say_pending(self) -> None:
        """Tell clients what the autopilot's laws gave back.

        (``Autopilot.take_notes``) and what the core emitted meanwhile.
        """
        events = self.services[EventService]
        assert isinstance(events, EventService)
        events.read()
        events.notes(self.autopilot.take_notes())

    def tell(self, notes: list[Any]) -> None:
        """Tell clients what the mission's sequencer gave back."""
        if notes:
            self.get(EventService).notes(notes)
            self.flush()

    def on_events(self) -> None:
        """Tell clients of all events that the core emitted since the last call."""
        self.get(EventService).read()
        self.flush()

    def clock_changed(self) -> None:
        """The record was put to another simulated time (a restore): what is regular goes on from there."""
        now = self.now_us
        self._match_clocks()
        for channel in self.channels:
            channel.streams.restart(now)
        for service in self.services.values():
            service.clock_changed(now)

    def successor(self) -> Bridge:
        """A bridge for the same vehicle after a reboot.

        Fresh services and streams, the same links and clients.
        """
        self.flush()
        new = Bridge(self.vehicle, epoch_us=self.epoch_us, autopilot=self._given_autopilot)
        new.taps = self.taps
        new.dropped = self.dropped
        new._selector.close()
        new._selector, new._sockets = self._selector, self._sockets
        new.links = self.links
        for link in new.links:
            link.reattach(new._add_channel)
        return new

    def refresh_identity(self) -> None:
        """Take over a changed MAV_SYSID."""
        for channel in self.channels:
            channel.system = self.system
