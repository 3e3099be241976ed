# SPDX-License-Identifier: BSD-3-Clause
"""Frames of several times on their way out, so that the core goes on where nobody fetches each frame at its time.

A spool lies beside the port of a client that reads from a socket, or of a log. A client's holds its frames, one behind
the other; a log's holds each behind its Unix time, as a .tlog does (``sitl.logs.tlog``).
"""

from __future__ import annotations

from ...core.kernels import law
from ...core.memory import bytes_at, record_at
from ...core.records import Ints, Record, array
from .port import OUT, OUT_BYTES, OUT_FRAMES, SIZE, Port

STAMP = 8
"""Bytes of a time."""
SPOOL_BYTES = 1 << 16
_ENOUGH = SPOOL_BYTES - OUT_BYTES - STAMP * OUT_FRAMES
"""With more in it, what a port holds might not fit."""


class Spool(Record):
    """What a client or a log is sent."""

    used: int  # bytes that wait
    stamped: bool  # each frame stands behind its time
    frames: Ints = array(SPOOL_BYTES, stored="u1")


FRAMES = Spool.fields["frames"].offset


@law
def spill(port: Port, address: int, now_us: int) -> None:
    """Move the frames in a port, all of the time ``now_us`` since boot, to its spool, which has space for them."""
    spool = record_at(Spool, port.spool)
    source, target = bytes_at(address + OUT, OUT_BYTES), bytes_at(port.spool + FRAMES, SPOOL_BYTES)
    to, start = spool.used, 0
    for k in range(port.out_count):
        if spool.stamped:
            stamp = port.epoch_us + now_us
            for n in range(STAMP):
                target[to + n] = stamp >> (56 - 8 * n) & 0xFF
            to += STAMP
        end = port.out_end[k]
        for n in range(end - start):
            target[to + n] = source[start + n]
        to += end - start
        start = end
    spool.used = to
    port.out_count = 0
    port.out_size = 0


@law
def spill_all(ports: int, count: int, now_us: int) -> bool:
    """The same for all ports that have a spool; False: one of them is nearly full and has to be emptied."""
    has_space = True
    for k in range(count):
        address = ports + k * SIZE
        port = record_at(Port, address)
        if port.spool != 0:
            if port.out_count > 0:
                spill(port, address, now_us)
            if record_at(Spool, port.spool).used > _ENOUGH:
                has_space = False
    return has_space
