# SPDX-License-Identifier: BSD-3-Clause
"""Contents and changes of folders, for workers on machines that share no file system."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from .files import write_bytes

Content = dict[str, bytes]
"""Path below the folder -> content."""
Changes = dict[str, bytes | None]
"""The same for new and changed files; None: the file was deleted."""


def read(path: Path) -> Content | bytes:
    """Contents of a folder, recursively and without hidden files; empty when there is no such folder. Of a file: its
    bytes."""
    return path.read_bytes() if path.is_file() else {name: found.read_bytes() for name, found in _files(path)}


def unpack(path: Path, content: Content | bytes) -> None:
    """Write to ``path`` what ``read`` returned elsewhere."""
    if isinstance(content, bytes):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
        return
    path.mkdir(parents=True, exist_ok=True)
    write(path, content)


def write(folder: Path, changes: Mapping[str, bytes | None]) -> None:
    """Write or delete files in this order, each one atomically.

    Raises:
        AgentError: one cannot be written.
    """
    for name, content in changes.items():
        path = folder / name
        if content is None:
            path.unlink(missing_ok=True)
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, content)


class Mirrored:
    """Detects changes in a folder. Call ``changes`` only while nobody writes into it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._stamps = self._now()

    def changes(self) -> Changes:
        """Changes since the last call, in the order of writing; logs first, because a log may be ahead of its model but
        never behind."""
        now = self._now()
        gone: Changes = {name: None for name in self._stamps if name not in now}
        changed = [name for name, stamp in now.items() if self._stamps.get(name) != stamp]
        changed.sort(key=lambda name: (not name.endswith(".csv"), now[name]))
        self._stamps = now
        return {**gone, **{name: (self._folder / name).read_bytes() for name in changed}}

    def _now(self) -> dict[str, tuple[int, int, int]]:
        """Modification time [ns], inode and size [bytes] of each file; a replaced file has another inode."""
        found = ((name, path.stat()) for name, path in _files(self._folder))
        return {name: (stat.st_mtime_ns, stat.st_ino, stat.st_size) for name, stat in found}


def _files(folder: Path) -> Iterator[tuple[str, Path]]:
    for root, inner, names in os.walk(folder):
        inner[:] = [name for name in inner if not name.startswith(".")]
        for name in names:
            if not name.startswith("."):  # a hidden file is not written completely yet
                path = Path(root, name)
                yield path.relative_to(folder).as_posix(), path


def paths_of(item: Any) -> list[Path]:
    """Folders and files that an item names: each distinct ``Path`` in it, also within tuples, lists, dicts and
    dataclasses."""
    return list(dict.fromkeys(_paths(item)))


def moved(item: Any, folders: Mapping[Path, Path]) -> Any:
    """A copy of an item in which paths are replaced as ``folders`` says."""
    if next(_paths(item), None) is None:
        return item
    if isinstance(item, Path):
        return folders.get(item, item)
    if isinstance(item, tuple | list):
        parts = [moved(part, folders) for part in item]
        return type(item)(*parts) if hasattr(item, "_fields") else type(item)(parts)
    if isinstance(item, dict):
        return {name: moved(part, folders) for name, part in item.items()}
    if dataclasses.is_dataclass(item) and not isinstance(item, type):
        fields = [field.name for field in dataclasses.fields(item) if field.init]
        return dataclasses.replace(item, **{name: moved(getattr(item, name), folders) for name in fields})
    return item


def _paths(item: Any) -> Iterator[Path]:
    if isinstance(item, Path):
        yield item
    elif isinstance(item, tuple | list):
        for part in item:
            yield from _paths(part)
    elif isinstance(item, dict):
        yield from _paths(tuple(item.values()))
    elif dataclasses.is_dataclass(item) and not isinstance(item, type):
        yield from _paths(tuple(getattr(item, f.name) for f in dataclasses.fields(item) if f.init))
