# SPDX-License-Identifier: BSD-3-Clause
"""Commands of clients: COMMAND_LONG and COMMAND_INT, and grants of simulated time.

The command protocol: every command is answered by exactly one COMMAND_ACK (https://mavlink.io/en/services/command.html).

A repeated command (MAVSDK sends up to four times) is carried out and answered again, as ArduPilot does.

Lockstep over a link: time stands until a client grants it (COMMAND_INT 31010, MAV_CMD_USER_1).

A client sends what the vehicle is to hear, then a grant; the vehicle hears both at the same simulated instant, goes up
to the time granted, sends all telemetry that falls due on the way, and only then answers. Only ``sitl run --lockstep``
has grants; elsewhere the commands are UNSUPPORTED.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from ...core.mavlink import MavCmd, MavFrame, MavResult
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..links.link import Peer
from ..listener import Sender
from ..switchboard import Switchboard
from . import command_table
from .command import Command, Entry, from_int, from_long
from .service import Handler, Service

ACK = message("COMMAND_ACK")


class CommandHost(Host, Protocol):
    """The bridge, as commands know it."""

    board: Switchboard
    grants: Grants | None
    """How far clients let the vehicle go; None: they do not push its clock."""

    @property
    def commands(self) -> Mapping[int, Entry]:
        """MAV_CMD -> how it is carried out."""
        ...

    def send_asked(self) -> None:
        """The command has been answered: send what it asked for."""
        ...

    def flush(self) -> None:
        """Hand everything queued to the links."""
        ...


class CommandService(Service):
    """Commands, and the old way to set the mode."""

    bridge: CommandHost

    def __init__(self, bridge: CommandHost) -> None:
        super().__init__(bridge)
        self._table = bridge.commands

    def handlers(self) -> dict[str, Handler]:
        return {"COMMAND_LONG": self._long, "COMMAND_INT": self._int, "SET_MODE": self._set_mode}

    def _long(self, channel: Channel, fields: Any, sender: Sender) -> None:
        entry = self._table.get(fields.command)
        if entry is None or entry.int_only:
            self._answer(channel, fields, entry, MavResult.UNSUPPORTED, sender)
            return
        self._run(channel, entry, from_long(fields, entry), fields, sender)

    def _int(self, channel: Channel, fields: Any, sender: Sender) -> None:
        grants = self.bridge.grants
        if grants is not None and grants.command(self.bridge, channel, fields, sender):
            return
        entry = self._table.get(fields.command)
        if entry is None:
            self._answer(channel, fields, entry, MavResult.UNSUPPORTED, sender)
            return
        self._run(channel, entry, from_int(fields, entry), fields, sender)

    def _run(self, channel: Channel, entry: Entry, command: Command | None, fields: Any, sender: Sender) -> None:
        result = (
            MavResult.DENIED if command is None else entry.run(self.bridge, channel, command._replace(sender=sender))
        )
        self._answer(channel, fields, entry, result, sender)
        self.bridge.send_asked()

    def _answer(self, channel: Channel, fields: Any, entry: Entry | None, result: int, sender: Sender) -> None:
        self._ack(channel, fields.command, result, sender)
        frame, is_location = (
            (MavFrame.GLOBAL_RELATIVE_ALT, False) if entry is None else (entry.long_frame, entry.has_location)
        )
        for listener in self.bridge.listeners:
            listener.commanded(fields, frame, is_location, sender, result)

    def _set_mode(self, channel: Channel, fields: Any, sender: Sender) -> None:
        as_command = Command(MavCmd.DO_SET_MODE, fields.base_mode, fields.custom_mode, 0.0, 0.0, 0, 0, 0.0, 0, 0.0, 0.0)
        result = command_table.do_set_mode(self.bridge, channel, as_command)
        self._ack(channel, message("SET_MODE").id, result, sender)

    @staticmethod
    def _ack(channel: Channel, number: int, result: int, sender: Sender) -> None:
        system, component = sender
        fields = {"command": number, "result": result, "target_system": system, "target_component": component}
        channel.send(ACK, ACK.payload(**fields))


GRANT, RESEED = MavCmd.USER_1, MavCmd.USER_2
"""MAV_CMD_USER_1: x = simulated time since the start of the simulation [ms] up to which the vehicle may go; the
answer's ``result_param2`` is the time reached [ms]. An older or repeated grant gets only its answer, so that x = 0 asks
for the time. MAV_CMD_USER_2: x (32 bits) = seed of all sensor noise from now on; answered at once."""


class Grants:
    """How far clients let the vehicle go, and which of them wait for an answer."""

    def __init__(self) -> None:
        self.until_us = 0
        """Simulated time since the start that has been granted [us]."""
        self._asked: list[tuple[Peer, Sender, int]] = []

    def command(self, bridge: CommandHost, channel: Channel, fields: Any, sender: Sender) -> bool:
        """Take a COMMAND_INT; False when it is none of these."""
        if fields.command == GRANT:
            if fields.x < 0:
                _ack(channel, GRANT, MavResult.DENIED, sender, 0)
            else:
                if fields.x and channel.peer.directions is not None:  # its questions come in time from now on
                    channel.peer.directions.hold(False)
                self.until_us = max(self.until_us, 1000 * fields.x)
                self._asked.append((channel.peer, sender, 1000 * fields.x))
        elif fields.command == RESEED:
            bridge.vehicle.reseed(fields.x & 0xFFFFFFFF)
            _ack(channel, RESEED, MavResult.ACCEPTED, sender, 0)
        return fields.command in (GRANT, RESEED)

    def answer(self, bridge: CommandHost) -> None:
        """Answer all grants whose time has been reached."""
        now = bridge.elapsed_us
        journal = bridge.board.journal
        if journal is not None and any(wanted <= now for _, _, wanted in self._asked):
            journal.answered()
        for peer, sender, wanted in self._asked:
            if wanted <= now:
                for channel in bridge.channels:  # a reboot in between has made new ones
                    if channel.peer is peer:
                        _ack(channel, GRANT, MavResult.ACCEPTED, sender, now // 1000)
        self._asked = [asked for asked in self._asked if asked[2] > now]
        bridge.flush()


def _ack(channel: Channel, number: int, result: int, sender: Sender, time_ms: int) -> None:
    system, component = sender
    fields = {"command": number, "result": result, "target_system": system, "target_component": component}
    channel.send(ACK, ACK.payload(result_param2=time_ms, **fields))
