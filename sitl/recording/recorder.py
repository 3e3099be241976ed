# SPDX-License-Identifier: BSD-3-Clause
"""Writes a recording while a simulation runs."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..bridge.channel import Channel
from ..bridge.links.inprocess import InProcessLink, LogLink
from ..bridge.links.link import Link, Peer
from ..bridge.links.tcp import TcpServerLink
from ..bridge.links.udp import UdpInLink, UdpOutLink
from ..logs.track_observer import TrackObserver
from ..simulation import Simulation
from .blocks import END, ENTRIES, HEADER, LZMA, SECTION, Block, BlockReader, BlockWriter
from .entries import Entry, EntryKind, RecordingError, Sent, check, encode, of_state, varint
from .identity import describe

CHECK_US = 10_000_000
"""Simulated time between two digests that say where a replay goes astray [us]."""
BLOCK_BYTES = 1 << 18
"""Largest number of bytes kept before they are written; ``flush`` writes at once."""
PACKED_BYTES = 1 << 22
"""Bytes of entries that are packed together, at least, when there are more."""
REPACKED_BYTES = 1 << 26
"""A recording up to this size is packed anew when the run ends: smaller, and equal runs give equal files."""
LOG, TCP, UDP, IN_PROCESS, OTHER = "log", "tcp", "udp", "inprocess", "other"
_KINDS: tuple[tuple[type[Link], str], ...] = (
    (LogLink, LOG),
    (TcpServerLink, TCP),
    (UdpOutLink, UDP),
    (UdpInLink, UDP),
    (InProcessLink, IN_PROCESS),
)


def kind_of(link: Link) -> str:
    """EntryKind of a link; a replayed link has its original kind."""
    given = getattr(link, "kind", None)
    return given if isinstance(given, str) else next((name for type_, name in _KINDS if isinstance(link, type_)), OTHER)


class Recorder:
    """A journal of all that comes from outside, and a digest of all that goes out.

    Args:
        simulation: at power-on: no time has passed, and no client has sent anything.
        path: path of the file; None: nothing is kept but the digests.
        flush_us: simulated time after which what is collected is written [us]: a run that is killed loses no more.

    Raises:
        RecordingError: the simulation runs already, or the file cannot be written.
    """

    def __init__(self, simulation: Simulation, path: str | Path | None = None, flush_us: int = CHECK_US) -> None:
        board = simulation.bridge.board
        if simulation.time_us or any(channel.port.received for channel in board.channels):
            raise RecordingError(f"a recording begins at power-on; {simulation.time_us * 1e-6:.3f} s have passed")
        if board.journal is not None:
            raise RecordingError("the simulation is being recorded already")
        self.simulation = simulation
        self.path = Path(path) if path is not None else None
        self.stopped = "ended"
        """Reason for the end of the run, in a word or two."""
        self.channels: dict[int, Sent] = {}
        """Channel number -> digest of what it was sent."""
        self.checks: dict[int, bytes] | None = None
        """Time [us] -> digests at that time; kept only for a replay."""
        self.sections: dict[str, Any] = {}
        """Section name -> function that returns its bytes at the end of the run ("track": the track for
        comparisons)."""
        self.flush_us = flush_us
        self._flush_due_us, self._check_us = flush_us, CHECK_US
        self._writer: BlockWriter | None = None
        self._pending: list[bytes] = []
        self._size = self._total = 0
        self._last_us = 0
        self._links: dict[Link, int] = {}
        self._link_count = 0
        self._congested: set[Peer] = set()
        self._unprocessed = False
        """Whether bytes were read that have not been processed."""
        self._later: list[Entry] = []
        self._served = False
        self._is_inside = False
        """Whether time is passing, or an error has stopped it: then a part of what was due has been sent."""
        self.is_closed = False
        if self.path is not None:
            self._writer = BlockWriter(self.path)
            observer = TrackObserver(simulation)
            self.sections |= {"track": observer.to_bytes, "bits": observer.bits}
            self._writer.write(HEADER, json.dumps(describe(simulation), sort_keys=True).encode())
        for link in board.links:
            self.link_added(link)
        for channel in board.channels:
            self.came(channel)
        self.due_us = min(self._flush_due_us, self._check_us)
        board.journal = self
        simulation.observers.append(self)

    # ------------------------------------------------------------------ entries

    def _note(self, kind: EntryKind, number: int = 0, data: bytes = b"") -> None:
        if self._writer is None:
            return
        now = self.simulation.time_us
        entry = Entry(now, kind, number, data)
        if self._unprocessed and kind is not EntryKind.RECEIVED:
            self._later.append(entry)
            return
        if self._served and now == self._last_us:
            self._append(Entry(now, EntryKind.SERVED))
        self._served = False
        self._append(entry)

    def _append(self, entry: Entry) -> None:
        raw = encode(entry, self._last_us)
        self._last_us = entry.time_us
        self._pending.append(raw)
        self._size += len(raw)
        if self._size > BLOCK_BYTES:
            self.flush()

    def flush(self) -> None:
        """Write the collected entries: a run that is killed later can be replayed up to here.

        Raises:
            RecordingError: they cannot be written (a full disk); the recording ends here.
        """
        if self._writer is None or not self._pending:
            return
        data = b"".join(self._pending)
        self._total += len(data)
        self._pending.clear()
        self._size = 0
        try:
            self._writer.write(ENTRIES, data)
        except RecordingError:
            self._writer = None
            raise

    # ------------------------------------------------------------------ calls from the bridge (see ``Journal``)

    def link_added(self, link: Link) -> None:
        self._links[link] = self._link_count
        self._note(EntryKind.LINK, self._link_count, json.dumps([kind_of(link), link.name]).encode())
        self._link_count += 1

    def link_removed(self, link: Link) -> None:
        self._note(EntryKind.UNLINK, self._links.pop(link))

    def came(self, channel: Channel) -> None:
        self.channels[channel.number] = Sent()
        number = next(number for link, number in self._links.items() if channel.peer in link.peers)
        self._note(EntryKind.CONNECTED, channel.number, varint(number))

    def left(self, channel: Channel) -> None:
        self._congested.discard(channel.peer)
        self._note(EntryKind.DISCONNECTED, channel.number, channel.peer.why_closed.encode())

    def received(self, channel: Channel, data: bytes) -> None:
        self._note(EntryKind.RECEIVED, channel.number, data)
        self._unprocessed = True

    def acted(self) -> None:
        if self._unprocessed:
            self._unprocessed = False
            self._note(EntryKind.PROCESSED)
            later, self._later = self._later, []
            for entry in later:
                self._append(entry)

    def flushed(self, channel: Channel) -> None:
        if channel.congested != (channel.peer in self._congested):
            self._congested ^= {channel.peer}
            state = int(channel.peer in self._congested)
            self._note(
                EntryKind.CONGESTED, channel.number, bytes([state]) + varint(self.channels[channel.number].count)
            )

    def streams(self, link: Link, rates_hz: Mapping[str, int]) -> None:
        self._note(EntryKind.STREAMS, self._links[link], json.dumps(dict(rates_hz)).encode())

    def attended(self) -> None:
        self._served = self._is_inside = True

    def arrived(self) -> None:
        self._is_inside = False

    def beat(self) -> None:
        self._note(EntryKind.HEARTBEAT)

    def lockstep(self, on: bool) -> None:
        self._note(EntryKind.LOCKSTEP, 0, b"" if on else b"\0")

    def answered(self) -> None:
        self._note(EntryKind.GRANTED)

    def logs(self) -> None:
        self._note(EntryKind.LOGS)

    def failed(self, text: str) -> None:
        self._note(EntryKind.FAULT, 0, text.encode())

    def restored(self) -> None:
        self._note(EntryKind.NOT_REPLAYABLE, 0, b"the vehicle was put back to a snapshot")

    def sent(self, channel: Channel, frames: list[bytes]) -> None:
        self.channels[channel.number].add(self.simulation.time_us, frames)

    # ------------------------------------------------------------------ as an observer

    def observe(self) -> None:
        """Write the collected entries, and digests of the present state at intervals."""
        now = self.simulation.time_us
        if now >= self._check_us:  # at times that do not depend on how often it is written
            self._check_us = (now // CHECK_US + 1) * CHECK_US
            found = check(self.simulation, self.channels)
            if self.checks is not None:
                self.checks[now] = found
            self._note(EntryKind.CHECK, 0, found)
        if now >= self._flush_due_us:
            self.flush()
            self._flush_due_us = (now // self.flush_us + 1) * self.flush_us
        self.due_us = min(self._flush_due_us, self._check_us)

    # ------------------------------------------------------------------ the end

    def result(self) -> dict[str, Any]:
        """End of the run: time, reason, digests of the vehicle's record and of each channel."""
        return {
            "time_us": self.simulation.time_us,
            "stopped": self.stopped,
            "state": of_state(self.simulation),
            "channels": {str(number): sent.digest().hex() for number, sent in sorted(self.channels.items())},
        }

    def _end(self) -> dict[str, Any]:
        """What the file ends with. A run that an error has broken off within a step (a full disk, for a log) has no
        digests: no replay breaks off there."""
        broken = self._is_inside or self._unprocessed
        return self.result() | ({"stopped": "broken off", "state": "", "channels": {}} if broken else {})

    def close(self) -> None:
        """Write the end of the recording; the simulation's ``close`` does it, too."""
        if self.is_closed:
            return
        self.is_closed = True
        self.simulation.observers[:] = [o for o in self.simulation.observers if o is not self]
        self.simulation.bridge.board.journal = None
        if self._writer is None or self.path is None:
            return
        if self._served and self.simulation.time_us == self._last_us:
            self._append(Entry(self._last_us, EntryKind.SERVED))
        self.flush()
        try:
            for name, give in self.sections.items():
                self._writer.write(SECTION, name.encode() + b"\0" + give())
            self._writer.write(END, json.dumps(self._end(), sort_keys=True).encode())
        finally:
            writer, self._writer = self._writer, None
            writer.close()
        if self._total <= REPACKED_BYTES:
            repack(self.path)


def repack(path: Path) -> None:
    """Compress a whole recording with LZMA, in place and atomically; where the disk has no space for both, it stays as
    it is."""
    blocks = list(BlockReader(path))
    beside = path.with_name(path.name + ".packing")
    try:
        _write_packed(blocks, beside)
        os.replace(beside, path)
    except (RecordingError, OSError):
        with contextlib.suppress(OSError):
            beside.unlink()


def _write_packed(blocks: Sequence[Block], path: Path) -> None:
    writer = BlockWriter(path)
    try:
        writer.write(HEADER, blocks[0].data, LZMA)
        together = bytearray()
        for block in blocks:
            if block.kind == ENTRIES:
                together += block.data
            if together and (len(together) >= PACKED_BYTES or block.kind != ENTRIES):
                writer.write(ENTRIES, bytes(together), LZMA)  # of whole entries: each block is read for itself
                together.clear()
        for block in blocks:
            if block.kind in (SECTION, END):
                writer.write(block.kind, block.data)
    finally:
        writer.close()
