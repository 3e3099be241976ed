# SPDX-License-Identifier: BSD-3-Clause
"""A way to the page from other machines: a door that asks each connection for a token, before the page's own server.

The server itself stays on 127.0.0.1 and knows nobody. Who opens the address with ``?token=...`` gets it as a cookie
that no other site's page can use (SameSite=Strict); connections that show it are passed on byte by byte, all others are
turned away. There is no encryption: on a network that is not trusted, tunnel it.
"""

from __future__ import annotations

import asyncio
import hmac
import socket
import threading
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs, urlsplit

from ..errors import SitlError
from .origins import is_own

COOKIE = "sitl_view"
LEAST = 8
"""Characters of a token."""
_HEAD_BYTES = 1 << 14
_HEAD_S = 10.0
"""Wall time that a connection has to say what it wants [s]."""


class GateError(SitlError, ValueError):
    """An address that the page cannot be offered at, or a token that is none."""


def check(host: str, port: int, token: str) -> None:
    """Whether a gate can be opened there now.

    Raises:
        GateError: the token is too short, or the address cannot be had.
    """
    check_token(token)
    try:
        family, *_, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
        with socket.socket(family, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # as asyncio's server does
            probe.bind(address)
    except OSError as error:
        raise _not_had(host, port, error) from None


def check_token(token: str) -> None:
    """GateError for a token that is easily guessed, or no part of an address."""
    if len(token) < LEAST or not (token.isascii() and token.replace("-", "").replace("_", "").isalnum()):
        raise GateError(f"--view-token: {LEAST} characters or more are needed, of letters, digits, - and _")


def _not_had(host: str, port: int, error: OSError) -> GateError:
    return GateError(f"--view-address {host}, port {port}: cannot be had: {error.strerror or error}")


class Gate:
    """Listens at an address of this machine.

    Args:
        host: of an interface; "0.0.0.0" for all.
        port: 0 takes a free one.
        token: what a visitor must know.
        target: port of the page on 127.0.0.1.

    Raises:
        GateError: the token is too short, or the address cannot be had.
    """

    def __init__(self, host: str, port: int, token: str, target: int) -> None:
        check_token(token)
        self._token, self._target = token, target
        self._loop = asyncio.new_event_loop()
        try:
            self._server = self._loop.run_until_complete(asyncio.start_server(self._visit, host, port))
        except OSError as error:
            self._loop.close()
            raise _not_had(host, port, error) from None
        self.port = int(self._server.sockets[0].getsockname()[1])
        self.address = f"http://{f'[{host}]' if ':' in host else host}:{self.port}/?token={token}"
        """What visitors open."""
        self._thread = threading.Thread(target=self._loop.run_forever, name="sitl-view-gate", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Let nobody in any more, and end all visits."""
        asyncio.run_coroutine_threadsafe(self._shut(), self._loop).result(timeout=5.0)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(timeout=5.0)
        self._loop.close()

    async def _shut(self) -> None:
        self._server.close()
        visits = [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]
        for task in visits:
            task.cancel()
        await asyncio.gather(*visits, return_exceptions=True)

    async def _visit(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            head = await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), _HEAD_S)
            answer = self.judge(head) if len(head) <= _HEAD_BYTES else refusal()
            if answer is None:
                await self._pass_on(head, reader, writer)
            else:
                writer.write(answer)
                await writer.drain()
        except (OSError, TimeoutError, asyncio.IncompleteReadError, asyncio.LimitOverrunError):
            pass  # it left, or never said anything
        finally:
            writer.close()

    def judge(self, head: bytes) -> bytes | None:
        """What to answer to the head of a request; None: let it pass."""
        lines = head.decode("latin-1").split("\r\n")
        words = lines[0].split(" ")
        if len(words) != 3:
            return refusal()
        try:
            url = urlsplit(words[1])
        except ValueError:
            return refusal()
        if self._is_right(*parse_qs(url.query).get("token", [""])):
            cookie = f"{COOKIE}={self._token}; HttpOnly; SameSite=Strict; Path=/"
            return _answer("303 See Other", "", f"Location: {url.path or '/'}\r\nSet-Cookie: {cookie}\r\n")
        headers = [
            (name.strip().lower(), value.strip()) for name, _, value in (line.partition(":") for line in lines[1:])
        ]
        shown, hosts, origins = (
            [v for name, v in headers if name == wanted] for wanted in ("cookie", "host", "origin")
        )
        try:
            cookies = SimpleCookie("; ".join(shown))
        except CookieError:
            return refusal()
        knows = COOKIE in cookies and self._is_right(cookies[COOKIE].value)
        return None if knows and len(hosts) == 1 and is_own(hosts[0], origins) else refusal()

    def _is_right(self, token: str, *more: str) -> bool:
        return not more and hmac.compare_digest(token.encode(), self._token.encode())

    def _as_from_here(self, head: bytes) -> bytes:
        """A request as the server inside gets it: for 127.0.0.1, and without the origin, which is judged already."""
        first, *lines = head.split(b"\r\n")
        kept = [line for line in lines if line.partition(b":")[0].strip().lower() not in (b"host", b"origin")]
        return b"\r\n".join([first, f"Host: 127.0.0.1:{self._target}".encode(), *kept])

    async def _pass_on(self, head: bytes, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        inner_reader, inner_writer = await asyncio.open_connection("127.0.0.1", self._target)
        inner_writer.write(self._as_from_here(head))
        inward = asyncio.create_task(_speak(reader, inner_writer))
        try:
            await _pump(inner_reader, writer)  # the server inside ends it, also when the visitor has said all
        finally:
            inward.cancel()
            await asyncio.gather(inward, return_exceptions=True)
            inner_writer.close()


async def _pump(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    while data := await reader.read(1 << 16):
        writer.write(data)
        await writer.drain()


async def _speak(visitor: asyncio.StreamReader, inside: asyncio.StreamWriter) -> None:
    """What the visitor says; then the server inside hears that it was all."""
    try:
        await _pump(visitor, inside)
        inside.write_eof()
    except OSError:
        inside.close()


def refusal() -> bytes:
    """To who has no token."""
    return _answer("403 Forbidden", "This page needs the token that sitl run --view-token was given: /?token=...\n")


def _answer(status: str, text: str, headers: str = "") -> bytes:
    return (
        f"HTTP/1.1 {status}\r\n{headers}Content-Type: text/plain\r\nContent-Length: {len(text)}\r\n"
        f"Connection: close\r\n\r\n{text}"
    ).encode()
