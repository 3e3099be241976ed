# SPDX-License-Identifier: BSD-3-Clause
"""Flies a recording again, without its clients."""

from __future__ import annotations

import contextlib
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from ..bridge.frame import Splitter
from ..bridge.links.inprocess import FrameWriter
from ..core import code_in_files, documents
from ..core.compile import Progress
from ..errors import SitlError
from ..logs.dataflash.log import attach
from ..plants.plant import is_remote
from ..scenario import Scenario
from ..simulation import Simulation
from ..vehicle.core_entry import Core
from ..vehicle.kinds import UnknownKindError
from ..vehicles import Airframe, AirframeError
from ..worlds import World, WorldError
from . import identity
from .entries import Entry, EntryKind, RecordingError, of_state, read_varint
from .recorder import IN_PROCESS, LOG, Recorder
from .recording import Recording
from .replayed_link import Flip, ReplayedLink, ReplayedPeer

_STRUCTURE = frozenset(
    (EntryKind.LINK, EntryKind.UNLINK, EntryKind.CONNECTED, EntryKind.DISCONNECTED, EntryKind.STREAMS)
)
"""Entries that can contradict those before them."""
WriterOf = Callable[[Simulation], FrameWriter]


class Replay:
    """Simulates a recorded vehicle again, with the recorded inputs at their recorded times.

    With the version that made the recording it sends the same bytes to every channel; with another version it flies as
    that version does. ``differences`` lists what differs from the recording, ``other_version`` says whether code does.

    Args:
        recording: the recording.
        frame, world: in place of the recorded ones, for files that have moved.
        physics: engine in place of the recorded one.
        core: the compiled core of this kind of vehicle, if it is loaded already.
        progress: called with the progress of compiling the core.
        record: path of a recording of the replay; None: none.
        log: makes the writer of what the recorded run's log was sent, if it had one; one more for each time that the
            run went on from a snapshot.
        bin_file: gives where on-board logs go, when the recorded run began to keep some; None: kept only if a client
            asked for them, and deleted in the end.

    Raises:
        RecordingError: the vehicle cannot be made again.
        MissingExtra: the library of its physics is not installed.
    """

    def __init__(
        self,
        recording: Recording,
        *,
        frame: str | Airframe | None = None,
        world: str | Path | World | None = None,
        physics: str | None = None,
        core: Core | None = None,
        progress: Progress | None = None,
        record: str | Path | None = None,
        log: WriterOf | None = None,
        bin_file: Callable[[], Path] | None = None,
    ) -> None:
        self.recording = recording
        for entry in recording.entries:
            if entry.kind is EntryKind.NOT_REPLAYABLE:
                raise RecordingError(f"{self._at_entry(entry)} {_text(entry)}: it cannot be flown")
        with _understood(recording):
            self.simulation = _simulation(recording, frame, world, physics, core, progress)
        try:
            now = identity.describe(self.simulation)
            self.differences = identity.differences(recording.header, now)
            self.other_version = bool(identity.code_differences(recording.header["version"], now["version"]))
        except (KeyError, TypeError, AttributeError) as error:
            raise RecordingError(f"{_title(recording)}: what it was made of cannot be understood: {error!r}") from None
        """Differences from the conditions of the recording, in words."""
        self.recorder = Recorder(self.simulation, record)
        self.recorder.checks = {}
        self.astray: list[str] = []
        """Differences from the recorded behaviour, in words, in order of time."""
        self._log, self._bin_file = log, bin_file
        self._scratch: tempfile.TemporaryDirectory[str] | None = None
        self._at = 0
        self._links: dict[int, ReplayedLink] = {}
        self._peers: dict[int, ReplayedPeer] = {}
        self._flips: dict[int, list[Flip]] = defaultdict(list)
        self._good_us: dict[str, int] = {}
        """Compared item -> last time at which it was equal [us]."""
        self._astray: set[str] = set()
        for entry in recording.entries:
            if entry.kind is EntryKind.CONGESTED:
                try:
                    sent, _ = read_varint(entry.data, 1)
                except (IndexError, ValueError):
                    raise self._senseless(entry) from None
                self._flips[entry.number].append(Flip(entry.time_us, sent, bool(entry.data[0])))

    # ------------------------------------------------------------------ going on

    def next_us(self) -> int:
        """Time of the next entry [us]; after the last one, of the end."""
        entries = self.recording.entries
        return entries[self._at].time_us if self._at < len(entries) else self.recording.end_us

    @property
    def is_over(self) -> bool:
        """Whether the whole recording has been replayed."""
        return self._at >= len(self.recording.entries) and self.simulation.time_us >= self.recording.end_us

    def advance_to(self, time_us: int) -> None:
        """Advance to ``time_us`` [us], including the inputs at that time; at most to the recording's end."""
        time_us = min(time_us, self.recording.end_us)
        entries = self.recording.entries
        while self._at < len(entries) and entries[self._at].time_us <= time_us:
            entry = entries[self._at]
            if self.simulation.time_us < entry.time_us:
                self.simulation.advance_to(entry.time_us)
            self._at += 1
            try:
                self._do(entry)
            except (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError) as error:
                if isinstance(error, RecordingError) or entry.kind not in _STRUCTURE:
                    raise
                raise self._senseless(entry, f": {error!r}") from error
        if self.simulation.time_us < time_us:
            self.simulation.advance_to(time_us)

    def run(self) -> list[str]:
        """Replay the whole recording; returns the differences found (``astray``)."""
        self.advance_to(self.recording.end_us)
        return self.verify()

    def _do(self, entry: Entry) -> None:
        bridge, number, kind = self.simulation.bridge, entry.number, entry.kind
        if kind is EntryKind.RECEIVED:
            self._peer(entry).deliver(entry.data)
        elif kind is EntryKind.PROCESSED:
            bridge.receive()
        elif kind is EntryKind.SERVED:
            self.simulation.advance_to(self.simulation.time_us)
        elif kind is EntryKind.LINK:
            self._open(number, *documents.of_json(entry.data))
        elif kind is EntryKind.UNLINK:
            bridge.remove_link(self._links.pop(number))
        elif kind is EntryKind.CONNECTED:
            link = self._links[read_varint(entry.data, 0)[0]]
            peer = ReplayedPeer(link.name, self.simulation, self._flips[number], link.kind == LOG, link.writer)
            peer.is_signed = link.kind not in (LOG, IN_PROCESS)
            self._peers[number] = peer
            link.add_peer(peer)
        elif kind is EntryKind.DISCONNECTED:
            peer = self._peers.pop(number)
            peer.closed, peer.why_closed = True, _text(entry)
            for link in self._links.values():
                if peer in link.peers:
                    link.peers.remove(peer)
            bridge.flush()
        elif kind is EntryKind.STREAMS:
            bridge.stream_to(self._links[number], documents.of_json(entry.data))
        elif kind is EntryKind.LOCKSTEP:
            if entry.data:
                bridge.free_clock()
            else:
                bridge.push_clock()
        elif kind is EntryKind.GRANTED:
            if bridge.grants is not None:
                bridge.grants.answer(bridge)
        elif kind is EntryKind.HEARTBEAT:
            bridge.beat()
        elif kind is EntryKind.LOGS:
            self._keep_logs()
        elif kind is EntryKind.FAULT:
            self.simulation.order_fault(_text(entry))
        elif kind is EntryKind.CHECK:
            self._check(entry)

    def _peer(self, entry: Entry) -> ReplayedPeer:
        if entry.number not in self._peers:
            raise RecordingError(f"{self._at_entry(entry)} client {entry.number} says something and is not there")
        return self._peers[entry.number]

    def _at_entry(self, entry: Entry) -> str:
        return f"{_title(self.recording)}: at {entry.time_us * 1e-6:.3f} s"

    def _senseless(self, entry: Entry, why: str = "") -> RecordingError:
        return RecordingError(f"{self._at_entry(entry)} {entry.kind.name} makes no sense{why}")

    def _open(self, number: int, kind: str, name: str) -> None:
        writer = self._log(self.simulation) if kind == LOG and self._log is not None else None
        link = self._links[number] = ReplayedLink(kind, name, writer)
        self.simulation.bridge.add_link(link)

    def _keep_logs(self) -> None:
        if self._bin_file is not None:
            attach(self.simulation, self._bin_file())
        elif asks_for_logs(self.recording):
            if self._scratch is None:
                self._scratch = tempfile.TemporaryDirectory(prefix="sitl-replay-")
            attach(self.simulation, Path(self._scratch.name) / "replay.bin")
        else:
            self.recorder.logs()  # a replay of this one may want them

    # ------------------------------------------------------------------ was it the same?

    def _check(self, entry: Entry) -> None:
        checks = self.recorder.checks
        found = checks.pop(entry.time_us, None) if checks is not None else None
        for name, part in (("the vehicle's state", slice(4)), ("telemetry", slice(4, 8))):
            if name in self._astray:
                continue
            if found is not None and found[part] == entry.data[part]:
                self._good_us[name] = entry.time_us
            else:
                self._astray.add(name)
                good, bad = self._good_us.get(name, 0) * 1e-6, entry.time_us * 1e-6
                self.astray.append(f"{name} differs from some time between {good:.0f} and {bad:.0f} s on")

    def verify(self) -> list[str]:
        """Compare the digests of the vehicle's state and of all channels, at the end."""
        end = self.recording.end
        if end is None or not self.recording.has_digests or not self.is_over:
            return self.astray
        if end["state"] != of_state(self.simulation) and "the vehicle's state" not in self._astray:
            self.astray.append(f"the vehicle's state differs at the end ({end['time_us'] * 1e-6:.3f} s)")
        now = self.recorder.result()["channels"]
        other = [number for number, digest in end["channels"].items() if now.get(number) != digest]
        if other or len(now) != len(end["channels"]):
            self.astray.append(f"the telemetry of {len(other)} of {len(end['channels'])} channels differs")
        return self.astray

    # ------------------------------------------------------------------ live from here

    def go_live(self) -> Simulation:
        """Remove the recorded clients, so that others can take over the vehicle."""
        bridge = self.simulation.bridge
        for link in list(self._links.values()):
            bridge.remove_link(link)
        self._links.clear()
        self._peers.clear()
        bridge.free_clock()
        bridge.dropped.clear()  # they concern the recorded clients only
        return self.simulation

    def close(self, stopped: str = "") -> None:
        """Close the simulation, and the recording of the replay if there is one."""
        self.recorder.stopped = stopped or (self.recording.end or {}).get("stopped", "ended")
        self.simulation.close()
        if self._scratch is not None:
            self._scratch.cleanup()


def asks_for_logs(recording: Recording) -> bool:
    """Whether a client requested on-board logs, on which the bytes sent to it depend."""
    splitters: dict[int, Splitter] = defaultdict(Splitter)
    return any(
        frame.kind.name.startswith("LOG_REQUEST")
        for entry in recording.entries
        if entry.kind is EntryKind.RECEIVED
        for frame in splitters[entry.number].feed(entry.data)
    )


def _text(entry: Entry) -> str:
    return entry.data.decode(errors="replace")


def _title(recording: Recording) -> str:
    return f"recording {str(recording.path)!r}"


@contextlib.contextmanager
def _understood(recording: Recording) -> Iterator[None]:
    """What goes wrong in making the simulation of a recording, at power-on, is the recording's."""
    try:
        yield
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        if isinstance(error, SitlError):
            raise
        why = f"{type(error).__name__}: {error}"
        raise RecordingError(f"{_title(recording)}: what it was made of cannot be understood ({why})") from error


def _files(recording: Recording, world: str | Path | World | None) -> list[str]:
    """What files its scenario names, each as "name = value", but those that lie in the recording's own folder."""
    header = recording.header
    file = header["world"]["file"] if world is None and header["world"] is not None else None
    named = {"world": file, "terrain": header.get("terrain")}
    folder = recording.path.parent
    return [
        f"{name} = {value!r}"
        for name, value in named.items()
        if value is not None
        and not code_in_files.is_name(value)
        and Path(value.partition(":")[0]).exists()
        and not code_in_files.lies_in(folder, Path(value).absolute())
    ]


def _simulation(
    recording: Recording,
    frame: str | Airframe | None,
    world: str | Path | World | None,
    physics: str | None,
    core: Core | None,
    progress: Progress | None,
) -> Simulation:
    header: dict[str, Any] = recording.header
    title = _title(recording)
    physics = physics or header["physics"]
    if is_remote(physics):
        raise RecordingError(
            f"{title}: its physics was at the other end of a link ({physics}), and what came from there is not in it; "
            "give --physics NAME to fly it on an engine of this machine"
        )
    if world is None and header["world"] is not None and header["world"]["file"] is None:
        name = header["world"]["name"]
        raise RecordingError(f"{title}: its world {name!r} was made by a program; give it: --world FILE")
    refused = code_in_files.refusal(title, _files(recording, world), say="--{name} {value}")
    if refused is not None:
        raise RecordingError(refused)
    try:
        scenario = Scenario.from_json(header, frame=frame, world=world, physics=physics)
        return Simulation(scenario, core=core, progress=progress)
    except (AirframeError, UnknownKindError) as error:
        raise RecordingError(f"{title}: {error}; --frame FILE gives another") from None
    except WorldError as error:
        raise RecordingError(f"{title}: {error}; --world FILE gives another") from None
