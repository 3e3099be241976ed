# SPDX-License-Identifier: BSD-3-Clause
"""Results as lines of JSON: a training or an evaluation is one line, which says by its key what it is a result of.

A key is a digest of all that a result follows from: the recipe with all settings, the environment's reference play
(``references``), the seed, the condition and the number of episodes. A line whose key is none of those that are wanted
is out of date, and is not shown. Files of two machines can be merged line by line, in any order.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from sitl.core import documents
from sitl.errors import SitlError

FOLDER = Path(__file__).parents[1] / "results"
Record = dict[str, Any]


class ResultError(SitlError):
    """A file of results that cannot be used."""


def digest(*parts: Any) -> str:
    """Of values of JSON types."""
    return hashlib.sha256(json.dumps(parts, sort_keys=True, separators=(",", ":")).encode()).hexdigest()[:16]


class Records:
    """All results in a folder, which has a file for each baseline.

    Args:
        folder: made with the first result.
    """

    def __init__(self, folder: Path = FOLDER) -> None:
        self.folder = folder
        self._found: dict[str, Record] = {}
        for path in sorted(folder.glob("*.jsonl")):
            for record in _lines(path):
                self._found[record["key"]] = record

    def __contains__(self, key: str) -> bool:
        return key in self._found

    def get(self, key: str) -> Record | None:
        """The result of this key."""
        return self._found.get(key)

    def all(self) -> Iterator[Record]:
        """All, also those that are out of date."""
        yield from self._found.values()

    def add(self, record: Record) -> None:
        """Add one, and write its file, sorted: whole or not at all. Lines that came there meanwhile stay."""
        path = self.folder / f"{record['name']}.jsonl"
        there = {one["key"]: one for one in (_lines(path) if path.exists() else ())}
        self._found.update({**there, record["key"]: record})
        self._write(path, {**there, record["key"]: record}.values())

    def prune(self, names: Iterable[str], wanted: Iterable[str]) -> int:
        """Delete all results of some baselines but those of the wanted keys; returns how many those were."""
        of, keep, before = set(names), set(wanted), len(self._found)
        for path in self.folder.glob("*.jsonl"):
            if path.stem in of:
                self._write(path, [one for one in _lines(path) if one["key"] in keep])
        self._found = {key: one for key, one in self._found.items() if one["name"] not in of or key in keep}
        return before - len(self._found)

    def _write(self, path: Path, records: Iterable[Record]) -> None:
        from sitl.agents.runs.files import make_folder, write_bytes

        make_folder(self.folder)
        rows = sorted(records, key=lambda one: (one["kind"], str(one.get("seed", "")), one.get("what", ""), one["key"]))
        write_bytes(path, "".join(line(record) for record in rows).encode())


def line(record: Mapping[str, Any]) -> str:
    """A line of a file."""
    return json.dumps(record, separators=(",", ":"), sort_keys=True) + "\n"


def _lines(path: Path) -> Iterator[Record]:
    for number, text in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        try:
            record = documents.of_json(text)
            record["key"], record["kind"], record["name"]
        except (ValueError, TypeError, KeyError):
            raise ResultError(f"{path}:{number} is no result: {text[:60]!r}") from None
        yield record
