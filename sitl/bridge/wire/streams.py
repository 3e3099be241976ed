# SPDX-License-Identifier: BSD-3-Clause
"""What a client is sent regularly: which message, how often, when next.

Messages of equal interval fall on equal times, whole multiples of it since boot, so that the simulation is interrupted
as seldom as possible.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from ...core.kernels import law
from ...core.memory import record_at
from ...vehicle.record import Vehicle
from .frames import close_frame, has_space, open_frame
from .port import SIZE, STREAMS, Port, find_next

Builder = Callable[[int, Vehicle, Port, int], bool]


@law
def next_due(ports: int, count: int) -> int:
    """When the first of all regular messages of ``count`` ports is due [us since boot]."""
    soonest = 1 << 62
    for k in range(count):
        soonest = min(soonest, record_at(Port, ports + k * SIZE).next_us)
    return soonest


@law
def send(v: Vehicle, port: Port, address: int, number: int, build: Builder) -> bool:
    """Send a message now, with all its parts; False: there was no space for it, or for the rest of it."""
    while True:
        if not has_space(port):
            return False
        if build(number, v, port, open_frame(port, address)):
            close_frame(port, address, number)
        if port.part == 0:
            return True


@law
def send_due(v: Vehicle, port: Port, address: int, build: Builder) -> bool:
    """Send what has fallen due, each message once however late it is.

    False: the space for frames ran out, or the next one is the shell's; the rest is still due.
    """
    now = v.time_us
    for k in range(port.stream_count):
        if port.stream_due_us[k] > now:
            continue
        if not port.congested:
            if port.stream_by_shell[k] != 0 or not send(v, port, address, port.stream_number[k], build):
                find_next(port)
                return False
        interval = port.stream_us[k]
        port.stream_due_us[k] = (now // interval + 1) * interval
    find_next(port)
    return True


@law
def send_all_due(v: Vehicle, ports: int, count: int, build: Builder) -> bool:
    """The same for every port, in their order."""
    for k in range(count):
        address = ports + k * SIZE
        port = record_at(Port, address)
        if port.next_us <= v.time_us and not send_due(v, port, address, build):
            return False
    return True


# ---------------------------------------------------------------------- the shell's side


def interval_of(port: Port, number: int) -> int:
    """Interval of a message [us], 0 when it is not sent."""
    for k in range(port.stream_count):
        if port.stream_number[k] == number:
            return int(port.stream_us[k])
    return 0


def set_interval(port: Port, number: int, interval_us: int, now_us: int, by_shell: bool) -> None:
    """Send a message every ``interval_us``, beginning at the next whole multiple; 0 stops it.

    Raises:
        ValueError: more than ``STREAMS`` messages.
    """
    if interval_of(port, number) == interval_us:
        return
    rows = [row for row in _rows(port) if row[0] != number]
    if interval_us:
        due = next((row[2] for row in rows if row[1] == interval_us), (now_us // interval_us + 1) * interval_us)
        behind = sum(row[1] <= interval_us for row in rows)
        rows.insert(behind, (number, interval_us, due, int(by_shell)))
    _write(port, rows)


def time_was_set(port: Port, now_us: int) -> None:
    """Time was set to ``now_us``: everything is due at its next whole multiple from there."""
    _write(port, [(n, every, (now_us // every + 1) * every, by_shell) for n, every, _, by_shell in _rows(port)])


def put_off(port: Port, number: int, now_us: int) -> None:
    """A message that was due has been dealt with."""
    _write(
        port, [(n, every, (now_us // every + 1) * every if n == number else due, s) for n, every, due, s in _rows(port)]
    )


def first_due(port: Port, now_us: int) -> tuple[int, bool]:
    """(Number of the first message due by ``now_us``, whether the shell builds it); there is one."""
    return next((number, bool(by_shell)) for number, _, due, by_shell in _rows(port) if due <= now_us)


def _rows(port: Port) -> list[tuple[int, int, int, int]]:
    columns = (port.stream_number, port.stream_us, port.stream_due_us, port.stream_by_shell)
    n = port.stream_count
    return list(zip(*(column[:n].tolist() for column in columns), strict=True))


def _write(port: Port, rows: Iterable[Sequence[int]]) -> None:
    table = list(rows)
    if len(table) > STREAMS:
        raise ValueError(f"a client can be sent {STREAMS} messages regularly, not {len(table)}")
    port.stream_count = len(table)
    for column, values in zip(
        (port.stream_number, port.stream_us, port.stream_due_us, port.stream_by_shell), zip(*table), strict=False
    ):
        column[: len(table)] = values
    find_next(port)
