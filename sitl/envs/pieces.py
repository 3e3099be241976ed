# SPDX-License-Identifier: BSD-3-Clause
"""What the option ``observation`` may be, besides a name of ``observations``: parts, pictures, and dicts of them."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from typing import Any

import gymnasium as gym

from .boxes import NamedParts, Parts
from .observations import Observation
from .options import EnvOptionError, unknown
from .parts import PARTS, Surroundings
from .pictures import PICTURES, Picture
from .robots.robot import Robot
from .senses import reads_scan


class Pieces:
    """A dict of observations.

    Args:
        pieces: name -> name of a part or a picture, a part, a picture, or a list of parts (one box).
    """

    def __init__(self, pieces: Mapping[str, Any]) -> None:
        if not pieces:
            raise EnvOptionError("observation {} has no entries")
        self.pieces = {name: _piece(name, piece) for name, piece in pieces.items()}
        self.remembers = tuple(p for piece in self.pieces.values() for p in getattr(piece, "remembers", ()))
        """What of them remembers the last steps."""
        self.reads_scan = any(reads_scan(piece) for piece in self.pieces.values())

    def prepare(self, session: Surroundings) -> None:
        """Called once, when robot, action and task are there."""
        for piece in self.pieces.values():
            piece.prepare(session)

    def space(self, robot: Robot) -> gym.Space[Any]:
        """See ``Observation``."""
        return gym.spaces.Dict({name: piece.space(robot) for name, piece in self.pieces.items()})

    def observe(self, robot: Robot) -> Any:
        """See ``Observation``."""
        return {name: piece.observe(robot) for name, piece in self.pieces.items()}


def _piece(name: str, piece: Any) -> Any:
    if not isinstance(name, str):
        raise EnvOptionError(f"observation: {name!r} is no name of an entry")
    if isinstance(piece, Picture):
        return deepcopy(piece)
    if isinstance(piece, str):
        if piece in PICTURES:
            return PICTURES[piece]()
        if piece not in PARTS:
            raise unknown(f"observation: {name!r}:", piece, [*PARTS, *PICTURES])
    return Parts(piece if isinstance(piece, list | tuple) else [piece])


def observation_of(option: Any, known: Any) -> Observation | None:
    """What an option names: a list or tuple of parts gives one box, "scan+velocity", "depth+goal" and a dict give a
    dict, "depth" a picture; None: a name of ``known``, or no text.

    Raises:
        EnvOptionError: a name that is not known.
    """
    if isinstance(option, list | tuple):
        return Parts(option)
    if isinstance(option, Mapping):
        return Pieces(option)
    if not isinstance(option, str) or option in known:
        return None
    if option in PICTURES:
        picture: Picture = PICTURES[option]()
        return picture
    names = option.split("+")
    if any(name in PICTURES for name in names):
        return Pieces({name: name for name in names})
    wrong = next((name for name in names if name not in PARTS), None)
    if wrong is None:
        return NamedParts(names)
    if len(names) > 1:
        raise unknown(f"observation {option!r}: part", wrong, PARTS)
    raise unknown("observation", option, dict.fromkeys((*known, *PICTURES, *PARTS)))
