# SPDX-License-Identifier: BSD-3-Clause
"""Folders that travel between machines which share none: what is in them, what has changed since."""

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
"""The same of files that are new or changed; None: it is gone."""


def read(path: Path) -> Content | bytes:
    """All files of a folder and of those in it, but for hidden ones; none of a folder that is not there. Of a file its
    bytes."""
    return path.read_bytes() if path.is_file() else {name: found.read_bytes() for name, found in _files(path)}


def unpack(path: Path, content: Content | bytes) -> None:
    """Put there what was read elsewhere."""
    if isinstance(content, bytes):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
        return
    path.mkdir(parents=True, exist_ok=True)
    write(path, content)


def write(folder: Path, changes: Mapping[str, bytes | None]) -> None:
    """Put files in their place, in this order, each whole or not at all.

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
    """A folder whose changes are asked for now and then, while nobody writes in it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._stamps = self._now()

    def changes(self) -> Changes:
        """Since the last call, in the order in which they were written; logs first, which may know more than the
        model beside them, but not less."""
        now = self._now()
        gone: Changes = {name: None for name in self._stamps if name not in now}
        changed = [name for name, stamp in now.items() if self._stamps.get(name) != stamp]
        changed.sort(key=lambda name: (not name.endswith(".csv"), now[name]))
        self._stamps = now
        return {**gone, **{name: (self._folder / name).read_bytes() for name in changed}}

    def _now(self) -> dict[str, tuple[int, int, int]]:
        """Of each file: when it was written, which it is, and how long. A replaced file is another one."""
        found = ((name, path.stat()) for name, path in _files(self._folder))
        return {name: (stat.st_mtime_ns, stat.st_ino, stat.st_size) for name, stat in found}


def _files(folder: Path) -> Iterator[tuple[str, Path]]:
    for place, inner, names in os.walk(folder):
        inner[:] = [name for name in inner if not name.startswith(".")]
        for name in names:
            if not name.startswith("."):  # half written
                path = Path(place, name)
                yield path.relative_to(folder).as_posix(), path


def paths_of(item: Any) -> list[Path]:
    """The folders and files that an item of work names: each ``Path`` that it is or has in tuples, lists, mappings and
    dataclasses, once."""
    return list(dict.fromkeys(_paths(item)))


def moved(item: Any, places: Mapping[Path, Path]) -> Any:
    """The same item with other paths in their place."""
    if next(_paths(item), None) is None:
        return item
    if isinstance(item, Path):
        return places.get(item, item)
    if isinstance(item, tuple | list):
        parts = [moved(part, places) for part in item]
        return type(item)(*parts) if hasattr(item, "_fields") else type(item)(parts)
    if isinstance(item, dict):
        return {name: moved(part, places) for name, part in item.items()}
    if dataclasses.is_dataclass(item) and not isinstance(item, type):
        fields = [field.name for field in dataclasses.fields(item) if field.init]
        return dataclasses.replace(item, **{name: moved(getattr(item, name), places) for name in fields})
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
