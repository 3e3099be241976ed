# SPDX-License-Identifier: BSD-3-Clause
"""The vehicle's MAVLink side: channels in, services in the middle, channels out.

All times are simulated microseconds.
"""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from ..autopilot.mission.item import MissionItem
from ..core.constants import NEVER
from ..core.mavlink import MavCmd, MavResult
from ..core.record_reader import RecordReader
from .autopilot_api import Autopilot, Vehicle
from .channel import Channel, ChannelState
from .core_link import CoreLink
from .dialect import MessageType, message, message_by_id
from .firmware_profile import load
from .frame import Frame
from .links.faults import LinkFaults
from .links.link import Link
from .listener import Listener
from .locations import Locations
from .log_store import LogStore
from .services import all_services
from .services.command import Entry
from .services.command_protocol import Grants
from .services.failure_injection import FaultService
from .services.fitted import CARRIED_OUT_BY, run_aux_function, switched
from .services.mission_protocol import MissionService
from .services.outputs import OutputService
from .services.parameter_protocol import ParameterService
from .services.senders import SenderService
from .services.service import Handler, Service
from .services.setpoint_messages import SetpointService
from .services.signing import SigningService
from .services.statustext import EventService
from .services.streams import StreamService
from .services.terrain_protocol import TerrainService
from .switchboard import Switchboard
from .telemetry.builder import shell_messages
from .wire import streams
from .wire.fleet import Slot
from .wire.link import REGULAR
from .wire.port import Port

_HEARTBEAT, _SETUP_SIGNING = message("HEARTBEAT").id, message("SETUP_SIGNING").id
EPOCH_US = 1_767_225_600_000_000
"""Unix time at boot by default: 2026-01-01 00:00:00 UTC [us]."""


_write_goal = struct.Struct("<qqq").pack_into
"""The first three numbers of a ``Slot``."""


class BridgeState(NamedTuple):
    """Everything that later bytes depend on and that is not in the vehicle's record. Immutable."""

    channels: tuple[ChannelState, ...]
    services: tuple[Any, ...]


class Bridge:
    """Speaks MAVLink for one vehicle to any number of clients.

    The simulation calls ``receive`` whenever bytes of clients are to be read. ``run`` advances the vehicle and sends
    what the core can send, ``service`` sends the rest. Nothing here reads a wall clock: the same bytes at the same
    simulated times give the same bytes.
    """

    def __init__(self, vehicle: Vehicle, *, epoch_us: int = EPOCH_US, autopilot: Autopilot | None = None) -> None:
        self.vehicle = vehicle
        self.epoch_us = epoch_us
        self.reader = RecordReader(vehicle.fleet, vehicle.index)
        self.profile = load(vehicle.firmware.name)
        self._given_autopilot = autopilot
        self.autopilot: Autopilot = autopilot if autopilot is not None else self.profile.autopilot(vehicle)
        self.core = CoreLink(vehicle, self.profile.core)
        slots = Slot.fleet(1)
        self._slot_memory: Any = slots.data
        self._slot, self._slots_address = Slot.of(slots, 0), slots.ctypes.data - vehicle.index * slots.itemsize
        self.shell_port = Port()
        """In place of a client's, for messages that the shell builds."""
        self.by_shell = shell_messages(vehicle, self.profile, self.shell_port)
        """Messages that the shell builds: number -> function that gives the payload."""
        self.telemetry = {number: message_by_id(number) for number in self.core.numbers | self.by_shell.keys()}
        """Every message that can be sent by its number."""
        self._left_out: set[str] = set()
        self._asked: list[tuple[Channel, int]] = []
        self.board = Switchboard(
            lambda: self.system, lambda: self.elapsed_us, self._channel_added, self._channel_removed
        )
        self.channels = self.board.channels
        self.taps = self.board.taps
        """Get every frame, in and out: ``taps.append(writer)``."""
        self.client_taps = self.board.client_taps
        """Get every frame that a client sent."""
        self._system = self.reader.field("autopilot.params.MAV.SYSID")
        self._time_us: Callable[[], int] = self.reader.field("time_us")
        self._event_count: Callable[[], int] = self.reader.field("autopilot.events.count")
        self._parameters: dict[str, Callable[[], float]] = {}
        self.listeners: list[Listener] = []
        """Are notified of texts and parameters: ``listeners.append(logger)``."""
        self.logs: LogStore | None = None
        """On-board logs that clients may download (``sitl.logs.dataflash``)."""
        self.grants: Grants | None = None
        """Set by who lets clients push the clock (``sitl.run.standstill``)."""
        self.is_stepped = False
        """Set by who steps the vehicle from this process, and wants messages of every tick (``sitl.envs``)."""
        self.locations = Locations(vehicle.v.autopilot, lambda lat, lon: self.get(TerrainService).rise(lat, lon))
        self._match_clocks()
        self._handlers: dict[int, tuple[int, Handler]] = {}
        """By message number: offset of the field target_system, -1 when there is none, and what is to be done."""
        self.services: dict[type, Service] = {}
        for kind in all_services():
            service = self.profile.set_points(self) if kind is SetpointService else kind(self)
            self.services[kind] = service
            for name, handler in service.handlers().items():
                self._add_handler(name, handler)
            for name, build in service.messages().items():
                self.by_shell[message(name).id] = build
                self.telemetry[message(name).id] = message(name)
        self._signing: SigningService = self.get(SigningService)
        self._senders: SenderService = self.get(SenderService)
        self.board.signer = self._signing
        self._timed = [s for s in self.services.values() if type(s).service is not Service.service]
        self._following = [
            s for s in self.services.values() if type(s).parameter_changed is not Service.parameter_changed
        ]
        self._stateful = [s for s in self.services.values() if type(s).snapshot is not Service.snapshot]

    def _add_handler(self, name: str, handler: Handler) -> None:
        kind = message(name)
        if kind.id in self._handlers:
            raise ValueError(f"two services handle {name}")
        if kind.id in self.core.taken:
            raise ValueError(f"a service handles {name}, which a law of the core takes")
        target = kind.fields.index("target_system") if "target_system" in kind.fields else -1
        self._handlers[kind.id] = (target, handler)

    # ------------------------------------------------------------------ time and identity

    @property
    def now_us(self) -> int:
        """Simulated time since the last boot [us]."""
        return self._time_us()

    @property
    def elapsed_us(self) -> int:
        """Simulated time since the start of the simulation [us]; a reboot does not set it back."""
        return self.now_us + self._before_boot_us

    def _match_clocks(self) -> None:
        self._before_boot_us = self.vehicle.time_us - self.now_us
        for port in (self.shell_port, *(channel.port for channel in self.channels)):
            port.epoch_us = self.epoch_us + self._before_boot_us

    @property
    def system(self) -> int:
        """Our system id (MAV_SYSID)."""
        return min(max(int(self._system()), 1), 255)

    @property
    def commands(self) -> Mapping[int, Entry]:
        """MAV_CMD -> how it is carried out."""
        return self.profile.commands

    @property
    def is_clock_pushed(self) -> bool:
        """Whether clients grant the vehicle its time (``push_clock``)."""
        return self.grants is not None

    def refresh_identity(self) -> None:
        """Take over a changed MAV_SYSID."""
        for channel in self.channels:
            channel.port.system = self.system

    def parameter(self, name: str) -> float | None:
        """Present value of a parameter, None when the firmware has none of this name."""
        read = self._parameters.get(name)
        if read is None:
            table = self.vehicle.firmware.table
            if name not in table:
                return None
            if not table[name].has_effect:
                return self.vehicle.parameters[name]
            read = self._parameters[name] = self.reader.field(f"autopilot.params.{table[name].path}")
        return float(read())

    # ------------------------------------------------------------------ links

    @property
    def received(self) -> int:
        """How often clients have said something, so far."""
        return self.board.received

    @property
    def links(self) -> Sequence[Link]:
        """Links on which clients may come."""
        return self.board.links

    def add_link(self, link: Link) -> None:
        """Open a link for clients to reach the vehicle."""
        self.board.add_link(link)

    def remove_link(self, link: Link) -> None:
        """Close a link and forget its clients."""
        self.board.remove_link(link)

    def set_link_faults(self, faults: LinkFaults | None, link: Link | None = None) -> None:
        """Faults of one link from now on, or of all, later ones too but for logs; None: none."""
        self.board.faults.set(faults, link)
        for channel in self.channels:
            self.board.faults.follow(channel, self.is_clock_pushed)
        self.board.faults.look(self.channels)

    @property
    def dropped(self) -> deque[str]:
        """Why channels were lost or refused and messages left out, for people."""
        return self.board.dropped

    def _channels_changed(self) -> None:
        self._slot.ports, self._slot.clients = self.board.ports.address, self.board.ports.count

    def _channel_added(self, channel: Channel) -> None:
        self._channels_changed()
        channel.port.epoch_us = self.epoch_us + self._before_boot_us
        if channel.peer.directions is None:  # else it has outlived a reboot
            self.board.faults.follow(channel, self.is_clock_pushed)
        self.board.faults.look(self.channels)
        for service in self.services.values():
            service.channel_added(channel)
        for link in self.board.links:
            if link.rates_hz and channel.peer in link.peers:
                self._stream(channel, link.rates_hz)

    def _channel_removed(self, channel: Channel) -> None:
        self._channels_changed()
        for service in self.services.values():
            service.channel_removed(channel)
        self.board.faults.look(self.channels)

    def stream_to(self, link: Link, rates_hz: Mapping[str, int]) -> None:
        """Send stream groups to each client of ``link``, later ones too and after a reboot, until it asks otherwise.

        {"EXTRA1": 10, ...} [Hz], names as in MAV1_EXTRA1.

        Raises:
            KeyError: there is no such group.
        """
        if self.board.journal is not None:
            self.board.journal.streams(link, rates_hz)
        link.rates_hz = dict(rates_hz)
        for channel in self.channels:
            if channel.peer in link.peers:
                self._stream(channel, rates_hz)

    def _stream(self, channel: Channel, rates_hz: Mapping[str, int]) -> None:
        groups = {ending: number for number, (ending, _) in self.profile.groups.items()}
        for name, rate in rates_hz.items():
            self.get(StreamService).set_group(channel, groups[name], rate)

    def close(self) -> None:
        """Flush and close everything."""
        self.board.close()
        if self.logs is not None:
            self.logs.close()

    # ------------------------------------------------------------------ in

    def wait(self, seconds: float) -> bool:
        """Sleep until a socket has something to read, at most ``seconds`` of wall time. True when one has."""
        return self.board.wait(seconds)

    def receive(self, resume: bool = False) -> None:
        """Read all links and act on every frame.

        Args:
            resume: the ports hold frames already, or have stopped at one.
        """
        board = self.board
        if board.has_sockets:
            board.read()
        journal = board.journal
        for channel in self.channels:
            data = channel.peer.take()
            if data:
                board.received += 1
                if channel.peer.directions is not None:
                    data = b"".join(channel.peer.directions.to_vehicle.carry_bytes(data, self.elapsed_us))
            if data or resume:
                self._receive(channel, data)
        if journal is not None:
            journal.acted()
        board.flush()

    def _receive(self, channel: Channel, data: bytes) -> None:
        """Act on bytes that have come from a client."""
        journal = self.board.journal
        if data and journal is not None:
            journal.received(channel, data)
        if data and self._signing.concerns(channel):
            data = self._signing.received(channel, data)
        if data and self._senders.is_on:
            data = self._senders.received(channel, data)
        self._handle(channel, data)

    def arrive(self) -> None:
        """Hear, and hand to clients, the frames that arrive now over links with faults."""
        board, now = self.board, self.elapsed_us
        for channel in self.channels:
            directions, peer = channel.peer.directions, channel.peer
            if directions is None or directions.due_us > now:
                continue
            # nothing else is queued: all that was due has been flushed
            peer.outbox += directions.to_client.arrived(now)
            peer.flush()
            data = b"".join(directions.to_vehicle.arrived(now))
            if data:
                self._receive(channel, data)
        if board.journal is not None:
            board.journal.acted()
            board.journal.attended()
        board.flush()
        board.faults.look(self.channels)

    def _handle(self, channel: Channel, data: bytes) -> None:
        """Act on bytes from a client; the core does so, and stops at each frame that is for the shell."""
        channel.port.stops_at_frames = bool(self.taps or self.client_taps)
        if channel.port.in_size:
            self._handle_port(channel)
        while data:
            data = channel.feed(data)
            self._handle_port(channel)

    def _handle_port(self, channel: Channel) -> None:
        """Act on what the port holds; it may have stopped at a frame already."""
        while True:
            if not channel.port.frame_end:
                events = self._event_count()
                self.core.receive(channel.address)
                if self._event_count() != events:  # the law of a message had something to say
                    self.get(EventService).read()
                if not channel.port.frame_end:
                    return
            frame = channel.frame()
            if frame.kind.id != _SETUP_SIGNING:  # a key is not for logs
                for tap in (*self.taps, *self.client_taps):
                    tap.frame(self.elapsed_us, frame.raw)
            taken, channel.port.frame_end = channel.port.frame_taken, 0
            if not taken:
                self._dispatch(channel, frame)

    def _dispatch(self, channel: Channel, frame: Frame) -> None:
        """Act on a frame that the core does not take; our own words and messages to other systems do not come here."""
        kind = frame.kind
        if kind.id in self._handlers:
            target, handler = self._handlers[kind.id]
            fields = kind.decode(frame.payload)
            if target < 0 or fields[target] in (0, channel.system):
                handler(channel, fields, (frame.system, frame.component))

    # ------------------------------------------------------------------ out

    def shell_due_us(self) -> int:
        """Earliest simulated time (since boot) at which a service has something to do."""
        due = NEVER
        for service in self._timed:
            if service.due_us < due:
                due = service.due_us
        return due

    def next_due_us(self) -> int:
        """Earliest simulated time (since boot) at which something has to be sent."""
        due = self.shell_due_us()
        for channel in self.channels:
            next_us = channel.port.next_us
            if next_us < due:
                due = next_us
        return due

    def is_behind(self, now_us: int) -> bool:
        """Whether a regular message that was due by ``now_us`` (since boot) has not been sent."""
        for channel in self.channels:  # noqa: SIM110 - each step of an environment comes here
            if channel.port.next_us <= now_us:
                return True
        return False

    def goes_by_itself(self) -> bool:
        """Whether the core may send for several times in one run: nobody looks at each frame at its time."""
        watched = self.board.is_watched()
        goes = not (watched or self._senders.is_on)
        for channel in self.channels:
            if not channel.peer.waits:
                goes = False
            if channel.spool is not None:
                channel.port.spool = 0 if watched else channel.spool_address
                channel.port.congested = channel.congested
        return goes

    def run(self, ranging: int, sampler: int, until_us: int, shell_us: int) -> None:
        """Advance the vehicle in the core to the first tick at or after ``until_us``; measure and send what falls due.

        Back early when something happened that the shell must know, and at ``shell_us``, before messages are sent.

        Args:
            ranging: address of what it needs to measure in a world (``sitl.physics.native.ranging``); 0: it is in none.
            sampler: address of what it logs with (``sitl.vehicle.sampler``); 0: the core logs nothing.
            until_us, shell_us: times since boot [us].
        """
        ports = self.board.ports
        self.core.run(ports.address, ports.count, ranging, sampler, until_us, shell_us)

    def go_on(self, ranging: int, until_us: int, events_seen: int) -> int:
        """Let the core hear clients and ``run``, in one call. It ``goes_by_itself``, and there are no sockets.

        Args:
            ranging: as for ``run``.
            until_us: time since boot [us].
            events_seen: events that the shell has acted on.

        Returns:
            What is left to the shell (``wire.fleet``): GOES_ON when the vehicle is there, and all has been sent.
        """
        channels = self.channels
        for channel in channels:
            data = channel.peer.take()
            if data and not channel.takes(data):
                for earlier in channels[: channels.index(channel)]:
                    self._handle(earlier, b"")
                self._handle(channel, data)
        _write_goal(self._slot_memory, 0, until_us, self.shell_due_us(), events_seen)
        self.core.run_all(self.vehicle.index + 1, self._slots_address, ranging)
        for channel in channels:
            if channel.port.out_count:
                channel.hand_over()
        return self._slot.needs_shell

    def service(self) -> None:
        """Send what has fallen due by now."""
        now = self.now_us
        for service in self._timed:
            if service.due_us <= now:
                service.service(now)
        for channel in self.channels:
            if channel.port.next_us <= now:
                self._send_due(channel, now)
        self.board.flush()

    def _send_due(self, channel: Channel, now: int) -> None:
        port = channel.port
        port.congested = channel.congested
        while True:
            self.core.transmit(channel.address, 1, REGULAR)
            if port.next_us > now:
                return
            if port.out_count:  # there was no more space, or it is the shell's turn
                channel.collect()
            number, by_shell = streams.first_due(port, now)
            if by_shell:
                self._build(channel, number)
                streams.put_off(port, number, now)

    def _build(self, channel: Channel, number: int) -> None:
        kind, port = self.telemetry[number], self.shell_port
        port.part = 0
        while True:
            try:
                payload = self.by_shell[number]()
            except (OverflowError, ValueError, struct.error):  # a number that the wire cannot carry: leave it out
                if kind.name not in self._left_out:
                    self._left_out.add(kind.name)
                    self.dropped.append(f"{kind.name} is left out: it cannot carry the vehicle's numbers")
                return
            if payload:
                channel.put(kind, payload)
            if port.part == 0:  # all parts of it are sent
                return

    def send_now(self, channel: Channel, number: int) -> bool:
        """Answer a client with one telemetry message, for logs too; False when there is none of this number."""
        for log in self.board.logs:
            if log is not channel:
                self._send_one(log, number)
        return self._send_one(channel, number)

    def send_to_all(self, number: int) -> None:
        """Send one telemetry message to every channel."""
        for channel in self.channels:
            self._send_one(channel, number)

    def _send_one(self, channel: Channel, number: int) -> bool:
        if number in self.by_shell:
            self._build(channel, number)
        elif number in self.core.numbers:
            while True:
                if channel.port.out_count:
                    channel.collect()
                self.core.transmit(channel.address, 1, number)
                if channel.port.part == 0:  # all parts of it are sent: many need the space several times
                    break
        return number in self.telemetry

    def send_after_answer(self, channel: Channel, number: int) -> int:
        """Send one telemetry message behind the answer to the command that asks for it, as ArduPilot does.

        Returns:
            The answer: ACCEPTED, or FAILED when there is no message of this number.
        """
        if number not in self.telemetry:
            return MavResult.FAILED
        self._asked.append((channel, number))
        return MavResult.ACCEPTED

    def send_asked(self) -> None:
        """The command has been answered."""
        while self._asked:
            self.send_now(*self._asked.pop(0))

    def broadcast(self, kind: MessageType, payload: bytes) -> None:
        """Send to every channel."""
        for channel in self.channels:
            channel.put(kind, payload)

    def flush(self) -> None:
        """Hand everything queued to the links."""
        self.board.flush()

    def beat(self) -> None:
        """While time stands: a HEARTBEAT to every client; logs do not depend on how long it stands."""
        for channel in self.channels:
            if not channel.peer.is_log:
                self._send_one(channel, _HEARTBEAT)
        if self.board.journal is not None:
            self.board.journal.beat()
        self.flush()

    def push_clock(self) -> Grants:
        """Let clients push the clock from now on."""
        self.grants = Grants()
        for channel in self.channels:
            if channel.peer.directions is not None:
                channel.peer.directions.hold(True)
        if self.board.journal is not None:
            self.board.journal.lockstep(True)
        return self.grants

    def free_clock(self) -> None:
        """Clients push the clock no more."""
        if self.grants is not None and self.board.journal is not None:
            self.board.journal.lockstep(False)
        self.grants = None

    # ------------------------------------------------------------------ what the autopilot says

    def get(self, kind: type[Any]) -> Any:
        """The service of this class."""
        return self.services[kind]

    def on_events(self) -> None:
        """Report to clients all events that the core emitted since the last call."""
        self.get(EventService).read()
        self.flush()

    def report(self, notes: list[Any]) -> None:
        """Report to clients what the mission's sequencer gave back."""
        if notes:
            self.get(EventService).notes(notes)
            self.flush()

    def carry_out(self, item: MissionItem) -> None:
        """Do what a mission asks of servo outputs, relays, camera, gimbal, payload and switches."""
        if item.command == MavCmd.DO_AUX_FUNCTION:
            run_aux_function(self, item)
            return
        self.get(CARRIED_OUT_BY.get(item.command, OutputService)).carry_out(item)

    def keep_parameters(self, names: Sequence[str]) -> None:
        """Parameters were changed by the firmware, for good."""
        for name in names:
            self.get(ParameterService).set(name, self.vehicle.v.autopilot.params[name])

    def parameter_changed(self, name: str) -> None:
        """A parameter was set: services follow."""
        for service in self._following:
            service.parameter_changed(name)

    def arming_changed(self) -> None:
        """The vehicle was armed or disarmed: services follow."""
        for service in self.services.values():
            service.arming_changed()

    def switched(self, function: int, position: int) -> None:
        """A switch of gimbal or payload was moved."""
        switched(self, function, position)

    def say_pending(self) -> None:
        """Report to clients what the core emitted and what the autopilot's laws gave back meanwhile."""
        self.get(EventService).read()
        self.get(EventService).notes(self.autopilot.take_notes())

    # ------------------------------------------------------------------ other times, other boots

    def snapshot(self) -> BridgeState:
        """What ``restore`` needs to send the same bytes again from here; links and clients are not in it."""
        channels = tuple([channel.snapshot() for channel in self.channels])
        return BridgeState(channels, tuple([service.snapshot() for service in self._stateful]))

    def restore(self, state: BridgeState) -> None:
        """Go on from a snapshot; the vehicle's record has been put back before.

        Channels that came since stay and keep what they asked for.
        """
        now = self.now_us
        self._match_clocks()
        self.autopilot.take_notes()
        known = {channel.number: channel for channel in state.channels}
        system = self.system
        for channel in self.channels:
            held = known.get(channel.number)
            if held is not None:
                channel.restore(held)
            else:
                streams.time_was_set(channel.port, now)
            channel.port.system = system
        self.board.faults.look(self.channels)
        for service, of_service in zip(self._stateful, state.services, strict=True):
            service.restore(of_service)

    def successor(self) -> Bridge:
        """A bridge for the same vehicle after a reboot.

        Fresh services and streams, the same links and clients.
        """
        self.flush()
        new = Bridge(self.vehicle, epoch_us=self.epoch_us, autopilot=self._given_autopilot)
        new.get(MissionService).follow(self.get(MissionService))
        new.get(SigningService).follow(self._signing)
        new.get(FaultService).follow(self.get(FaultService))
        new.get(TerrainService).follow(self.get(TerrainService))
        new.get(StreamService).follow(self.get(StreamService))
        new.board.take_over(self.board)
        new.taps, new.client_taps = new.board.taps, new.board.client_taps
        new.listeners, new.logs = self.listeners, self.logs
        new.grants = self.grants
        return new
