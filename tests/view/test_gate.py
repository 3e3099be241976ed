# SPDX-License-Identifier: BSD-3-Clause
"""The page's door to other machines lets in who knows the token, and nobody else."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator

import pytest

from sitl.cli import main
from sitl.view.gate import COOKIE, Gate, GateError

TOKEN = "a-token-of-some-length"


@pytest.fixture
def gate() -> Iterator[Gate]:
    """In front of a server that says back what it hears."""
    inside = socket.create_server(("127.0.0.1", 0))

    def echo() -> None:
        while True:
            try:
                connection = inside.accept()[0]
            except OSError:
                return
            with connection:
                while data := connection.recv(4096):
                    connection.sendall(data)

    threading.Thread(target=echo, daemon=True).start()
    gate = Gate("127.0.0.1", 0, TOKEN, inside.getsockname()[1])
    yield gate
    gate.close()
    inside.close()


def ask(gate: Gate, path: str, headers: str = "") -> bytes:
    with socket.create_connection(("127.0.0.1", gate.port), timeout=30.0) as connection:
        connection.sendall(f"GET {path} HTTP/1.1\r\nHost: x\r\n{headers}\r\n".encode())
        connection.shutdown(socket.SHUT_WR)
        answer = b""
        while data := connection.recv(4096):
            answer += data
        return answer


@pytest.mark.parametrize(
    ("path", "headers"),
    [
        ("/", ""),
        ("/?token=", ""),
        ("/?token=wrong", ""),
        (f"/?token={TOKEN}&token=x", ""),
        ("/", f"Cookie: {COOKIE}=wrong\r\n"),
    ],
)
def test_who_does_not_know_the_token_is_turned_away(gate: Gate, path: str, headers: str) -> None:
    assert ask(gate, path, headers).startswith(b"HTTP/1.1 403 ")


def test_who_knows_it_gets_a_cookie_and_passes_with_it(gate: Gate) -> None:
    answer = ask(gate, f"/?token={TOKEN}").decode()
    assert answer.startswith("HTTP/1.1 303 ") and "Location: /\r\n" in answer
    assert f"{COOKIE}={TOKEN}; HttpOnly; SameSite=Strict" in answer
    passed = ask(gate, "/somewhere", f"Origin: http://x\r\nCookie: other=1; {COOKIE}={TOKEN}\r\n")
    assert passed.startswith(b"GET /somewhere HTTP/1.1"), "the server inside has heard it, and its answer came back"
    assert b"\r\nHost: 127.0.0.1:" in passed and b"x" not in passed.split(b"Cookie")[0], "as from this machine"


def test_a_page_of_another_port_is_turned_away_with_its_cookie(gate: Gate) -> None:
    for origin in ("http://x:81", "null", "http://x\r\nOrigin: http://y"):
        answer = ask(gate, "/", f"Cookie: {COOKIE}={TOKEN}\r\nOrigin: {origin}\r\n")
        assert answer.startswith(b"HTTP/1.1 403 "), origin


def test_garbage_is_turned_away(gate: Gate) -> None:
    with socket.create_connection(("127.0.0.1", gate.port), timeout=30.0) as connection:
        connection.sendall(b"\x00\xff nonsense\r\n\r\n")
        assert connection.recv(100).startswith(b"HTTP/1.1 403 ")
    assert ask(gate, "//[").startswith(b"HTTP/1.1 403 ")


def test_tokens_that_are_none_are_named() -> None:
    for token in ("", "short", "with a space in it", "x" * 7):
        with pytest.raises(GateError, match="8 characters or more"):
            Gate("127.0.0.1", 0, token, 1)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--view", "--view-address", "0.0.0.0"], "go together"),
        (["--view", "--view-token", TOKEN], "go together"),
        (["--view-address", "0.0.0.0", "--view-token", TOKEN], "--view-address needs --view or --view-only"),
    ],
)
def test_an_address_needs_a_token_and_a_page(capsys: pytest.CaptureFixture[str], words: list[str], says: str) -> None:
    assert main(["run", "copter", *words]) == 2
    assert says in capsys.readouterr().err
