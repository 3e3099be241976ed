# SPDX-License-Identifier: BSD-3-Clause
"""On-board logs, as services see them; ``sitl.logs.dataflash`` keeps them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol


class LogEntry(Protocol):
    """A log that there is."""

    @property
    def number(self) -> int:
        """From 1 on."""
        ...

    @property
    def time_utc(self) -> int:
        """When it began [s, Unix]."""
        ...

    @property
    def size(self) -> int:
        """[bytes]"""
        ...


class LogStore(Protocol):
    """Where the logs are."""

    def entries(self) -> Sequence[LogEntry]:
        """All logs, with everything up to now in them."""
        ...

    def read(self, number: int, offset: int, count: int) -> bytes:
        """Bytes of a log; fewer at its end."""
        ...

    def erase(self) -> None:
        """Forget all logs."""
        ...

    def close(self) -> None:
        """Write everything; no more is logged."""
        ...
