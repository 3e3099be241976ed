# SPDX-License-Identifier: BSD-3-Clause
"""A recording that has been read."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .blocks import END, ENTRIES, HEADER, SECTION, Block, BlockReader
from .entries import Entry, RecordingError, decode

HEADER_KEYS = frozenset((
    "version", "vehicle", "frame", "airframe", "home", "seed", "estimator", "physics", "world", "start", "params",
    "epoch_us",
))  # fmt: skip
END_KEYS = frozenset(("time_us", "stopped", "state", "channels"))


@dataclass(frozen=True)
class Recording:
    """One run, as it was written down."""

    path: Path
    header: dict[str, Any]
    """Description of the run (``identity.describe``)."""
    entries: list[Entry]
    """Inputs from outside, in order."""
    end: dict[str, Any] | None = None
    """End of the run (``Recorder.result``); None: the file has no end."""
    sections: dict[str, bytes] = field(default_factory=dict)
    """Name -> bytes, for example "track"."""
    fault: str = ""
    """Why it has no end, and where it stops."""

    @property
    def end_us(self) -> int:
        """Simulated time at which it ends [us]."""
        if self.end is not None:
            return int(self.end["time_us"])
        return self.entries[-1].time_us if self.entries else 0


def read(path: str | Path, unfinished: bool = False) -> Recording:
    """Read a recording; ``unfinished``: up to where it can be read.

    Raises:
        RecordingError: the file cannot be read or is no recording; or, unless ``unfinished``, it is damaged or has no
            end. What is wrong is said with the place in the file.
    """
    file = Path(path)
    reader = BlockReader(file)
    header: dict[str, Any] | None = None
    end: dict[str, Any] | None = None
    entries: list[Entry] = []
    sections: dict[str, bytes] = {}
    for block in reader:
        try:
            if header is None:
                if block.kind != HEADER:
                    raise ValueError("a recording begins with what the run was made of")
                header = _json(block, HEADER_KEYS)
            elif block.kind == ENTRIES:
                entries += decode(block.data, entries[-1].time_us if entries else 0)
            elif block.kind == SECTION:
                name, _, data = block.data.partition(b"\0")
                sections[name.decode()] = data
            elif block.kind == END:
                end = _json(block, END_KEYS)
            else:
                raise ValueError("what the run was made of stands twice")
        except (ValueError, KeyError, TypeError) as error:
            raise RecordingError(
                f"recording {str(file)!r} says what no recording says, in the block at byte {block.at}: {error}"
            ) from None
    if header is None:
        raise RecordingError(f"recording {str(file)!r} {reader.fault}: nothing of it can be read")
    found = Recording(file, header, entries, end if not reader.fault else None, sections, reader.fault)
    if reader.fault and not unfinished:
        why = "; its run was killed, or the file has been cut short" if reader.is_cut else ""
        raise RecordingError(
            f"recording {str(file)!r} {reader.fault}{why}: what stands before goes up to {found.end_us * 1e-6:.3f} s "
            "and can be flown (sitl mission replay --unfinished)"
        )
    return found


def _json(block: Block, keys: frozenset[str]) -> dict[str, Any]:
    found = json.loads(block.data)
    if not isinstance(found, dict) or not keys <= found.keys():
        raise ValueError("it misses " + ", ".join(sorted(keys - set(found))))
    return found
