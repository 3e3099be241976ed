# SPDX-License-Identifier: BSD-3-Clause
"""Files of parameters: their values for a vehicle, what is to be said of them, and a vehicle's values as a file."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from ...core.whole_file import write_whole
from ...errors import did_you_mean
from .parameter import FLOAT, Parameter, stored
from .reader import ParameterError, Reader
from .renamed import here
from .table import Table, Values

__all__ = [
    "FileValues", "Given", "ParameterError", "ParameterWarning", "apply", "check", "dump", "format_value", "given",
    "load", "load_all", "not_read", "notes", "parse", "report", "save", "text_of",
]  # fmt: skip

_SHOWN = 6
"""Number of names in a message about many."""


class ParameterWarning(UserWarning):
    """What a file of parameters has that this vehicle does not take, or takes otherwise."""


class FileValues(dict[str, float]):
    """Values of files of parameters, by name.

    A vehicle takes them as it takes PARAM_SET, and as ArduPilot takes ``--defaults``: it passes over names that its
    firmware does not have, and where a value is out of range it keeps the value and uses the nearest one in range.
    """

    def __init__(self, values: Mapping[str, float] | None = None) -> None:
        super().__init__(values or {})
        self.sources: dict[str, list[str]] = {}
        """Names that each file has."""
        self.remarks: list[str] = []
        """What was passed over in the files."""
        self.read_only: frozenset[str] = frozenset()
        """Names that are marked ``@READONLY``."""
        self._reported = [False]
        if isinstance(values, FileValues):
            self._add(values)

    def __or__(self, other: Mapping[str, float]) -> FileValues:  # type: ignore[override]
        """With others over these."""
        both = FileValues(self)
        both.update(other)
        if isinstance(other, FileValues):
            both._add(other)
        return both

    __ior__ = __or__  # type: ignore[assignment]

    def __ror__(self, other: Mapping[str, float]) -> FileValues:  # type: ignore[override]
        """These over others."""
        both = FileValues(self)
        for name, value in other.items():
            both.setdefault(name, value)
        return both

    @property
    def is_reported(self) -> bool:
        """Whether the user has been sent what there is to report of them (``notes``), or of a copy."""
        return self._reported[0]

    @is_reported.setter
    def is_reported(self, value: bool) -> None:
        self._reported[0] = value

    def _add(self, other: FileValues) -> None:
        self.sources.update(other.sources)
        self.remarks += other.remarks
        self.read_only = (self.read_only - other.keys()) | other.read_only
        self._reported = other._reported


Given = Mapping[str, float] | str | Path
"""Parameters as they are given: values by name, or a file."""


def parse(text: str, source: str = "parameters") -> FileValues:
    """Names and values of the text of a file of parameters.

    Raises:
        ParameterError: names the source, the line and what is wrong with it.
    """
    reader = Reader()
    reader.text(text, source)
    return _of(reader, source)


def load(path: str | Path) -> FileValues:
    """Names and values of a file of parameters, in any form that ``reader`` knows.

    Raises:
        ParameterError: it cannot be read, is no file of parameters, or has a value that is no number.
    """
    reader = Reader()
    reader.read(Path(path))
    return _of(reader, str(path))


def load_all(paths: Iterable[str | Path]) -> FileValues:
    """Of several files; each stands over those before it."""
    values = FileValues()
    for path in paths:
        values |= load(path)
    return values


def _of(reader: Reader, source: str) -> FileValues:
    values = FileValues(reader.values)
    values.sources[source] = list(reader.values)
    values.remarks, values.read_only = reader.remarks, frozenset(reader.read_only)
    return values


def given(params: Given | None) -> dict[str, float]:
    """A copy of parameters as they are given; those of a file are ``FileValues``.

    Raises:
        ParameterError: see ``load``.
    """
    if isinstance(params, str | Path):
        return load(params)
    return FileValues(params) if isinstance(params, FileValues) else dict(params or {})


def apply(values: Values, given: Mapping[str, float], source: str = "parameters") -> list[str]:
    """Set a vehicle's parameters to all values given, or none of them; returns the names that its firmware lacks.

    Those of files (``FileValues``) are set as a vehicle takes them; the user is notified of what it does not take, if
    that has not been done, and nothing is returned.

    Raises:
        ParameterError: a known parameter's value is refused; nothing was set.
    """
    known = {name: value for name, value in given.items() if name in values.table}
    if isinstance(given, FileValues):
        report(values.table, given)
        values.update(known)
        return []
    check(values.table, known, source)
    values.update(known)
    return [name for name in given if name not in known]


def unknown(kind: str, names: Sequence[str], table: Table) -> str:
    """What is to be said of names that a kind of vehicle does not have: those that may be meant, not all there are."""
    hints = [did_you_mean(str(name).upper(), table.names()).removeprefix("; ") for name in names[:_SHOWN]]
    shown = [f"{name} ({hint})" if hint else str(name) for name, hint in zip(names, hints)]
    return f"the {kind} has no parameters {', '.join(shown)}" + (", ..." if len(names) > _SHOWN else "")


def check(table: Table, values: Mapping[str, float], source: str = "parameters") -> None:
    """Check values of parameters that the table has.

    Raises:
        ParameterError: names all that are refused.
    """
    if refused := [text for name, value in values.items() if (text := table[name].refusal(value))]:
        raise ParameterError(f"{source}: " + "; ".join(refused))


def report(table: Table, values: FileValues) -> None:
    """Warn of what there is to say of files, once."""
    if not values.is_reported:
        values.is_reported = True
        for text in notes(table, values):
            warnings.warn(text, ParameterWarning, stacklevel=3)


def not_read(values: FileValues) -> list[str]:
    """What is reported to the user of files whatever the firmware is: lines that were passed over,
    files that are empty."""
    empty = [source for source, names in values.sources.items() if not names]
    return values.remarks + [f"{source}: nothing was set: it has no parameters" for source in empty]


def notes(table: Table, values: FileValues) -> list[str]:
    """What is reported to the user of files: lines that were passed over, and values that this firmware does not take
    as they are."""
    names = {name for listed in values.sources.values() for name in listed}
    found = {name: value for name, value in values.items() if name in names}
    known = {name: value for name, value in found.items() if name in table}
    texts = not_read(values)
    for source, listed in values.sources.items():
        if listed and not any(name in table for name in listed):
            texts.append(f"{source}: nothing was set: none of its parameters is in this firmware")
    if unknown := [name for name in found if name not in table]:
        texts.append(f"{_counted(unknown)} of the files {_are(unknown)} not in this firmware: {_some(unknown)}")
        if renamed := list(_renamed(table, {name: found[name] for name in unknown})):
            texts[-1] += f"; not set, but the same here: {_some(renamed)}"
        elif len(unknown) == 1:
            texts[-1] += did_you_mean(unknown[0], table.names(), 0.85)
    if idle := [name for name in known if not (table[name].has_effect or table[name].doc)]:
        texts.append(
            f"{_counted(idle)} of the files {'has' if len(idle) == 1 else 'have'} no effect here: {_some(idle)}"
        )
    if outside := [table[name] for name, value in known.items() if table[name].out_of_range(value)]:
        listed = [f"{p.name} {known[p.name]:g} ({p.used(stored(p, known[p.name])):g})" for p in outside]
        texts.append(
            f"{_counted(outside)} of the files {_are(outside)} out of range (used instead): {', '.join(listed)}"
        )
    if marked := [name for name in known if name in values.read_only]:
        texts.append(f"{_counted(marked)} of the files {_are(marked)} @READONLY, and can be set here: {_some(marked)}")
    return texts


def _renamed(table: Table, unknown: Mapping[str, float]) -> Iterator[str]:
    """What parameters of other versions are called here, if they would change something; rates of telemetry last."""
    for name, value in sorted(unknown.items(), key=lambda item: item[0].startswith("SR")):
        ours, factor = here(name) or ("", 1.0)
        if ours in table and table[ours].has_effect and stored(table[ours], factor * value) != table[ours].default:
            yield f"{ours} {factor * value:g} for {name} {value:g}"


def _counted(names: Sequence[object]) -> str:
    return f"{len(names)} parameter{'s' * (len(names) != 1)}"


def _are(names: Sequence[object]) -> str:
    return "is" if len(names) == 1 else "are"


def _some(names: list[str]) -> str:
    return ", ".join(names[:_SHOWN]) + (", ..." if len(names) > _SHOWN else "")


def text_of(values: Mapping[str, float]) -> str:
    """Values as the text of a file for an ArduPilot."""
    marked = values.read_only if isinstance(values, FileValues) else ()
    return "".join(f"{name} {value:.9g}{' @READONLY' if name in marked else ''}\n" for name, value in values.items())


def format_value(parameter: Parameter, value: float) -> str:
    """A value as a .parm file shows it: whole for integers, else the shortest text that is stored as the same."""
    if parameter.kind != FLOAT:
        return str(int(value))
    texts = [f"{value:.{digits}g}" for digits in range(6, 18)]
    return next((text for text in texts if stored(parameter, float(text)) == value), texts[-1])


def dump(values: Values) -> str:
    """A vehicle's parameters as .parm text, in the table's order.

    Those are left out that have no effect, were not set, and whose group is switched off.
    """
    shown = {p.name for p in values.listed()} | values.kept.keys()
    chosen = (p for p in values.table if p.has_effect or p.name in shown)
    return "".join(f"{p.name},{format_value(p, values[p.name])}\n" for p in chosen)


def save(values: Values, path: str | Path) -> None:
    """Write a vehicle's parameters to a .parm file.

    Raises:
        SitlError: it cannot be written; the file of before stays.
    """
    write_whole(path, dump(values), title=f"parameter file {path}")
