# SPDX-License-Identifier: BSD-3-Clause
"""Links that several vehicles share: each client hears all of them, and all of them hear each client.

Whom a message is for, its target_system says; each vehicle looks at that itself, as on a radio network.
"""

from __future__ import annotations

import selectors
from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, Protocol

from .frame import CHECKSUM, HEADER_V1, HEADER_V2, MARK_V2, SIGNATURE, SIGNED
from .links.link import Link, Peer

if TYPE_CHECKING:
    from .bridge import Bridge


class Member(Protocol):
    """A vehicle; a simulation is one."""

    bridge: Bridge
    """A reboot replaces it."""


def split(data: bytes) -> list[bytes]:
    """Frames out of bytes that are whole frames, one behind the other."""
    frames, at = [], 0
    while at < len(data):
        is_v2 = data[at] == MARK_V2
        end = at + (HEADER_V2 if is_v2 else HEADER_V1) + data[at + 1] + CHECKSUM
        end += SIGNATURE if is_v2 and data[at + 2] & SIGNED else 0
        frames.append(data[at:end])
        at = end
    return frames


class _Branch(Peer):
    """A client as one of the vehicles sees it."""

    waits = True

    def __init__(self, client: Peer) -> None:
        super().__init__(client.name)
        self._client = client
        self.joins_frames = client.joins_frames
        self.is_signed, self.takes_unsigned = client.is_signed, client.takes_unsigned
        self.sent: list[bytes] = []
        """What the vehicle has sent since the router took it."""

    def is_idle(self) -> bool:
        return not (self.outbox or self.closed)

    def accept(self, frames: bytes) -> None:
        self.sent += [frames] if self.joins_frames else split(frames)

    def flush(self) -> None:
        self.sent += self.outbox
        self.outbox.clear()

    @property
    def congested(self) -> bool:
        return self._client.congested


class _Trunk(NamedTuple):
    """A client, and what the vehicles see of it: each on its own end of the link."""

    client: Peer
    ends: Sequence[Link]
    branches: Sequence[_Branch]


class Router:
    """Carries bytes between links and vehicles. Nothing here blocks but ``wait``.

    Args:
        members: the vehicles; frames go to a client in their order.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self._members = members
        self._links: list[Link] = []
        self._trunks: list[_Trunk] = []
        self._selector = selectors.DefaultSelector()
        self.received = 0
        """How often clients have said something."""

    def add_link(self, link: Link, which: Iterable[int] | None = None) -> list[Link]:
        """Open a link for clients to reach vehicles.

        Args:
            link: open, and on no vehicle.
            which: numbers of the vehicles; None: all.

        Returns:
            Each vehicle's end of the link, in their order, as for ``Bridge.stream_to``.
        """
        members = [self._members[k] for k in (range(len(self._members)) if which is None else which)]
        ends = [Link(link.name) for _ in members]
        for member, end in zip(members, ends, strict=True):
            member.bridge.add_link(end)
        self._links.append(link)
        link.attach(self._selector, partial(self._came, ends))
        return ends

    def _came(self, ends: Sequence[Link], client: Peer) -> None:
        branches = [_Branch(client) for _ in ends]
        self._trunks.append(_Trunk(client, ends, branches))
        for end, branch in zip(ends, branches, strict=True):
            end.add_peer(branch)

    def wait(self, seconds: float) -> bool:
        """Sleep until a socket has something to read, at most ``seconds`` of wall time. True when one has."""
        return bool(self._selector.select(seconds))

    def receive(self) -> None:
        """Read all links; vehicles hear what has come when they hear their clients next."""
        for key, _ in self._selector.select(0) if self._selector.get_map() else ():
            key.data()
        for client, ends, branches in self._trunks:
            data = client.take()
            if data:
                self.received += 1
                for end, branch in zip(ends, branches, strict=True):
                    end.deliver(branch, data)
        for link in self._links:
            self._members[0].bridge.dropped.extend(link.refusals)
            link.refusals.clear()

    def flush(self) -> None:
        """Hand what the vehicles have sent to the links; notice which clients are gone."""
        for client, _, branches in self._trunks:
            for branch in branches:
                client.outbox += branch.sent
                branch.sent.clear()
            if not client.closed and not client.is_idle():
                client.flush()
        if any(trunk.client.closed for trunk in self._trunks):
            self._forget_closed()

    def _forget_closed(self) -> None:
        for client, ends, branches in [trunk for trunk in self._trunks if trunk.client.closed]:
            branches[0].why_closed = client.why_closed  # said once, not by each vehicle
            for end, branch in zip(ends, branches, strict=True):
                branch.closed = True
                end.peers.remove(branch)
        self._trunks = [trunk for trunk in self._trunks if not trunk.client.closed]
        for member in self._members:
            member.bridge.flush()

    def close(self) -> None:
        """Send what is left, and close all links."""
        self.flush()
        for link in self._links:
            link.close()
        self._links.clear()
        self._selector.close()
