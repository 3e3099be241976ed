# SPDX-License-Identifier: BSD-3-Clause
"""Lists of worlds. A text can name many: "rooms:seed=1..100" are a hundred, each made when it is needed."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import overload

from .generated import MOST_SEED, is_generated
from .shapes import WorldError
from .world import World

Loader = Callable[[str | Path | World], World]
_RANGE = re.compile(r"(?P<before>.*[:,]\s*seed\s*=)(?P<first>[^,]*?)\.\.(?P<last>[^,]*)(?P<after>.*)", re.DOTALL)


class Seeds(Sequence[str]):
    """Texts of worlds that differ in their seeds alone.

    Args:
        text: names them: "rooms:seed=1..100", "labyrinth:size=60,seed=5..9,scale=3"; both ends belong to them.

    Raises:
        WorldError: this is no range of whole numbers from 0 on, or it runs backwards.
    """

    def __init__(self, text: str) -> None:
        found = _RANGE.fullmatch(text)
        if found is None or not is_generated(text):
            raise WorldError(
                f'world {text!r}: a range is one of seeds, of a world that is made, as "rooms:seed=1..100"'
            )
        self._before, self._after = found["before"], found["after"]
        first, last = (_seed(text, found[name]) for name in ("first", "last"))
        if first > last:
            raise WorldError(f"world {text!r}: the range runs backwards; it is written seed={last}..{first}")
        self._seeds = range(first, last + 1)

    def __len__(self) -> int:
        return len(self._seeds)

    @overload
    def __getitem__(self, index: int) -> str: ...

    @overload
    def __getitem__(self, index: slice) -> list[str]: ...

    def __getitem__(self, index: int | slice) -> str | list[str]:
        if isinstance(index, slice):
            return [self._text(seed) for seed in self._seeds[index]]
        return self._text(self._seeds[index])

    def _text(self, seed: int) -> str:
        return f"{self._before}{seed}{self._after}"


def _seed(text: str, number: str) -> int:
    number = number.strip()
    if not (number.isascii() and number.isdigit()) or int(number) > MOST_SEED:
        raise WorldError(f"world {text!r}: {number!r} is no seed; a range is FIRST..LAST, whole numbers to {MOST_SEED}")
    return int(number)


def is_range(given: object) -> bool:
    """Whether a text names several worlds."""
    return isinstance(given, str) and ".." in given.partition(":")[2] and is_generated(given)


class WorldList(Sequence[World]):
    """Worlds in their order. Those that a range names are made when they are asked for; others are loaded at once.

    Args:
        given: a world as ``worlds.load`` takes it, a range of seeds, or a sequence of both.
        load: what loads one.

    Raises:
        WorldError: none at all, one that cannot be loaded, or two different ones of the same name.
    """

    def __init__(self, given: str | Path | World | Sequence[str | Path | World], load: Loader) -> None:
        self._load = load
        each = [given] if isinstance(given, str | Path | World) else list(given)
        if not each:
            raise WorldError("worlds = []: a list of worlds has one at least")
        self._parts: list[Sequence[str] | World] = []
        self.size_of_ranges = 0
        """Worlds that ranges name."""
        names: dict[str, World] = {}
        for one in each:
            if is_range(one):
                seeds = Seeds(str(one))
                load(seeds[0])  # says what is wrong with the rest of the text
                self._parts.append(seeds)
                self.size_of_ranges += len(seeds)
                continue
            world = load(one)
            if names.setdefault(world.name, world) is not world and names[world.name] != world:
                raise WorldError(f"two different worlds are called {world.name!r}: give each a name of its own")
            self._parts.append(world)
        self._length = sum(1 if isinstance(part, World) else len(part) for part in self._parts)

    @property
    def loaded(self) -> Iterator[World]:
        """The worlds that no range names."""
        return (part for part in self._parts if isinstance(part, World))

    def __len__(self) -> int:
        return self._length

    @overload
    def __getitem__(self, index: int) -> World: ...

    @overload
    def __getitem__(self, index: slice) -> list[World]: ...

    def __getitem__(self, index: int | slice) -> World | list[World]:
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(self._length))]
        left = index + self._length if index < 0 else index
        if not 0 <= left < self._length:
            raise IndexError(f"world {index} of {self._length}")
        for part in self._parts:
            if isinstance(part, World):
                if left == 0:
                    return part
                left -= 1
            elif left < len(part):
                return self._load(part[left])
            else:
                left -= len(part)
        raise AssertionError
