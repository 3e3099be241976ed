# SPDX-License-Identifier: BSD-3-Clause
"""A connection that leads back to itself is none."""

from __future__ import annotations

import socket

import pytest

from sitl.bridge.links.tcp import refuse_echo


def test_a_connection_with_itself_is_refused() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as own:
        own.bind(("127.0.0.1", 0))
        own.connect(own.getsockname())  # nobody listens there
        with pytest.raises(ConnectionRefusedError):
            refuse_echo(own)
        assert own.fileno() == -1


def test_a_connection_with_another_is_left() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen(1)
        with socket.create_connection(listener.getsockname()) as own:
            refuse_echo(own)
            assert own.fileno() >= 0
