# SPDX-License-Identifier: BSD-3-Clause
"""The page's door to other machines lets in who knows the token, and nobody else."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from pathlib import Path

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
        (["--view-port", "8080"], "--view-port needs --view or --view-only"),
        (["--view", "--view-address", "127.0.0.1", "--view-token", "short"], "8 characters or more"),
        (["--view", "--view-address", "192.0.2.1", "--view-token", TOKEN], "192.0.2.1, port 0: cannot be had"),
    ],
)
def test_a_page_that_cannot_be_is_refused_before_anything_is_written(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, words: list[str], says: str
) -> None:
    assert main(["run", "copter", "--rec", f"{tmp_path}/a.rec", "--log-dir", f"{tmp_path}/logs", *words]) == 2
    assert says in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_port_that_is_taken_is_refused_before_anything_is_written(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        words = ["--view", "--view-port", port, "--rec", f"{tmp_path}/a.rec", "--log-dir", f"{tmp_path}/logs"]
        assert main(["run", "copter", *words]) == 2
    assert f"port {port} for the page cannot be had" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_an_address_of_ip_version_6_is_written_as_browsers_read_it() -> None:
    try:
        gate = Gate("::1", 0, TOKEN, 1)
    except GateError:
        pytest.skip("this machine has no IPv6")
    try:
        assert gate.address == f"http://[::1]:{gate.port}/?token={TOKEN}"
    finally:
        gate.close()
