# SPDX-License-Identifier: BSD-3-Clause
"""Compiled entries bound to one vehicle."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import c_int64, c_void_p, cast
from functools import partial
from typing import Any

import numpy as np

from ..core import compile as compiler
from ..core.compile import Progress
from .kind import Kind
from .kinds import DEFAULT, KINDS

Array = np.ndarray[Any, Any]


class Core:
    """``advance(fleet, index, ticks)`` of a kind of vehicle, compiled or (``NUMBA_DISABLE_JIT=1``) plain Python."""

    def __init__(self, kind: Kind, function: Callable[..., None] | None) -> None:
        self.kind = kind
        self._function = function

    def __call__(self, fleet: Array, index: int, ticks: int) -> None:
        """Advance vehicle ``index`` by up to ``ticks`` ticks."""
        self.bind(fleet, index)(ticks)

    def bind(self, fleet: Array, index: int) -> Callable[[int], None]:
        """The same for one vehicle, whose memory stays in place: cheaper to call."""
        return _bound(self.kind, self.kind.advance, self._function, fleet, index)


def load_core(kind: Kind | None = None, progress: Progress | None = None) -> Core:
    """The core of a kind of vehicle (None: the default one); compiles what changed since it was last built."""
    kind = kind or KINDS[DEFAULT]
    return Core(kind, compiler.load(kind.advance, kind.record_path, progress))


def bind_unit(
    unit: Callable[..., None], kind: Kind, fleet: Array, index: int, progress: Progress | None = None
) -> Callable[[], None]:
    """A unit of a kind of vehicle as a function of no arguments, for one vehicle whose memory stays in place."""
    return _bound(kind, unit, compiler.load(unit, kind.record_path, progress), fleet, index)


def bind_fleet_unit(
    unit: Callable[..., None], kind: Kind, fleet: Array, progress: Progress | None = None
) -> Callable[..., None]:
    """A unit of a kind of vehicle for a whole fleet, whose memory stays in place: ``run(index, *integers)``."""
    compiled = compiler.load(unit, kind.record_path, progress)
    if compiled is None:
        return partial(unit, [kind.record.of(fleet, k) for k in range(len(fleet))])  # type: ignore[arg-type]
    return partial(compiled, c_void_p(fleet.ctypes.data), c_int64(len(fleet)))


def unit_address(unit: Callable[..., None], kind: Kind) -> int:
    """Where the machine code of a unit of a kind of vehicle is; 0: there is none (``NUMBA_DISABLE_JIT=1``)."""
    compiled = compiler.load(unit, kind.record_path)
    return 0 if compiled is None else cast(compiled, c_void_p).value or 0


def _bound(kind: Kind, plain: Callable[..., None], compiled: Any, fleet: Array, index: int) -> Callable[..., None]:
    if compiled is None:
        views: Any = {index: kind.record.of(fleet, index)}
        return partial(plain, views, index)
    return partial(compiled, c_void_p(fleet.ctypes.data), c_int64(len(fleet)), c_int64(index))  # converted once
