# SPDX-License-Identifier: BSD-3-Clause
"""The parameter protocol (https://mavlink.io/en/services/parameter.html), with ArduPilot's encoding.

The number itself as float32.

The file ``@PARAM/param.pck``.

All parameters, packed, names shortened by what they share with the one before.

Format: https://ardupilot.org/dev/docs/mavlink-get-set-params.html and the readers of pymavlink and MAVProxy.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from typing import Any

from ...autopilot.params.parameter import FLOAT, INT8, INT16, INT32, Parameter, stored
from ...autopilot.params.renamed import Alias, alias
from ...core.constants import NEVER
from ...core.mavlink import MavSeverity
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from .service import Handler, Service
from .statustext import StatusTextService

VALUE, ERROR = message("PARAM_VALUE"), message("PARAM_ERROR")
DOES_NOT_EXIST, OUT_OF_RANGE, PERMISSION_DENIED = 1, 2, 3
"""MAV_PARAM_ERROR"""
WIRE_TYPES = {INT8: 2, INT16: 4, INT32: 6, FLOAT: 9}
"""MAV_PARAM_TYPE"""
NO_INDEX = 65535
LIST_EVERY_US = 10_000
LIST_AT_ONCE = 10
"""A list goes out at ten parameters in 10 ms of simulated time."""
MOST_REPORTED = 10
"""So many parameters without effect are reported, each at its first change: a client may set a thousand."""


class ParameterService(Service):
    """Parameters: list, read by name or index, set."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._table, self._values = bridge.vehicle.firmware.table, bridge.vehicle.parameters
        self._lists: dict[Channel, int] = {}
        self._reported = 0
        self._packed: dict[bool, tuple[Any, bytes]] = {}
        """With defaults or without -> what the values were then, the file."""

    def handlers(self) -> dict[str, Handler]:
        return {
            "PARAM_REQUEST_LIST": self._request_list,
            "PARAM_REQUEST_READ": self._request_read,
            "PARAM_SET": self._set,
        }

    def channel_removed(self, channel: Channel) -> None:
        self._lists.pop(channel, None)

    def value(self, name: str) -> float:
        """Present value, in the parameter's own unit."""
        return self._values[name]

    def packed(self, with_defaults: bool) -> bytes:
        """The file of all parameters; the same object until one changes: packing takes milliseconds, and every client
        may ask at any rate."""
        state = self._values.state()
        before = self._packed.get(with_defaults)
        if before is None or before[0] != state:
            listed = [(p, self._values[p.name], self._values.default(p.name)) for p in self._values.listed()]
            before = self._packed[with_defaults] = (state, pack_parameters(listed, with_defaults))
        return before[1]

    def _payload(self, name: str, index: int, count: int) -> bytes:
        kind = WIRE_TYPES[self._table[name].kind]
        return VALUE.pack(self._values[name], count, index, name.encode(), kind)

    def _one(self, name: str) -> bytes:
        return self._payload(name, NO_INDEX, len(self._values.listed()))

    # ------------------------------------------------------------------ reading

    def _request_list(self, channel: Channel, fields: Any, sender: Sender) -> None:
        self._lists[channel] = 0
        self.due_us = min(self.due_us, self.bridge.now_us)

    def snapshot(self) -> Any:
        return (tuple((c.number, at) for c, at in self._lists.items()), self.due_us, self._reported)

    def restore(self, state: Any) -> None:
        lists, self.due_us, self._reported = state
        self._lists = {c: at for number, at in lists for c in self.bridge.channels if c.number == number}

    def service(self, now_us: int) -> None:
        listed = self._values.listed() if self._lists else ()
        for channel, at in list(self._lists.items()):
            if channel.congested:
                continue
            stop = min(at + LIST_AT_ONCE, len(listed))
            for k in range(at, stop):
                channel.send(VALUE, self._payload(listed[k].name, k, len(listed)))
            self._lists[channel] = stop
            if stop >= len(listed):
                del self._lists[channel]
        self.due_us = now_us + LIST_EVERY_US if self._lists else NEVER

    def _request_read(self, channel: Channel, fields: Any, sender: Sender) -> None:
        if fields.param_index >= 0:
            listed = self._values.listed()
            if fields.param_index < len(listed):
                name = listed[fields.param_index].name
                channel.send(VALUE, self._payload(name, fields.param_index, len(listed)))
            else:
                _refuse(channel, sender, b"", fields.param_index, DOES_NOT_EXIST)
            return
        name = fields.param_id.decode("ascii", "replace")
        if name in self._table:
            channel.send(VALUE, self._one(name))
        elif (other := self._alias(name)) is not None:
            channel.send(VALUE, self._under_alias(name, other))
        else:
            _refuse(channel, sender, fields.param_id, fields.param_index, DOES_NOT_EXIST)

    def _alias(self, name: str) -> Alias | None:
        """The parameter that another version calls ``name``."""
        found = alias(name)
        return found if found is not None and found.name in self._table else None

    def _under_alias(self, name: str, other: Alias) -> bytes:
        kind = WIRE_TYPES[self._table[other.name].kind]
        value = other.from_here(self._values[other.name])
        return VALUE.pack(value, len(self._values.listed()), NO_INDEX, name.encode(), kind)

    # ------------------------------------------------------------------ writing

    def _set(self, channel: Channel, fields: Any, sender: Sender) -> None:
        name = fields.param_id.decode("ascii", "replace")
        other = self._alias(name) if name not in self._table else None
        if other is not None and math.isfinite(fields.param_value):
            self.set(other.name, other.to_here(fields.param_value))
            channel.send(VALUE, self._under_alias(name, other))
            return
        if name not in self._table:
            error = DOES_NOT_EXIST if other is None else OUT_OF_RANGE
            _refuse(channel, sender, fields.param_id, -1, error)
            return
        refusal = self.set(name, fields.param_value)
        if refusal is not None:
            error = PERMISSION_DENIED if math.isfinite(fields.param_value) else OUT_OF_RANGE
            _refuse(channel, sender, fields.param_id, -1, error)
            self.bridge.get(StatusTextService).say(MavSeverity.WARNING, refusal)
            channel.send(VALUE, self._one(name))

    def set(self, name: str, value: float) -> str | None:
        """Set a parameter, in its unit, and report it to every client, or say why not.

        A number out of range is taken, as ArduPilot takes it; the firmware then goes by the nearest one in range.

        Raises:
            KeyError: there is no such parameter.
        """
        parameter = self._table[name]
        refusal = f"Param write denied ({name})" if parameter.read_only else parameter.no_number(value)
        if refusal is not None:
            return refusal
        range_text = parameter.out_of_range(value)
        if range_text is not None and value != self._values[name]:
            used = parameter.used(stored(parameter, value))
            self.bridge.get(StatusTextService).say(MavSeverity.INFO, f"{range_text}: {used:g} is used")
        if not (parameter.has_effect or parameter.doc or name in self._values.kept):
            self._report(name)
        self._values[name] = value
        self.bridge.broadcast(VALUE, self._one(name))
        for listener in self.bridge.listeners:
            listener.parameter_set(name)
        self.bridge.autopilot.parameter_changed(name)
        self.bridge.report(self.bridge.autopilot.take_notes())
        self.bridge.parameter_changed(name)
        if name == "MAV_SYSID":
            self.bridge.refresh_identity()
        return None

    def _report(self, name: str) -> None:
        """Report to the user that a parameter, set for the first time, does nothing here."""
        self._reported += 1
        if self._reported <= MOST_REPORTED:
            self.bridge.get(StatusTextService).say(MavSeverity.INFO, f"{name} has no effect in this simulator")
        elif self._reported == MOST_REPORTED + 1:
            self.bridge.get(StatusTextService).say(MavSeverity.INFO, "Others that are set have no effect either")


def _refuse(channel: Channel, sender: Sender, name: bytes, index: int, error: int) -> None:
    """PARAM_ERROR to who asked."""
    system, component = sender
    channel.send(
        ERROR,
        ERROR.payload(target_system=system, target_component=component, param_id=name, param_index=index, error=error),
    )


MAGIC, MAGIC_WITH_DEFAULTS = 0x671B, 0x671C
HAS_DEFAULT = 1
_TYPES = {INT8: (1, "b"), INT16: (2, "h"), INT32: (3, "i"), FLOAT: (4, "f")}


def pack_parameters(values: Sequence[tuple[Parameter, float, float]], with_defaults: bool) -> bytes:
    """The file's bytes, of parameters with value and default.

    With defaults, a parameter that differs from its default carries both.
    """
    magic = MAGIC_WITH_DEFAULTS if with_defaults else MAGIC
    parts = [struct.pack("<HHH", magic, len(values), len(values))]
    before = b""
    for parameter, value, default in values:
        name = parameter.name.encode("ascii")
        shared = 0
        while shared < min(len(name) - 1, len(before), 15) and name[shared] == before[shared]:
            shared += 1
        number, code = _TYPES[parameter.kind]
        both = with_defaults and default != value
        flags = HAS_DEFAULT if both else 0
        parts.append(bytes((number | flags << 4, shared | (len(name) - shared - 1) << 4)) + name[shared:])
        parts.append(_number(code, value))
        if both:
            parts.append(_number(code, default))
        before = name
    return b"".join(parts)


def _number(code: str, value: float) -> bytes:
    return struct.pack("<" + code, value if code == "f" else int(value))
