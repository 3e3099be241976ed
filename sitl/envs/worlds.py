# SPDX-License-Identifier: BSD-3-Clause
"""Worlds of episodes: each episode is in one of several, drawn by its random generator.

``TRAINING`` and ``TEST`` are lists of worlds for the tasks among solids. They have no world in common: who trains on
the first is judged on the second, in worlds that no policy has seen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from sitl import worlds
from sitl.worlds import World, WorldError, WorldList

from .options import EnvOptionError

Named = str | Path | World
WorldOption = Named | Sequence[Named] | Callable[[np.random.Generator], Any]
"""A world (``sitl.worlds.load``), several ("rooms:seed=1..100", or a list; ``sitl.worlds.load_all``), of which each
episode draws one, all equally likely; or a function of a random generator that gives either: a distribution."""

_KINDS = {
    "copter-forest": "forest:seed={}",
    "copter-rooms": "rooms:seed={}",
    "rover-labyrinth": "labyrinth:seed={},size=60,scale=3",
    "rover-slalom": "slalom:seed={}",
    "rover-race": "track:seed={}",
    "rover-parking": "car_park:seed={}",
}
TRAINING = {preset: text.format("1..200") for preset, text in _KINDS.items()}
"""Preset -> worlds to learn in, as the option ``world`` takes them: those of ids "-v1"."""
TEST = {preset: text.format("1001..1100") for preset, text in _KINDS.items()}
"""Preset -> worlds to be judged in."""
_WORD = (1 << 64) - 1
_STREAM = 4 << 40
"""Second word of the seeds of the numbers that choose worlds: see ``session.RANDOMISE_STREAM``."""
MOST = 256
"""Worlds of which an environment keeps what it has found out (free positions, arenas, start poses)."""
_EAGER = 64
"""Up to so many listed worlds are looked at when an environment is made; later ones, when an episode is in them."""
T = TypeVar("T")


class PerWorld(Generic[T]):
    """What belongs to a world, made when it is first asked for; of the last ``MOST`` worlds it is kept.

    Args:
        make: makes it.
    """

    def __init__(self, make: Callable[[World], T]) -> None:
        self._make = make
        self._kept: dict[str, tuple[World, T]] = {}

    def __getstate__(self) -> dict[str, Any]:
        return {"_make": self._make, "_kept": {}}

    def __call__(self, world: World) -> T:
        """That of a world."""
        found = self._kept.pop(world.name, None)
        if found is None or (found[0] is not world and found[0] != world):
            found = (world, self._make(world))
            if len(self._kept) >= MOST:
                del self._kept[next(iter(self._kept))]
        self._kept[world.name] = found  # the last one that was used
        return found[1]


class WorldDraw:
    """Draws the worlds of episodes.

    Args:
        option: see ``WorldOption``.

    Raises:
        EnvOptionError: no such world, or a range or list that cannot be used.
    """

    def __init__(self, option: WorldOption) -> None:
        self._function = option if callable(option) and not isinstance(option, type) else None
        self._given, self._list = option, _loaded(option) if self._function is None else None
        self.varies = self._list is None or len(self._list) > 1
        """Whether there are several."""
        self.first = self.draw(np.random.default_rng(0)) if self._list is None else self._list[0]
        """One of them: that which an environment is made in."""

    @property
    def text(self) -> str:
        """The worlds in a few words."""
        if not self.varies:
            return self.first.name
        if self._function is not None:
            return f"drawn by {_name(self._function)}"
        return self._given if isinstance(self._given, str) else f"one of {len(self._list or ())}"

    @property
    def listed(self) -> list[World]:
        """The first of those that are not named by a range: they can be looked at before an episode is in them."""
        return [] if self._list is None else list(self._list.loaded)[:_EAGER]

    def draw(self, rng: np.random.Generator) -> World:
        """The world of an episode. It takes no number out of ``rng``: what else is drawn for an episode is the same
        whichever worlds there are.

        Raises:
            EnvOptionError: the function gave no world.
        """
        if not self.varies:
            return self.first
        kept = rng.bit_generator.state
        number = int(rng.integers(1 << 63))
        rng.bit_generator.state = kept
        if self._function is None:
            assert self._list is not None
            return self._list[_mixed(number) * len(self._list) >> 64]
        own = np.random.default_rng((number, _STREAM))
        given = self._function(own)
        try:
            found = _loaded(given)
        except EnvOptionError as error:
            raise EnvOptionError(f"world: the function {_name(self._function)} gave {given!r}: {error}") from None
        return found[int(own.integers(len(found)))]


def _mixed(number: int) -> int:
    """A number of 64 bits, each of which depends on all of those of ``number``.

    Source: the finalizer of SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA
    2014).
    """
    number = (number + _STREAM) & _WORD
    number = (number ^ number >> 30) * 0xBF58476D1CE4E5B9 & _WORD
    number = (number ^ number >> 27) * 0x94D049BB133111EB & _WORD
    return number ^ number >> 31


def key_of(world: World) -> str | World:
    """What a snapshot keeps of a world: its name, if that makes the same world again."""
    try:
        return world.name if worlds.load(world.name) == world else world
    except WorldError:
        return world


def load_world(given: Any) -> World:
    """One world of a name, a file or a World.

    Raises:
        EnvOptionError: there is no such world.
    """
    try:
        return worlds.load(given)
    except WorldError as error:
        raise EnvOptionError(str(error)) from None


def _loaded(given: Any) -> WorldList:
    try:
        return worlds.load_all(given)
    except WorldError as error:
        raise EnvOptionError(str(error)) from None


def _name(function: Callable[..., Any]) -> str:
    return getattr(function, "__name__", type(function).__name__)
