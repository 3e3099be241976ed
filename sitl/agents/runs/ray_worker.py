# SPDX-License-Identifier: BSD-3-Clause
"""The far side of ``on_ray``: does the work for one item after another, in folders of its own."""

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
from . import parcels
from .config import versions
from .local import Work, sendable

Message = tuple[str, Any]
"""("told", message), ("files", (number of the path, changes)), ("done", result) or ("raised", error)."""
_SYNC_S = 0.1
"""Wall time between two looks at what has changed."""
_WAIT_S = 0.5
"""For how long ``messages`` waits for the first one [s]."""


def libraries() -> dict[str, str]:
    """Versions of what results depend on; of deep agents' libraries where they are installed."""
    return versions(*(name for name in LIBRARIES if _installed(name)))


def _installed(name: str) -> bool:
    try:
        return bool(metadata.version(name))
    except metadata.PackageNotFoundError:
        return False


class Worker:
    """Works in a thread, so that it can be asked and told meanwhile."""

    def __init__(self) -> None:
        self._messages: SimpleQueue[Message] = SimpleQueue()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def begin(self, work: Work, item: Any, contents: Sequence[parcels.Content | bytes]) -> list[Message]:
        """Begin with an item.

        Args:
            work: see ``local.Work``.
            item: whose paths are those of the other machine.
            contents: of these, as ``parcels.paths_of`` lists them.

        Returns:
            no messages yet.
        """
        self._stop.clear()
        self._thread = threading.Thread(target=self._work, args=(work, item, contents), daemon=True)
        self._thread.start()
        return []

    def messages(self) -> list[Message]:
        """Those since the last call; waits a moment for the first."""
        try:
            found = [self._messages.get(timeout=_WAIT_S)]
        except Empty:
            return []
        while not self._messages.empty():
            found.append(self._messages.get())
        return found

    def stop(self) -> None:
        """Ask the work to end early."""
        self._stop.set()

    def close(self) -> None:
        """The same, and wait a moment until it has."""
        self.stop()
        if self._thread is not None:
            self._thread.join(2.0)

    def _work(self, work: Work, item: Any, contents: Sequence[parcels.Content | bytes]) -> None:
        places: dict[Path, Path] = {}
        try:
            with tempfile.TemporaryDirectory(prefix="sitl-") as root:
                for number, (path, content) in enumerate(zip(parcels.paths_of(item), contents)):
                    places[path] = Path(root, str(number), path.name or "folder")
                    parcels.unpack(places[path], content)
                sync = _Sync(list(places.values()), self._messages)

                def tell(message: Any) -> None:
                    self._messages.put(("told", message))
                    sync.now_and_then()

                def stopped() -> bool:
                    sync.now_and_then()
                    return self._stop.is_set()

                try:
                    message = ("done", work(parcels.moved(item, places), tell, stopped))
                finally:
                    sync.now()
            self._messages.put(message)
        except BaseException as error:  # whatever ends this thread must be known on the other side
            for path, place in places.items():  # which knows its own folder, not this one
                error.args = tuple(a.replace(str(place), str(path)) if isinstance(a, str) else a for a in error.args)
            known = sendable(error) if isinstance(error, Exception) else RuntimeError(repr(error))
            self._messages.put(("raised", known))


class _Sync:
    """Sends what has changed in folders. Called by the work's own thread only, between its episodes: so that what is
    sent is what an interrupted run leaves on a disk."""

    def __init__(self, folders: Sequence[Path], messages: SimpleQueue[Message]) -> None:
        self._mirrored = [parcels.Mirrored(folder) for folder in folders]
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
