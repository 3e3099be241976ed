# SPDX-License-Identifier: BSD-3-Clause
"""Log download (LOG_*): lists the on-board logs and sends their bytes, also of the one that is being written.

Source: https://mavlink.io/en/messages/common.html#LOG_REQUEST_LIST and what ArduPilot does: without logs the list is
one entry with num_logs 0, a piece shorter than 90 bytes ends a transfer, a new request for the same channel replaces
the one under way. Unlike ArduPilot's, logs can be had while armed, and several small requests, by which a client fills
the gaps that a bad link has left, are answered one after the other.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ...core.constants import NEVER
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from .service import Handler, Service

ENTRY, DATA = message("LOG_ENTRY"), message("LOG_DATA")
PIECE = 90
"""Bytes of one LOG_DATA."""
EVERY_US = 2_500
PIECES = 20
"""So many pieces go out every 2.5 ms of simulated time: 720 kB/s (ArduPilot's SITL does about as much)."""
SMALL = PIECES * PIECE
"""A request for no more than so many bytes replaces none."""
MOST_REQUESTS = 128
"""As many of them wait; what is more is not answered."""


class _Transfer(NamedTuple):
    number: int
    offset: int
    left: int


class LogDownloadService(Service):
    """Lists the on-board logs of this run, sends their bytes, forgets them; without a logger there are none."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._transfers: dict[Channel, tuple[_Transfer, ...]] = {}
        """What is to be sent, in order."""
        self._sizes: dict[Channel, dict[int, int]] = {}
        """Sizes as they were listed: a log that grows is sent up to there."""

    def handlers(self) -> dict[str, Handler]:
        return {
            "LOG_REQUEST_LIST": self._list,
            "LOG_REQUEST_DATA": self._data,
            "LOG_REQUEST_END": self._end,
            "LOG_ERASE": self._erase,
        }

    def channel_removed(self, channel: Channel) -> None:
        self._transfers.pop(channel, None)
        self._sizes.pop(channel, None)

    def snapshot(self) -> Any:
        transfers = tuple((channel.number, transfer) for channel, transfer in self._transfers.items())
        sizes = tuple((channel.number, tuple(sizes.items())) for channel, sizes in self._sizes.items())
        return (transfers, sizes, self.due_us)

    def restore(self, state: Any) -> None:
        transfers, sizes, self.due_us = state
        channels = {channel.number: channel for channel in self.bridge.channels}
        self._transfers = {channels[n]: transfer for n, transfer in transfers if n in channels}
        self._sizes = {channels[n]: dict(entries) for n, entries in sizes if n in channels}

    def _list(self, channel: Channel, m: Any, sender: Sender) -> None:
        entries = self.bridge.logs.entries() if self.bridge.logs is not None else ()
        self._sizes[channel] = {entry.number: entry.size for entry in entries}
        last = min(m.end, len(entries))
        chosen = [entry for entry in entries if max(m.start, 1) <= entry.number <= last]
        for entry in chosen:
            fields = {"id": entry.number, "num_logs": len(entries), "last_log_num": last}
            channel.send(ENTRY, ENTRY.payload(**fields, time_utc=entry.time_utc, size=entry.size))
        if not chosen:
            channel.send(ENTRY, ENTRY.payload(num_logs=len(entries)))

    def _data(self, channel: Channel, m: Any, sender: Sender) -> None:
        sizes = self._sizes.setdefault(channel, {})
        if m.id not in sizes and self.bridge.logs is not None:
            sizes.update({entry.number: entry.size for entry in self.bridge.logs.entries()})
        left = min(max(sizes.get(m.id, 0) - m.ofs, 0), m.count)
        if not left:
            self._transfers.pop(channel, None)
            channel.send(DATA, DATA.payload(id=m.id, ofs=m.ofs, count=0))
            return
        wanted, waiting = _Transfer(m.id, m.ofs, left), self._transfers.get(channel, ())
        if m.count > SMALL:
            self._transfers[channel] = (wanted,)
        elif wanted not in waiting and len(waiting) < MOST_REQUESTS:
            small = sum(transfer.left <= SMALL for transfer in waiting)
            self._transfers[channel] = (*waiting[:small], wanted, *waiting[small:])
        self.due_us = min(self.due_us, self.bridge.now_us)

    def _end(self, channel: Channel, m: Any, sender: Sender) -> None:
        self.channel_removed(channel)

    def _erase(self, channel: Channel, m: Any, sender: Sender) -> None:
        self._transfers.clear()
        self._sizes.clear()
        if self.bridge.logs is not None:
            self.bridge.logs.erase()

    def service(self, now_us: int) -> None:
        for channel, waiting in list(self._transfers.items()):
            budget = 0 if channel.congested else PIECES
            while budget > 0 and waiting:
                sent, rest = self._send(channel, waiting[0], budget)
                budget, waiting = budget - sent, (*rest, *waiting[1:])
            self._transfers[channel] = waiting
            if not waiting:
                del self._transfers[channel]
        self.due_us = now_us + EVERY_US if self._transfers else NEVER

    def _send(self, channel: Channel, transfer: _Transfer, budget: int) -> tuple[int, tuple[_Transfer, ...]]:
        """Send up to so many pieces of a transfer; gives how many, and what is left of it."""
        number, offset, left = transfer
        logs = self.bridge.logs
        data = logs.read(number, offset, min(left, budget * PIECE)) if logs is not None else b""
        pieces = range(0, max(len(data), 1), PIECE)
        for at in pieces:
            piece = data[at : at + PIECE]
            channel.send(DATA, DATA.payload(id=number, ofs=offset + at, count=len(piece), data=piece))
        if len(data) == left or len(data) % PIECE or not data:
            return len(pieces), ()
        return len(pieces), (_Transfer(number, offset + len(data), left - len(data)),)
