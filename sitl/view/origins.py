# SPDX-License-Identifier: BSD-3-Clause
"""Who may speak to the page's server on this machine: browsers that show the page itself, and programs.

A browser lets any site open a websocket to 127.0.0.1, and says in ``Origin`` which site it was. Without a look at it
every page that somebody reads while a vehicle is shown could press the page's buttons.
"""

from __future__ import annotations

import http
from collections.abc import Callable, Sequence
from typing import Any
from urllib.parse import urlsplit

_HERE = ("127.0.0.1", "localhost", "::1")
ProcessRequest = Callable[[Any, Any], Any]
"""Of websockets: connection and request -> the answer to who is turned away, else None."""


def is_welcome(headers: Any) -> bool:
    """Whether a request comes from the page itself, or from no browser.

    It must be for this machine by a name that no other site can have (``Host``), and its origin, where a browser says
    one, the address that it is for. A tunnel keeps both.

    Args:
        headers: of the request; ``get_all`` gives the values of one.
    """
    hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
    if len(hosts) != 1 or len(origins) > 1:
        return False
    try:
        if urlsplit(f"//{hosts[0]}").hostname not in _HERE:
            return False
    except ValueError:
        return False
    return is_own(hosts[0], origins)


def is_own(host: str, origins: Sequence[str]) -> bool:
    """Whether a request's origins, none or one, are the address that it is for."""
    return all(origin.lower() in (f"http://{host}".lower(), f"https://{host}".lower()) for origin in origins)


def guarded(process: ProcessRequest | None) -> ProcessRequest:
    """``process``, for those who are welcome; others get 403."""

    def look(connection: Any, request: Any) -> Any:
        if not is_welcome(request.headers):
            return connection.respond(http.HTTPStatus.FORBIDDEN, "This server is for its own page alone.\n")
        return None if process is None else process(connection, request)

    return look
