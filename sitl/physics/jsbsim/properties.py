# SPDX-License-Identifier: BSD-3-Clause
"""The properties of a JSBSim executive as functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..engine import EngineError


class Properties:
    """Properties by name; looked up once, a read or write takes 0.1 us."""

    def __init__(self, executive: Any) -> None:
        self._tree = executive.get_property_manager()

    def _node(self, name: str) -> Any:
        node = self._tree.get_node(name)
        if node is None:
            raise EngineError(f"JSBSim has no property {name!r}")
        return node

    def reader(self, name: str) -> Callable[[], float]:
        """A function that reads it."""
        read: Callable[[], float] = self._node(name).get_double_value
        return read

    def writer(self, name: str) -> Callable[[float], None]:
        """A function that writes it."""
        write: Callable[[float], None] = self._node(name).set_double_value
        return write
