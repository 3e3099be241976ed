# SPDX-License-Identifier: BSD-3-Clause
"""The kinds of vehicles by name: those that come with the simulator, and those of other packages.

Another package's kind is known by the entry point group ``sitl.kinds`` (name -> its ``Kind``), or for the process by
``register``. A kind is loaded when it is first asked for.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points

from ..errors import OptionError, did_you_mean
from .kind import Kind, load

BUILT_IN = {
    "copter": "sitl.vehicle.copter:COPTER",
    "rover": "sitl.vehicle.rover:ROVER",
}
"""Name -> where the kind is."""
DEFAULT = next(iter(BUILT_IN))
"""Name of the kind that is taken when nothing says another."""
GROUP = "sitl.kinds"
"""Entry points of other packages."""


class UnknownKindError(OptionError):
    """No kind of vehicle has this name; the message lists those there are."""


class Kinds(Mapping[str, Kind]):
    """Every kind by its name; built-in ones first."""

    def __init__(self) -> None:
        self._loaded: dict[str, Kind] = {}
        self._registered: dict[str, None] = {}

    def __getitem__(self, name: str) -> Kind:
        """A kind.

        Raises:
            UnknownKindError: there is none of this name.
        """
        if name not in self._loaded:
            if name in BUILT_IN:
                found = load(BUILT_IN[name])
            elif name in _installed():
                found = _installed()[name].load()
            else:
                known = ", ".join(self)
                raise UnknownKindError(f"vehicle {name!r} is none of {known}{did_you_mean(str(name), self)}")
            if not isinstance(found, Kind) or found.name != name:
                raise UnknownKindError(f"entry point {name!r} of group {GROUP}: {found!r} is no Kind of this name")
            self._loaded[name] = found
        return self._loaded[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*BUILT_IN, *_installed(), *self._registered)))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        return name in self._loaded or name in BUILT_IN or name in _installed()

    def register(self, kind: Kind) -> Kind:
        """Make a kind known in this process; gives it back.

        Raises:
            OptionError: there is another kind of this name, or its airframes say that they are of another.
        """
        if kind.airframe.kind != kind.name:
            raise OptionError(f"vehicle {kind.name!r}: its airframes are of kind {kind.airframe.kind!r}")
        if kind.name in self and self[kind.name] is not kind:
            raise OptionError(f"there is a vehicle {kind.name!r} already")
        self._loaded[kind.name] = kind
        self._registered[kind.name] = None
        return kind

    def unregister(self, name: str) -> None:
        """Forget a kind that was registered."""
        if name in self._registered:
            del self._registered[name], self._loaded[name]

    def of_mav_type(self, number: int) -> Kind | None:
        """The kind whose firmware controls vehicles of a MAV_TYPE; None: none does."""
        return next((kind for kind in self.values() if number in kind.mav_types), None)


@cache
def _installed() -> dict[str, EntryPoint]:
    return {point.name: point for point in entry_points(group=GROUP)}


KINDS = Kinds()
register = KINDS.register
