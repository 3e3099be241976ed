# SPDX-License-Identifier: BSD-3-Clause
"""Files that are whole, or as they were: written beside, then put in their place. Errors name the file meant."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from ..errors import SitlError


@contextlib.contextmanager
def whole_file(path: str | Path, error: type[SitlError] = SitlError, title: str = "") -> Iterator[Path]:
    """Where to write what becomes the file when the block ends without an error; else the file stays as it was.

    What is no file (a terminal, a pipe, ``/dev/stdout``) is written itself.

    Args:
        path: of the file; its folder must be there.
        error: of what is raised.
        title: what the file is, for the error ("mission 'x.waypoints'"); "": its path.

    Raises:
        SitlError: of the type ``error``: it cannot be written.
    """
    target = Path(path)
    beside = target
    try:
        target = Path(os.path.realpath(target))
        beside = target
        if target.is_file() or not target.exists():
            beside = target.with_name(f".{os.getpid()}.{target.name}")
        yield beside
        if beside != target:
            os.replace(beside, target)
    except OSError as fault:
        raise error(f"{title or path} cannot be written: {fault.strerror or fault}") from None
    finally:
        if beside != target:
            with contextlib.suppress(OSError):
                beside.unlink(missing_ok=True)


def write_whole(path: str | Path, content: bytes | str, error: type[SitlError] = SitlError, title: str = "") -> None:
    """Write a file whole, texts as UTF-8; see ``whole_file``."""
    with whole_file(path, error, title) as beside:
        beside.write_bytes(content.encode() if isinstance(content, str) else content)
