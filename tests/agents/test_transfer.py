# SPDX-License-Identifier: BSD-3-Clause
"""Folders that travel: the paths that an item names, and what has changed in a folder."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from sitl.agents.runs import transfer
from sitl.agents.runs.files import write_bytes


class Pair(NamedTuple):
    path: Path
    number: int


@dataclass(frozen=True)
class Trial:
    run: Path
    more: Any = None


def test_paths_of_an_item_and_their_places():
    a, b, c = Path("a"), Path("b"), Path("c")
    item = {"pair": Pair(a, 1), "trials": [Trial(b), Trial(a, (c, "c"))]}
    assert transfer.paths_of(item) == [a, b, c]
    there = {a: Path("/x"), c: Path("/y")}
    assert transfer.moved(item, there) == {
        "pair": Pair(there[a], 1),
        "trials": [Trial(b), Trial(there[a], (there[c], "c"))],
    }
    text = ("a", 1)
    assert transfer.paths_of(text) == [] and transfer.moved(text, there) is text


def test_what_is_read_can_be_put_elsewhere(tmp_path):
    (tmp_path / "one" / "in").mkdir(parents=True)
    (tmp_path / "one" / "in" / "file").write_bytes(b"\0\1")
    (tmp_path / "one" / ".episodes.csv.123").write_bytes(b"half")
    content = transfer.read(tmp_path / "one")
    assert content == {"in/file": b"\0\1"}
    transfer.unpack(tmp_path / "two", content)
    assert transfer.read(tmp_path / "two") == content
    transfer.unpack(tmp_path / "three", transfer.read(tmp_path / "one" / "in" / "file"))
    assert (tmp_path / "three").read_bytes() == b"\0\1"
    transfer.unpack(tmp_path / "four", transfer.read(tmp_path / "nothing"))
    assert list((tmp_path / "four").iterdir()) == []


def test_changes_are_told_once_and_logs_come_first(tmp_path):
    for name in ("gone", "same", "model.npz", "episodes.csv"):
        (tmp_path / name).write_bytes(b"a")
    mirrored = transfer.Mirrored(tmp_path)
    assert mirrored.changes() == {}
    (tmp_path / "gone").unlink()
    write_bytes(tmp_path / "model.npz", b"b")  # of the same length, perhaps at the same time: another file
    with open(tmp_path / "episodes.csv", "ab") as log:
        log.write(b"b")
    changes = mirrored.changes()
    assert list(changes.items()) == [("gone", None), ("episodes.csv", b"ab"), ("model.npz", b"b")]
    assert mirrored.changes() == {}
    transfer.write(tmp_path, {"gone": b"back", "same": None})
    assert mirrored.changes() == {"same": None, "gone": b"back"}
