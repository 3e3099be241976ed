# SPDX-License-Identifier: BSD-3-Clause
"""The command protocol: every command is answered by exactly one COMMAND_ACK (https://mavlink.io/en/services/command.html).

A repeated command (MAVSDK sends up to four times) is carried out and answered again, as ArduPilot does.
"""

from __future__ import annotations

from typing import Any

from ..channel import Channel
from ..dialect import message
from . import commands_vehicle
from .command import Command, Entry, from_int, from_long
from .results import DENIED, UNSUPPORTED
from .service import Handler, Sender, Service

ACK = message("COMMAND_ACK")
DO_SET_MODE = 176


class CommandService(Service):
    """Commands, and the old way to set the mode."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        self._table = bridge.profile.commands

    def handlers(self) -> dict[str, Handler]:
        return {"COMMAND_LONG": self._long, "COMMAND_INT": self._int, "SET_MODE": self._set_mode}

    def _long(self, channel: Channel, fields: Any, sender: Sender) -> None:
        entry = self._table.get(fields.command)
        if entry is None or entry.int_only:
            self._ack(channel, fields.command, UNSUPPORTED, sender)
            return
        self._run(channel, entry, from_long(fields, entry), fields.command, sender)

    def _int(self, channel: Channel, fields: Any, sender: Sender) -> None:
        grants = self.bridge.grants
        if grants is not None and grants.command(self.bridge, channel, fields, sender):
            return
        entry = self._table.get(fields.command)
        if entry is None:
            self._ack(channel, fields.command, UNSUPPORTED, sender)
            return
        self._run(channel, entry, from_int(fields, entry), fields.command, sender)

    def _run(self, channel: Channel, entry: Entry, command: Command | None, number: int, sender: Sender) -> None:
        result = DENIED if command is None else entry.run(self.bridge, channel, command)
        self._ack(channel, number, result, sender)

    def _set_mode(self, channel: Channel, fields: Any, sender: Sender) -> None:
        as_command = Command(DO_SET_MODE, fields.base_mode, fields.custom_mode, 0.0, 0.0, 0, 0, 0.0, 0, 0.0, 0.0)
        result = commands_vehicle.do_set_mode(self.bridge, channel, as_command)
        self._ack(channel, message("SET_MODE").id, result, sender)

    @staticmethod
    def _ack(channel: Channel, number: int, result: int, sender: Sender) -> None:
        system, component = sender
        fields = {"command": number, "result": result, "target_system": system, "target_component": component}
        channel.send(ACK, ACK.payload(**fields))
