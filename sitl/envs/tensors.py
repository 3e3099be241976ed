# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of other libraries on the memory of NumPy's: observations for PyTorch and JAX, actions from them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium.error import InvalidAction

from sitl.errors import MissingExtra

from .options import unknown

ALIGNED = 64
"""JAX takes memory as it is from addresses that are multiples of this, and copies other memory [bytes]."""


def rows(count: int, columns: int, dtype: Any = np.float32) -> npt.NDArray[Any]:
    """A new array, shape (count, columns), not written yet; of two robots on, JAX takes it as it is."""
    if count == 1:
        return np.empty((count, columns), dtype)
    size = count * columns * np.dtype(dtype).itemsize
    held = np.empty(size + ALIGNED, np.uint8)
    first = -held.__array_interface__["data"][0] % ALIGNED
    return held[first : first + size].view(dtype).reshape(count, columns)


def _torch() -> Callable[[Any], Any]:
    try:
        from torch import from_numpy
    except ImportError as error:
        raise MissingExtra(f'array = "torch" needs PyTorch ({error}): pip install torch') from None
    return from_numpy


def _jax() -> Callable[[Any], Any]:
    try:
        from jax.dlpack import from_dlpack
    except ImportError as error:
        raise MissingExtra(f'array = "jax" needs JAX ({error}): pip install jax') from None
    return from_dlpack


ARRAYS: dict[str, Callable[[], Callable[[Any], Any]] | None] = {"numpy": None, "torch": _torch, "jax": _jax}
"""Names of libraries."""


def converter(library: str) -> Callable[[Any], Any] | None:
    """A function that gives an array, or a dict of such, as this library has them; None: NumPy's stay.

    Raises:
        EnvOptionError: no such library is known.
        MissingExtra: it is not installed.
    """
    if not isinstance(library, str) or library not in ARRAYS:
        raise unknown("array", library, ARRAYS)
    load = ARRAYS[library]
    if load is None:
        return None
    convert = load()

    def converted(value: Any) -> Any:
        return {name: convert(each) for name, each in value.items()} if isinstance(value, dict) else convert(value)

    return converted


def as_numpy(actions: Any) -> Any:
    """Actions of another library as NumPy's array on the same memory; what has no DLPack stays as it is.

    Raises:
        InvalidAction: the memory is another device's, or the array needs a gradient.
    """
    if not hasattr(actions, "__dlpack__"):
        return actions
    try:
        return np.from_dlpack(actions)
    except (BufferError, RuntimeError, TypeError, ValueError) as error:
        raise InvalidAction(f"actions of {type(actions)!r}: {error}; they must be in the processor's memory, without a "
                            "gradient") from None  # fmt: skip
