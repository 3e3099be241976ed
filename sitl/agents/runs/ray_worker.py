# SPDX-License-Identifier: BSD-3-Clause
"""The worker's side of ``on_ray``: works on one item after another, in temporary folders."""

from __future__ import annotations

import tempfile
import threading
import time
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

from ..deep.library import LIBRARIES
from . import cores, transfer
from .config import versions
from .local import Work, sendable

Message = tuple[str, Any]
"""("progress", message), ("files", (number of the path, changes)), ("done", result) or ("raised", error)."""
_SYNC_S = 0.1
"""Wall time between two checks for changed files [s]."""
_WAIT_S = 0.5
"""Time that ``messages`` waits for the first message [s]."""


def libraries() -> dict[str, str]:
    """Versions of the libraries that results depend on; those of deep agents where they are installed."""
    return versions(*(name for name in LIBRARIES if _installed(name)))


def _installed(name: str) -> bool:
    try:
        return bool(metadata.version(name))
    except metadata.PackageNotFoundError:
        return False


class Worker:
    """Runs work in a thread, so that messages can be read and a stop requested meanwhile."""

    def __init__(self) -> None:
        self._messages: SimpleQueue[Message] = SimpleQueue()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        cores.share_among(cores.count())  # Ray gives a worker one

    def begin(self, work: Work, item: Any, contents: Sequence[transfer.Content | bytes]) -> list[Message]:
        """Start an item.

        Args:
            work: see ``local.Work``.
            item: with the paths of the sending machine.
            contents: contents of these paths, in the order of ``transfer.paths_of``.

        Returns:
            an empty list: no messages yet.
        """
        self._stop.clear()
        self._thread = threading.Thread(target=self._work, args=(work, item, contents), daemon=True)
        self._thread.start()
        return []

    def messages(self) -> list[Message]:
        """Messages since the last call; waits up to 0.5 s for the first."""
        try:
            found = [self._messages.get(timeout=_WAIT_S)]
        except Empty:
            return []
        while not self._messages.empty():
            found.append(self._messages.get())
        return found

    def stop(self) -> None:
        """Request the work to end early."""
        self._stop.set()

    def close(self) -> None:
        """Request the work to end early, and wait up to 2 s for it."""
        self.stop()
        if self._thread is not None:
            self._thread.join(2.0)

    def _work(self, work: Work, item: Any, contents: Sequence[transfer.Content | bytes]) -> None:
        folders: dict[Path, Path] = {}
        try:
            with tempfile.TemporaryDirectory(prefix="sitl-") as root:
                for number, (path, content) in enumerate(zip(transfer.paths_of(item), contents)):
                    folders[path] = Path(root, str(number), path.name or "folder")
                    transfer.unpack(folders[path], content)
                sync = _Sync(list(folders.values()), self._messages)

                def send_progress(message: Any) -> None:
                    self._messages.put(("progress", message))
                    sync.now_and_then()

                def stopped() -> bool:
                    sync.now_and_then()
                    return self._stop.is_set()

                try:
                    message = ("done", work(transfer.moved(item, folders), send_progress, stopped))
                finally:
                    sync.now()
            self._messages.put(message)
        except BaseException as error:  # any end of this thread is reported to the other side
            for path, folder in folders.items():  # messages name the folders of the sending machine
                error.args = tuple(a.replace(str(folder), str(path)) if isinstance(a, str) else a for a in error.args)
            known = sendable(error) if isinstance(error, Exception) else RuntimeError(repr(error))
            self._messages.put(("raised", known))


class _Sync:
    """Sends the changed files of folders. Only the thread of the work calls it, between episodes: the files sent are a
    state that an interrupted run leaves."""

    def __init__(self, folders: Sequence[Path], messages: SimpleQueue[Message]) -> None:
        self._mirrored = [transfer.Mirrored(folder) for folder in folders]
        self._messages = messages
        self._last = time.monotonic()

    def now_and_then(self) -> None:
        if time.monotonic() - self._last > _SYNC_S:
            self.now()

    def now(self) -> None:
        for number, folder in enumerate(self._mirrored):
            changes = folder.changes()
            if changes:
                self._messages.put(("files", (number, changes)))
        self._last = time.monotonic()
