# SPDX-License-Identifier: BSD-3-Clause
"""What the processes that compile (``worker.py``) are told, in words of a command line."""

from __future__ import annotations

from typing import NamedTuple

from .shipped.objects import Objects

KERNELS_PATH = "kernels"
"""In place of the path of a record type: what is compiled are kernels."""
OBJECTS_OPTION = "--objects="


class Order(NamedTuple):
    """What a worker makes of what it compiles."""

    path: str
    """Of the record type, or ``KERNELS_PATH``."""
    objects: Objects | None = None
    """The object files to make; None: what this machine loads."""

    def arguments(self) -> list[str]:
        """Of the command line."""
        return [*([] if self.objects is None else [f"{OBJECTS_OPTION}{self.objects}"]), self.path]

    @classmethod
    def taken(cls, words: list[str]) -> tuple[Order, list[str]]:
        """The order that a command line begins with, and what follows it."""
        objects = None
        if words[0].startswith(OBJECTS_OPTION):
            objects = Objects.from_text(words[0].removeprefix(OBJECTS_OPTION))
            words = words[1:]
        return cls(words[0], objects), words[1:]
