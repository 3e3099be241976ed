# SPDX-License-Identifier: BSD-3-Clause
"""Files and folders that clients make by MAVLink FTP: kept in memory, they last as long as the simulation.

Nothing of this computer's disks can be reached: a path is a name in this store, and none leads out of it.
"""

from __future__ import annotations

from typing import NamedTuple

MOST_BYTES, MOST_ENTRIES, LONGEST = 1 << 20, 1000, 200
"""Of all files together, of files and folders, and letters of a path."""
FAIL, FILE_EXISTS, PROTECTED, NOT_FOUND = 1, 8, 9, 10
"""Errors of MAVLink FTP."""
LOGS = "logs"
"""A folder that is the vehicle's, as those with @ are."""


class State(NamedTuple):
    """What is there: immutable."""

    folders: tuple[str, ...] = ()
    files: tuple[tuple[str, bytes], ...] = ()


class ClientFiles:
    """The store. Methods that change it return 0, or an error of MAVLink FTP."""

    def __init__(self) -> None:
        self._folders: set[str] = set()
        self._files: dict[str, bytes] = {}

    def state(self) -> State:
        """What is there now."""
        return State(tuple(sorted(self._folders)), tuple(self._files.items()))

    def restore(self, state: State) -> None:
        """Have what was there."""
        self._folders, self._files = set(state.folders), dict(state.files)

    def read(self, path: str) -> bytes | None:
        """The bytes of a file; None: there is none."""
        return self._files.get(path)

    def listing(self, folder: str) -> list[str] | None:
        """Entries of a folder ("" is the first), "DNAME" or "FNAME<tab>SIZE"; None: there is none."""
        if folder and folder not in self._folders:
            return None
        inside = folder + "/" if folder else ""
        folders = [f"D{name[len(inside) :]}" for name in sorted(self._folders) if _is_in(name, inside)]
        for name, data in sorted(self._files.items()):
            if _is_in(name, inside):
                folders.append(f"F{name[len(inside) :]}\t{len(data)}")
        return folders

    def create(self, path: str) -> int:
        """An empty file, also in place of one that there is."""
        error = self._refusal(path)
        if error or path in self._folders:
            return error or FAIL
        self._files[path] = b""
        return 0

    def write(self, path: str, data: bytes) -> int:
        """Have these bytes in a file."""
        others = sum(len(other) for name, other in self._files.items() if name != path)
        if path not in self._files:
            return NOT_FOUND
        if others + len(data) > MOST_BYTES:
            return FAIL
        self._files[path] = data
        return 0

    def make_folder(self, path: str) -> int:
        """A folder in one that there is."""
        error = self._refusal(path)
        if error or path in self._folders or path in self._files:
            return error or FILE_EXISTS
        self._folders.add(path)
        return 0

    def remove(self, path: str) -> int:
        """Without this file."""
        if path in self._files:
            del self._files[path]
            return 0
        return (FAIL if path in self._folders else 0) or _protected(path) or NOT_FOUND

    def remove_folder(self, path: str) -> int:
        """Without this folder, which must be empty."""
        if path not in self._folders:
            return (FAIL if path in self._files else 0) or _protected(path) or NOT_FOUND
        if self.listing(path):
            return FAIL
        self._folders.remove(path)
        return 0

    def rename(self, old: str, new: str) -> int:
        """A file or folder, with all that is in it, under another path; a file may take another one's place."""
        if old not in self._files and old not in self._folders:
            return _protected(old) or NOT_FOUND
        error = self._refusal(new)
        moves_folder = old in self._folders
        if error or new in self._folders or (moves_folder and (new in self._files or new.startswith(old + "/"))):
            return error or FAIL
        for name in [name for name in self._files if name == old or name.startswith(old + "/")]:
            self._files[new + name[len(old) :]] = self._files.pop(name)
        for name in [name for name in self._folders if name == old or name.startswith(old + "/")]:
            self._folders.remove(name)
            self._folders.add(new + name[len(old) :])
        return 0

    def _refusal(self, path: str) -> int:
        """Why nothing new can be at a path: an error, 0: it can."""
        if error := _protected(path):
            return error
        folder, _, name = path.rpartition("/")
        if not name or len(path) > LONGEST or any(part in ("", ".", "..") for part in path.split("/")):
            return FAIL
        if folder and folder not in self._folders:
            return NOT_FOUND
        is_new = path not in self._files and path not in self._folders
        return FAIL if is_new and len(self._files) + len(self._folders) >= MOST_ENTRIES else 0


def _protected(path: str) -> int:
    """An error for what is the vehicle's own, 0 else."""
    return PROTECTED if path.startswith("@") or path.split("/")[0] == LOGS else 0


def _is_in(name: str, folder: str) -> bool:
    """Whether a path is right in a folder, which ends with "/", or is ""."""
    return name.startswith(folder) and "/" not in name[len(folder) :]
