# SPDX-License-Identifier: BSD-3-Clause
"""What can be plotted of a live vehicle: fields of its record ("physics.body.pos[2]"), and of its telemetry
("ATTITUDE.roll"), which is built in plain Python from a copy of the record: no client has to ask the vehicle for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..bridge.dialect import message
from ..bridge.firmware_profile import Profile
from ..bridge.telemetry.plain import build
from ..bridge.wire.choose import message_of
from ..bridge.wire.port import Port
from ..core.record_reader import RecordReader
from ..errors import OptionError, did_you_mean
from ..vehicle.kind import Kind

_LEFT_OUT = ("autopilot.params.", "autopilot.inertial.", "rng.")
"""Parameters are changed, not plotted; rings of samples are no signals."""
_LONGEST = 16
"""Elements of an array that are offered one by one."""


class SignalError(OptionError):
    """A signal that the vehicle does not have."""


class Signals:
    """The signals of a copy of a vehicle's record.

    Args:
        kind: of vehicle.
        fleet: the array with the copy, which stays in place.
        v: its record.
    """

    def __init__(self, kind: Kind, fleet: np.ndarray[Any, Any], v: Any) -> None:
        self._v, self._reader, self._port = v, RecordReader(fleet, 0), Port()
        builders = kind.part("mavlink", Profile).core.builders
        self._builders = {message_of(builder).kind.name: builder for builder in builders}
        self.names = [*self._telemetry_names(), *_fields(fleet.dtype)]
        """All of them."""
        self._known = frozenset(self.names)

    def _telemetry_names(self) -> list[str]:
        return [f"{name}.{field}" for name, builder in self._builders.items() for field in message_of(builder).parts]

    def check(self, name: str) -> None:
        """SignalError when there is no such signal."""
        if name not in self._known:
            raise SignalError(f"there is no signal {name!r}{did_you_mean(name, self.names)}")

    def reader(self, names: tuple[str, ...]) -> Callable[[], dict[str, float]]:
        """A function that gives the present values of some signals.

        Raises:
            SignalError: there is no such signal.
        """
        for name in names:
            self.check(name)
        of_record = {name: self._reader.fields(name) for name in names if not name.partition(".")[0].isupper()}
        of_messages = [name for name in names if name not in of_record]

        def read() -> dict[str, float]:
            values = {name: float(field()[0]) for name, field in of_record.items()}
            built: dict[str, Any] = {}
            for name in of_messages:
                kind, _, field = name.partition(".")
                if kind not in built:
                    payload = build(self._builders[kind], self._v, self._port)
                    built[kind] = message(kind).decode(payload) if payload else None
                if built[kind] is not None:
                    value = getattr(built[kind], field)
                    values[name] = float(value[0] if isinstance(value, tuple | list) else value)
            return values

        return read


def _fields(dtype: np.dtype[Any], path: str = "") -> Iterator[str]:
    """Paths of all numbers in a record."""
    for name in dtype.names or ():
        part = dtype[name]
        base, shape = part.subdtype if part.subdtype is not None else (part, ())
        full = f"{path}{name}"
        if full.startswith(tuple(p.rstrip(".") for p in _LEFT_OUT)) and base.names:
            continue
        count = int(np.prod(shape, dtype=int)) if shape else 1
        if base.names:
            if not shape:
                yield from _fields(base, full + ".")
            elif len(shape) == 1 and count <= _LONGEST:
                for k in range(count):
                    yield from _fields(base, f"{full}[{k}].")
        elif base.kind in "fiu":
            if not shape:
                yield full
            elif len(shape) == 1 and count <= _LONGEST:
                yield from (f"{full}[{k}]" for k in range(count))
