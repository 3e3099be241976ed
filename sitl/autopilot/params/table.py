# SPDX-License-Identifier: BSD-3-Clause
"""A firmware's parameters in one table: the MAVLink service, .parm files, logs and the docs page.

Those that have an effect come from the firmware's record; all others of a real ArduPilot from a table that was asked
from one (``benchmarks.ardupilot_parameters``): they are kept, sent and saved, and nothing reads them.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from ...core.records import as_bytes
from .firmware_parameters import Parameters
from .parameter import INT32, Parameter, rows, stored

_KEPT_LISTS = 64


class Table:
    """Parameters by position and by name.

    Args:
        record: those that have an effect.
        names: file of all parameters of a real ArduPilot, in the order of its list; None: there are no others.
        read_by_shell: those of them that Python reads, and what they do.
        own: others that Python reads and ArduPilot does not have, and what they do; all are 0 at first.

    Raises:
        ValueError: a name is there twice.
    """

    def __init__(
        self,
        record: type[Parameters],
        names: Path | None = None,
        read_by_shell: Mapping[str, str] | None = None,
        own: Mapping[str, str] | None = None,
    ) -> None:
        self.record = record
        self.with_effect = tuple(rows(record))
        """In the order of the record."""
        ours = {p.name: p for p in self.with_effect}
        if len(ours) != len(self.with_effect):
            found = [p.name for p in self.with_effect]
            raise ValueError(f"parameters defined twice: {sorted({n for n in found if found.count(n) > 1})}")
        theirs = {} if names is None else {p.name: p for p in _read(names, read_by_shell or {})}
        for name, doc in (own or {}).items():
            theirs[name] = Parameter(name, 0.0, doc=doc, kind=INT32, has_effect=False)
        self._by_name = {
            name: ours[name]._replace(shown_by=p.shown_by) if name in ours else p for name, p in theirs.items()
        }
        self._by_name.update((name, p) for name, p in ours.items() if name not in theirs)
        self.parameters = tuple(self._by_name.values())
        """All, in the order of the wire."""
        self._switches = tuple(sorted({p.shown_by for p in self.parameters if p.shown_by}))
        self._lists: dict[tuple[bool, ...], tuple[Parameter, ...]] = {}

    def __iter__(self) -> Iterator[Parameter]:
        return iter(self.parameters)

    def __len__(self) -> int:
        return len(self.parameters)

    def __contains__(self, name: object) -> bool:
        return name in self._by_name

    def __getitem__(self, name: str) -> Parameter:
        return self._by_name[name]

    def names(self) -> tuple[str, ...]:
        """All names, in the order of the wire."""
        return tuple(self._by_name)

    def set_defaults(self, params: Parameters) -> None:
        """Set every field of a params record to its default."""
        for name, value in self._defaults:
            params[name] = value

    @cached_property
    def _defaults(self) -> list[tuple[str, float]]:
        """Of those with an effect, as the firmware keeps them."""
        return [(p.name, stored(p, p.default)) for p in self.with_effect]

    @cached_property
    def fixed(self) -> dict[str, float]:
        """Defaults of those without effect, as the firmware keeps them: their values, until they are set."""
        return {p.name: stored(p, p.default) for p in self.parameters if not p.has_effect}

    def listed(self, values: Values) -> tuple[Parameter, ...]:
        """Those in the list that clients get: groups that are switched off (BATT2_ while BATT2_MONITOR is 0) are not.

        The others can be read and set by their names all the same.
        """
        states = tuple([self._is_on(values, switch) for switch in self._switches])
        found = self._lists.get(states)
        if found is None:
            if len(self._lists) >= _KEPT_LISTS:
                self._lists.clear()
            on = dict(zip(self._switches, states, strict=True))
            found = self._lists[states] = tuple([p for p in self.parameters if self._is_shown(p, on)])
        return found

    @staticmethod
    def _is_on(values: Values, switch: str) -> bool:
        name, _, wanted = switch.partition("=")
        return values[name] == float(wanted) if wanted else values[name] != 0.0

    def _is_shown(self, parameter: Parameter, on: Mapping[str, bool]) -> bool:
        switch = parameter.shown_by
        return not switch or (on[switch] and self._is_shown(self[switch.partition("=")[0]], on))


class Values:
    """The values of all parameters of one vehicle, by name.

    Args:
        table: of its firmware.
        record: holds those with an effect.
    """

    def __init__(self, table: Table, record: Parameters) -> None:
        self.table, self._record = table, record
        self._numbers, self._indices = record.numbers, record.indices
        self._listed: tuple[Any, tuple[Parameter, ...]] | None = None
        """The values, and what is listed with them."""
        self.kept: dict[str, float] = {}
        """What is not in the record: those without effect, as far as they were set, and values that are out of range,
        for which the record has the nearest one that is not."""
        self.defaults: Mapping[str, float] = {}
        """Defaults of files, where they are others than the firmware's."""

    def __getitem__(self, name: str) -> float:
        value = self.kept.get(name)
        if value is None:
            value = self.table.fixed.get(name)
        return self._numbers[self._indices[name]] if value is None else value

    def __setitem__(self, name: str, value: float) -> None:
        """Set one, as the firmware keeps it."""
        self.update({name: value})

    def update(self, values: Mapping[str, float]) -> None:
        """Set several."""
        for name, value in values.items():
            parameter = self.table[name]
            value = stored(parameter, value)
            used = parameter.used(value)
            if parameter.has_effect:
                self._record[name] = used
            if parameter.has_effect and used == value:
                self.kept.pop(name, None)
            else:
                self.kept[name] = value

    def default(self, name: str) -> float:
        """What clients and logs get as a parameter's default."""
        parameter = self.table[name]
        return stored(parameter, self.defaults.get(name, parameter.default))

    def state(self) -> tuple[bytes, tuple[tuple[str, float], ...]]:
        """Equal as long as no value has changed, by whomever: the core writes parameters, too."""
        return bytes(as_bytes(self._record, self._record.dtype)), tuple(self.kept.items())

    def idle(self) -> list[str]:
        """Those that were set and do nothing here."""
        return [name for name in self.kept if not (self.table[name].has_effect or self.table[name].doc)]

    def listed(self) -> tuple[Parameter, ...]:
        """Those in the list that clients get, in its order."""
        state = self.state()
        if self._listed is None or self._listed[0] != state:
            self._listed = (state, self.table.listed(self))
        return self._listed[1]


def _read(names: Path, read_by_shell: Mapping[str, str]) -> Iterator[Parameter]:
    """Parameters that are not in the record, of a file of ``benchmarks.ardupilot_parameters``."""
    with names.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            name, doc = row["name"], read_by_shell.get(row["name"], "")
            yield Parameter(
                name, float(row["default"]), doc=doc, kind=row["type"], has_effect=False, shown_by=row["shown_by"]
            )
