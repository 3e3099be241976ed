# SPDX-License-Identifier: BSD-3-Clause
"""A TCP connection that leads back to itself.

Who tries to connect to a port of this machine where nobody listens yet gets, once in some ten thousand times, that very
port as its own, and is connected with itself: it would hear its own words, and keep the port from whom it waits for.
"""

from __future__ import annotations

import errno
import os
import socket


def refuse_echo(connection: socket.socket) -> None:
    """Check a connection that was just made.

    Raises:
        ConnectionRefusedError: it leads to itself: nobody listens there. It is closed.
    """
    if connection.getsockname() == connection.getpeername():
        connection.close()
        raise ConnectionRefusedError(errno.ECONNREFUSED, os.strerror(errno.ECONNREFUSED))
