# SPDX-License-Identifier: BSD-3-Clause
"""A disk that is full for a moment: the system refuses to make files longer than so many bytes."""

from __future__ import annotations

import contextlib
import resource
from collections.abc import Iterator

WORDS = "File too large"
"""What the system says of it (of a full disk: "No space left on device")."""


@contextlib.contextmanager
def full_disk(room: int = 0) -> Iterator[None]:
    """No file of this process can be written beyond ``room`` bytes."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
