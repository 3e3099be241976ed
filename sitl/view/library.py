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
    """A server of viser that turns away other sites' pages (``origins``). It prints its addresses, whatever it is told:
    not here.

    Raises:
        MissingExtra: it is not installed.
        UnguardedError: this version of it cannot be guarded.
    """
    module = viser()
    with contextlib.redirect_stdout(io.StringIO()), _guarded() as listening:
        server = module.ViserServer(host=host, port=port, label=title, verbose=False)
    if not listening:
        stop(server)
        raise UnguardedError(
            f"viser {module.__version__} lets every site press the page's buttons; viser 1.1.1 does not"
        )
    return server


@contextlib.contextmanager
def _guarded() -> Iterator[list[Any]]:
    """Meanwhile servers that viser begins ask ``origins`` first; gives a list of these. It takes no such option."""
    from websockets.asyncio import server as websockets

    listening: list[Any] = []
    plain: Any = websockets.serve

    class Guarded(plain):  # type: ignore[misc]
        """Of any other library: as ever."""

        def __init__(self, handler: Any, *args: Any, **options: Any) -> None:
            if handler.__module__.startswith("viser."):
                options["process_request"] = guarded(options.get("process_request"))
                listening.append(self)
            super().__init__(handler, *args, **options)

    with _LOCK:
        websockets.serve = Guarded  # type: ignore[misc]
        try:
            yield listening
        finally:
            websockets.serve = plain  # type: ignore[misc]


_LOCK = threading.Lock()


def stop(server: Any) -> None:
    """Stop a server of viser, which says so, too."""
    with contextlib.redirect_stdout(io.StringIO()):
        server.stop()
