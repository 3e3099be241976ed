# SPDX-License-Identifier: BSD-3-Clause
"""The library that draws the page, loaded when a page is first opened."""

from __future__ import annotations

import contextlib
import importlib.util
import io
from typing import Any

from ..errors import MissingExtra


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
    """A server of viser. It prints its addresses, whatever it is told: not here.

    Raises:
        MissingExtra: it is not installed.
    """
    module = viser()
    with contextlib.redirect_stdout(io.StringIO()):
        return module.ViserServer(host=host, port=port, label=title, verbose=False)


def stop(server: Any) -> None:
    """Stop a server of viser, which says so, too."""
    with contextlib.redirect_stdout(io.StringIO()):
        server.stop()
