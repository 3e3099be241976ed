# SPDX-License-Identifier: BSD-3-Clause
"""Pages of other sites cannot speak to the page's server: a browser would let them."""

from __future__ import annotations

import http.client
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")

from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from sitl.view import origins, page_library
from sitl.view.page import LOCAL, free_port


@pytest.fixture
def port() -> Iterator[int]:
    """Of a page's server."""
    server = page_library.serve(LOCAL, free_port(0), "test")
    yield int(server.get_port())
    page_library.stop(server)


def hear(port: int, origin: str | None, host: str = LOCAL) -> bytes:
    """The first message that a websocket gets; InvalidStatus: it is turned away."""
    version = page_library.viser().__version__
    with connect(f"ws://{LOCAL}:{port}", origin=origin, subprotocols=[f"viser-v{version}"], open_timeout=30) as socket:  # type: ignore[arg-type,list-item]
        return bytes(socket.recv(timeout=30))  # type: ignore[arg-type]


@pytest.mark.parametrize("origin", ["http://site.example", "null", "http://127.0.0.1:1", "http://site.example:{}"])
def test_another_sites_page_is_turned_away(port: int, origin: str) -> None:
    with pytest.raises(InvalidStatus) as caught:
        hear(port, origin.format(port))
    assert caught.value.response.status_code == 403


@pytest.mark.parametrize("origin", [None, "http://127.0.0.1:{}"])
def test_the_page_itself_and_programs_are_heard(port: int, origin: str | None) -> None:
    assert hear(port, origin and origin.format(port))


def test_a_name_that_another_site_may_have_is_turned_away(port: int) -> None:
    """A site whose name is made to mean 127.0.0.1 is, to a browser, of one origin with the server."""

    def status(host: str) -> int:
        connection = http.client.HTTPConnection(LOCAL, port, timeout=30)
        connection.putrequest("GET", "/", skip_host=True)
        connection.putheader("Host", host)
        connection.endheaders()
        return connection.getresponse().status

    assert [status(host) for host in (f"{LOCAL}:{port}", f"localhost:{port}", "localhost:8000")] == [200, 200, 200]
    assert [status(host) for host in (f"site.example:{port}", "[::1", "", f"127.0.0.1.site.example:{port}")] == 4 * [
        403
    ]


def test_servers_of_other_libraries_stay_as_they_are(port: int) -> None:
    from websockets.asyncio import server

    assert server.serve.__module__ == "websockets.asyncio.server", "what viser is given stays with it"


def test_a_viser_that_cannot_be_guarded_is_not_used(monkeypatch: pytest.MonkeyPatch) -> None:
    stopped: list[Any] = []

    class Other:
        """Listens in another way."""

        __version__ = "9.9"

        def ViserServer(self, **options: Any) -> Any:
            return "the server"

    monkeypatch.setattr(page_library, "viser", Other)
    monkeypatch.setattr(page_library, "stop", stopped.append)
    with pytest.raises(page_library.UnguardedError, match=r"viser 9\.9 takes whatever"):
        page_library.serve(LOCAL, 1, "test")
    assert stopped == ["the server"]


def test_an_origin_is_the_address_that_the_request_is_for() -> None:
    assert origins.is_own("localhost:80", []) and origins.is_own("Host:80", ["HTTP://host:80"])
    assert origins.is_own("a.example", ["https://a.example"])
    assert not origins.is_own("a.example", ["http://a.example.b"]) and not origins.is_own("a", ["http://a", "http://b"])
