# SPDX-License-Identifier: BSD-3-Clause
"""Channels of a vehicle's clients: their numbers, who is told when they come and go, and what is said outwards."""

from __future__ import annotations

import socket
from typing import Any

import pytest

from sitl.bridge.channel import Channel
from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter
from sitl.bridge.links import InProcessLink, LogLink, TcpServerLink
from sitl.bridge.links.link import Link, Peer
from sitl.bridge.switchboard import Switchboard
from tests.bridge.fakes import Bench

FREE = 0


class Board:
    """A switchboard of system 7 at 1.5 s, and what it says of its channels."""

    def __init__(self) -> None:
        self.came: list[Channel] = []
        self.went: list[Channel] = []
        self.board = Switchboard(lambda: 7, lambda: 1_500_000, self.came.append, self.went.append)


@pytest.fixture
def made() -> Board:
    return Board()


class Writer:
    def frame(self, time_us: int, raw: bytes) -> None: ...
    def write(self, data: bytes) -> None: ...
    def close(self) -> None: ...


class Tap:
    def __init__(self) -> None:
        self.seen: list[tuple[int, bytes]] = []

    def frame(self, time_us: int, raw: bytes) -> None:
        self.seen.append((time_us, raw))


def test_a_new_one_has_nobody_and_has_heard_nothing(made: Board) -> None:
    board = made.board
    assert (board.links, board.channels, board.logs, board.received, list(board.dropped)) == ([], [], [], 0, [])
    assert not board.is_watched() and not board.has_sockets and not board.is_outside
    assert board.wait(0.0) is False


def test_channels_are_numbered_as_they_come_and_a_number_is_not_given_twice(made: Board) -> None:
    board, links = made.board, [InProcessLink(f"link {k}") for k in range(4)]
    for link in links[:3]:
        board.add_link(link)
    assert [(c.number, c.name, c.system) for c in made.came] == [(0, "link 0", 7), (1, "link 1", 7), (2, "link 2", 7)]
    assert board.channels == made.came and board.ports.count == 3
    board.remove_link(links[1])
    assert made.went == [made.came[1]] and [c.number for c in board.channels] == [0, 2]
    assert board.ports.count == 2 and board.links == [links[0], links[2]]
    board.add_link(links[3])
    assert [c.number for c in board.channels] == [0, 2, 3]


def test_clients_keep_their_numbers_over_a_reboot(made: Board) -> None:
    old, links = made.board, [InProcessLink(f"link {k}") for k in range(4)]
    for link in links[:3]:
        old.add_link(link)
    old.remove_link(links[0])
    old.received, tap = 5, Tap()
    old.taps.append(tap)
    old.dropped.append("a note")
    after = Board()
    after.board.take_over(old)
    board = after.board
    assert [(c.number, c.name) for c in board.channels] == [(1, "link 1"), (2, "link 2")]
    assert (board.received, board.taps, list(board.dropped)) == (5, [tap], ["a note"])
    board.add_link(links[3])
    assert [c.number for c in board.channels] == [1, 2, 3]


def test_a_log_hears_what_the_others_are_answered(made: Board) -> None:
    board = made.board
    log, client = LogLink(Writer(), type("Clock", (), {"time_us": 0})()), InProcessLink()
    board.add_link(client)
    assert not board.is_outside
    board.add_link(log)
    assert board.logs == [made.came[1]] and board.is_outside and not board.has_sockets
    board.remove_link(log)
    assert board.logs == []


def test_taps_see_each_frame_once_with_its_time(made: Board) -> None:
    board, link, taps = made.board, InProcessLink(), [Tap(), Tap()]
    board.add_link(link)
    board.taps += taps
    assert board.is_watched()
    board.channels[0].peer.write(b"one")
    board.channels[0].peer.write(b"two")
    board.flush()
    board.flush()
    for tap in taps:
        assert tap.seen == [(1_500_000, b"one"), (1_500_000, b"two")]
    assert link.receive() == b"onetwo"


class Going(Link):
    """A link of one client that is found to be gone when it is sent something."""

    def __init__(self, why: str) -> None:
        super().__init__("going")
        self.add_peer(_Gone("client 3", why))


class _Gone(Peer):
    def __init__(self, name: str, why: str) -> None:
        super().__init__(name)
        self._why = why

    def flush(self) -> None:
        super().flush()
        self.closed, self.why_closed = True, self._why


@pytest.mark.parametrize("why, notes", [("it reads nothing", ["client 3: it reads nothing"]), ("", [])])
def test_who_is_gone_is_noticed_when_something_is_sent(made: Board, why: str, notes: list[str]) -> None:
    board, stays = made.board, InProcessLink("stays")
    board.add_link(Going(why))
    board.add_link(stays)
    board.flush()
    assert [c.name for c in board.channels] == ["stays"] and [c.name for c in made.went] == ["client 3"]
    assert list(board.dropped) == notes and board.ports.count == 1
    board.flush()
    assert len(made.went) == 1


def test_why_clients_were_turned_away_is_taken_from_links(made: Board) -> None:
    board, link = made.board, InProcessLink()
    board.add_link(link)
    link.refusals.append("too many")
    board.read()
    board.read()
    assert list(board.dropped) == ["too many"] and link.refusals == []


def test_sockets_are_read_while_their_link_is_open(made: Board) -> None:
    board, link = made.board, TcpServerLink(FREE, "127.0.0.1")
    board.add_link(link)
    assert board.has_sockets and board.is_outside
    with socket.create_connection(link.local_address, timeout=5) as client:
        client.sendall(b"abc")
        for _ in range(50):
            if board.channels and board.channels[0].peer.take() == b"abc":
                break
            board.wait(0.1)
            board.read()
        else:
            pytest.fail("nothing was read")
    board.remove_link(link)
    assert not board.has_sockets and not board.is_outside and board.channels == []


def test_what_is_queued_is_sent_before_it_closes(made: Board) -> None:
    board, links = made.board, [InProcessLink("a"), InProcessLink("b")]
    for link in links:
        board.add_link(link)
    board.channels[1].peer.write(b"last")
    board.close()
    assert links[1].receive() == b"last" and board.links == [] and board.channels == []
    assert [c.name for c in made.went] == ["a", "b"]


class Journal:
    """Keeps the names of what it is told."""

    def __init__(self) -> None:
        self.told: list[tuple[Any, ...]] = []

    def __getattr__(self, name: str) -> Any:
        return lambda *arguments: self.told.append((name, *arguments))

    def names(self) -> list[str]:
        """Since the last call."""
        found, self.told = [each[0] for each in self.told], []
        return found


def test_a_journal_is_told_who_comes_what_is_said_and_who_goes() -> None:
    bench = Bench()
    bench.run(0.5)
    journal: Any = Journal()
    bench.bridge.board.journal = journal
    link = InProcessLink()
    bench.bridge.board.add_link(link)
    assert journal.told[0] == ("link_added", link) and "came" in journal.names()
    bench.bridge.beat()
    names = journal.names()
    assert "beat" in names and "sent" in names and names.index("sent") < names.index("flushed")
    grants = bench.bridge.push_clock()
    assert journal.told == [("lockstep", True)] and bench.bridge.grants is grants
    journal.names()
    bench.bridge.free_clock()
    assert journal.told == [("lockstep", False)] and bench.bridge.grants is None
    journal.names()
    bench.bridge.free_clock()
    assert journal.told == [], "once"
    bench.bridge.board.remove_link(link)
    assert journal.told[0] == ("link_removed", link) and "left" in journal.names()
    bench.bridge.board.close()
    assert "close" in journal.names() and bench.bridge.board.journal is None


def test_a_log_has_what_clients_are_answered_once() -> None:
    bench = Bench()
    kept: list[bytes] = []
    writer: Any = Writer()
    writer.frame = lambda time_us, raw: kept.append(raw)
    bench.bridge.board.add_link(LogLink(writer, bench.vehicle))
    log = next(channel for channel in bench.bridge.channels if channel.peer.is_log)
    bench.run(3.0)
    other = bench.connect(system=250)

    def logged() -> int:
        """Answers of commands since the last call."""
        bench.bridge.flush()
        found = sum(frame.kind.name == "COMMAND_ACK" for raw in kept for frame in Splitter().feed(raw))
        kept.clear()
        return found

    logged()
    assert bench.command(520, 1) == 0 and logged() == 1
    assert not other.receive("COMMAND_ACK"), "another client has not"
    kind = message("COMMAND_ACK")
    log.send(kind, kind.payload(command=1))
    assert logged() == 1, "what is for the log itself, too"


def test_who_takes_over_closes_what_it_would_have_waited_with(made: Board) -> None:
    other = Board().board
    own, taken = other._selector, made.board._selector
    other.take_over(made.board)
    assert own.get_map() is None, "closed: each reboot would cost a descriptor"
    assert other._selector is taken and taken.get_map() is not None
    other.close()
    assert taken.get_map() is None
