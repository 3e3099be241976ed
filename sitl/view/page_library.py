# SPDX-License-Identifier: BSD-3-Clause
"""The library that draws the page, loaded when a page is first opened."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import threading
from collections.abc import Iterator
from typing import Any

from ..errors import MissingExtra, SitlError
from .incoming import LONGEST, Visit
from .origins import guarded


class UnguardedError(SitlError, RuntimeError):
    """The library's server lets in who it should not."""


def is_installed() -> bool:
    """Whether the library is there."""
    return importlib.util.find_spec("viser") is not None


def require() -> None:
    """Check that the library is installed, without importing it.

    Raises:
        MissingExtra: it is not.
    """
    if not is_installed():
        raise MissingExtra("the page in the browser needs viser: pip install 'gym-sitl[view]'")


def viser() -> Any:
    """The module.

    Raises:
        MissingExtra: it is not installed.
    """
    require()
    import viser

    return viser


def serve(host: str, port: int, title: str) -> Any:
    """A server of viser that turns away other sites' pages (``origins``), and of its own pages' messages takes those
    that pass (``incoming``). It prints its addresses, whatever its options say: not here.

    Raises:
        MissingExtra: it is not installed.
        UnguardedError: this version of it cannot be guarded.
    """
    module = viser()
    with contextlib.redirect_stdout(io.StringIO()), _guarded() as doors:
        server = module.ViserServer(host=host, port=port, label=title, verbose=False)
    if not doors or not isinstance(getattr(server.gui, _WIDGETS, None), dict):
        stop(server)
        raise UnguardedError(f"viser {module.__version__} takes whatever a browser sends; viser 1.1.1 can be guarded")
    for door in doors:
        door.server = server
    return server


_WIDGETS = "_gui_input_handle_from_uuid"
"""Where viser keeps its widgets by what browsers call them."""


class _Door:
    """Lets visits into a server, once there is one."""

    server: Any = None

    def widget(self, uuid: str) -> Any:
        """A widget by its identifier; None: there is none."""
        return None if self.server is None else getattr(self.server.gui, _WIDGETS).get(uuid)

    def report(self, visit: Any, text: str) -> None:
        """Show a browser what was refused."""
        visits = getattr(getattr(self.server, "_websock_server", None), "_live_connections", {})
        clients = self.server.get_clients() if self.server is not None else {}
        for number, each in list(visits.items()):
            if each is visit and number in clients:
                note(clients[number], text)


def note(client: Any, text: str, title: str = "Not done") -> None:
    """Show a note in a browser, for a while."""
    client.add_notification(title, text, auto_close_seconds=8.0, color="red")


@contextlib.contextmanager
def _guarded() -> Iterator[list[_Door]]:
    """Meanwhile servers that viser begins ask ``origins`` first, and get messages by way of ``incoming``; gives their
    doors. It takes no such option."""
    import msgspec.msgpack
    from websockets.asyncio import server as websockets

    doors: list[_Door] = []
    plain: Any = websockets.serve

    class Guarded(plain):  # type: ignore[misc]
        """Of any other library: as ever."""

        def __init__(self, handler: Any, *args: Any, **options: Any) -> None:
            if handler.__module__.startswith("viser."):
                options["process_request"] = guarded(options.get("process_request"))
                options["max_size"] = LONGEST
                door, inner = _Door(), handler
                doors.append(door)

                async def handler(connection: Any) -> None:
                    await inner(Visit(connection, msgspec.msgpack.decode, door.widget, door.report))

            super().__init__(handler, *args, **options)

    with _LOCK:
        websockets.serve = Guarded  # type: ignore[misc]
        try:
            yield doors
        finally:
            websockets.serve = plain  # type: ignore[misc]


_LOCK = threading.Lock()


def stop(server: Any) -> None:
    """Stop a server of viser, which says so, too."""
    with contextlib.redirect_stdout(io.StringIO()):
        server.stop()
