# SPDX-License-Identifier: BSD-3-Clause
"""One parameter as data, and the declarations with which records of parameters are written.

A group of parameters is a record whose fields are rows or groups::

    class RateLoop(ParameterGroup):
        P: float = param(0.135, 0.0, 5.0, "", "proportional gain")
        FLTT: float = param(20.0, 0.0, 400.0, "Hz", "low-pass of the target; 0: none")

    class AttitudeControl(ParameterGroup):
        RAT_RLL: RateLoop = group("Roll rate loop")
        RAT_YAW: RateLoop = group("Yaw rate loop", P=0.18)  # whose default differs

A parameter's full name is ArduPilot's: the path to it, joined by underscores (ATC_RAT_YAW_P).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from numbers import Real
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...core.records import Record, array, noted, repeat

FLOAT, INT8, INT16, INT32 = "float", "int8", "int16", "int32"

BITS16, BITS32 = (-(2**15), 2**15 - 1), (-(2**31), 2**31 - 1)
"""Ranges of parameters whose bits are looked at one by one: a bit that means nothing here is kept and passed over."""

_INTEGER_LIMITS = {INT8: 127, INT16: 32767, INT32: 2**31 - 1}
FLOAT_LIMIT = float(np.finfo(np.float32).max)


class Parameter(NamedTuple):
    """A named number of the firmware, under ArduPilot's name, with ArduPilot's default.

    ``low`` and ``high`` are the values that the firmware can use (not the range that is advisable).
    """

    name: str
    default: float
    low: float = -math.inf
    high: float = math.inf
    unit: str = ""
    """ArduPilot's unit of the value as the user sees it ("cm/s", "cdeg", "s", "" for none)."""
    doc: str = ""
    """One line, our own words."""
    kind: str = FLOAT
    read_only: bool = False
    """The firmware's own: users read it."""
    path: str = ""
    """Where it lies in the record of parameters: "ATC.RAT_RLL.P", "RC[0].MIN"."""
    has_effect: bool = True
    """Whether it is in the record; of the others those with a ``doc`` are read by Python."""
    shown_by: str = ""
    """The parameter that must not be 0 for this one to be in the list, or "NAME=VALUE"; "": it always is."""

    def refusal(self, value: float) -> str | None:
        """Why ``value`` cannot be set, or None when it can."""
        return self.no_number(value) or self.out_of_range(value)

    def no_number(self, value: float) -> str | None:
        """Why ``value`` is not a number that can be stored, or None when it is one."""
        if not isinstance(value, Real):
            return f"{self.name}: {value!r} is not a number"
        if not (math.isfinite(value) and abs(value) <= FLOAT_LIMIT):
            return f"{self.name}: {value} is not a finite number"
        return None

    def out_of_range(self, value: float) -> str | None:
        """What is wrong with a number that is out of range, or None when it is not."""
        kept = stored(self, value)
        if kept == self.used(kept):
            return None
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.name}: {value:g} is outside {self.low:g} .. {self.high:g}{unit}"

    def used(self, value: float) -> float:
        """The value nearest to ``value`` that is in range, at the precision at which the firmware keeps it."""
        return min(max(value, stored(self, self.low)), stored(self, self.high))


def stored(parameter: Parameter, value: float) -> float:
    """``value`` as the firmware keeps it: floats are float32; integers truncate and stop at their type's ends.

    Before it truncates, ArduPilot adds 0.01 away from zero, so that 2.999 is 3 (``AP_Param::set_float``).
    """
    if parameter.kind == FLOAT:
        return float(np.float32(value))
    limit = _INTEGER_LIMITS[parameter.kind]
    inside = np.float32(min(max(value, -limit - 1), limit))
    return float(int(min(max(float(inside + np.copysign(np.float32(0.01), inside)), -limit - 1), limit)))


class ParameterGroup(Record):
    """A group of parameters: eight bytes each, in the parameter's own unit (centidegrees stay centidegrees).

    A field that a subclass declares again goes where the subclass has it: the order of fields is the order on the wire.
    """

    keeps_offsets: ClassVar[bool] = False
    _small: ClassVar[int] = 0


Change = float | tuple[float, ...] | dict[str, Any]


@dataclass(frozen=True)
class _Group:
    label: str
    changes: dict[str, Change]


def param(
    default: float, low: float, high: float, unit: str, doc: str, kind: str = FLOAT, *, read_only: bool = False,
    count: int = 0,
) -> Any:  # fmt: skip
    """Declares a parameter, or ``count`` numbered ones as an array.

    Args:
        default: ArduPilot's.
        low, high: what the firmware can use.
        unit: of the value as the user sees it, "" for none.
        doc: one line; "{n}" stands for the number of a numbered parameter or group.
        kind: how the wire carries it: FLOAT, INT8, INT16, INT32.
        read_only: the firmware's own.
        count: ``FLTMODE: Floats = param(..., count=6)`` declares FLTMODE1 .. FLTMODE6.
    """
    row = Parameter("", default, low, high, unit, doc, kind, read_only)
    return noted(row, array(count) if count else None)


def group(label: str = "", **changes: Change) -> Any:
    """Declares a group of which something differs from how its class has it.

    Args:
        label: what the group belongs to; precedes the doc of each row ("Roll rate loop: proportional gain").
        changes: of rows under their names: another default, or a dictionary of what differs (``default``, ``high``,
            ``unit``, ``doc``; that doc stands without the label).
    """
    return noted(_Group(label, changes))


def numbered(record: type[ParameterGroup], count: int, **changes: Change) -> Any:
    """Declares groups 1 .. ``count``: ``RC: Records[Channel] = numbered(Channel, 8)`` has RC1_MIN .. RC8_DZ.

    Args:
        record: one of them.
        count: how many.
        changes: as of ``group``; a tuple has a default for each.
    """
    return noted(_Group("", changes), repeat(record, count))


def rows(record: type[Record], prefix: str = "", path: str = "", note: Any = None, n: int = 0) -> Iterator[Parameter]:
    """All parameters of a record with their full names, in the order of memory.

    Args:
        record: the class.
        prefix, path: of the names and of the paths of its rows.
        note: how it was declared.
        n: its number, from 1, where it is one of many.

    Raises:
        ValueError: the declaration changes a row that is not there.
    """
    changed: _Group = note or _Group("", {})
    unknown = changed.changes.keys() - record.fields.keys()
    if unknown:
        raise ValueError(f"{path or record.__name__}: {sorted(unknown)} changed, which {record.__name__} does not have")
    for field in record.fields.values():
        name, at = prefix + field.name, path + field.name
        numbers = range(1, field.shape[0] + 1) if field.shape else ()
        if field.record is not None:
            for k in numbers:
                yield from rows(field.record, f"{name}{k}_", f"{at}[{k - 1}].", field.note, k)
            if not numbers:
                yield from rows(field.record, f"{name}_", f"{at}.", field.note)
            continue
        doc = f"{changed.label}: {field.note.doc}" if changed.label else field.note.doc
        row = _changed(field.note._replace(name=name, path=at, doc=doc), changed.changes.get(field.name, {}), n)
        for k in numbers:
            yield row._replace(name=f"{name}{k}", path=f"{at}[{k - 1}]", doc=row.doc.replace("{n}", str(k)))
        if not numbers:
            yield row._replace(doc=row.doc.replace("{n}", str(n)))


def _changed(row: Parameter, change: Change, n: int) -> Parameter:
    if isinstance(change, dict):
        return row._replace(**change)
    return row._replace(default=change[n - 1] if isinstance(change, tuple) else change)
