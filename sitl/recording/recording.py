# SPDX-License-Identifier: BSD-3-Clause
"""A recording that has been read."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..core import documents
from ..vehicles.old_names import key_of_properties
from .blocks import END, ENTRIES, HEADER, SECTION, Block, BlockReader
from .entries import Entry, RecordingError, decode

HEADER_KEYS = frozenset((
    "version", "vehicle", "frame", "airframe", "home", "seed", "estimator", "physics", "world", "start", "params",
    "epoch_us",
))  # fmt: skip
END_KEYS = frozenset(("time_us", "stopped", "state", "channels"))


SPARE_ENTRIES, ENTRIES_PER_BYTE = 1_000_000, 8
"""Entries of a recording, at most: so many, and so many for each byte of the file. A client that sends the same bytes
200 times a second gives less."""


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
    def has_digests(self) -> bool:
        """Whether it has an end, and what the vehicle's state and its telemetry were then: a run that an error broke
        off has none."""
        return self.end is not None and bool(self.end["state"])

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
    most = SPARE_ENTRIES + ENTRIES_PER_BYTE * reader.size
    header: dict[str, Any] | None = None
    end: dict[str, Any] | None = None
    entries: list[Entry] = []
    sections: dict[str, bytes] = {}
    for block in reader:
        try:
            if header is None:
                if block.kind != HEADER:
                    raise ValueError("a recording begins with what the run was made of")
                header = _header(block)
            elif block.kind == ENTRIES:
                for entry in decode(block.data, entries[-1].time_us if entries else 0):
                    entries.append(entry)
                    if len(entries) > most:
                        raise ValueError(f"more than {most} entries, and no recording of {reader.size} bytes has them")
            elif block.kind == SECTION:
                name, _, data = block.data.partition(b"\0")
                sections[name.decode()] = data
            elif block.kind == END:
                end = _end(block)
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


_TYPES: dict[str, tuple[type, ...]] = {
    "version": (dict,), "airframe": (dict,), "params": (dict,), "home": (list,), "vehicle": (str,), "physics": (str,),
    "world": (dict, type(None)),
}  # fmt: skip
"""Those of the header's values in which others are looked up."""


def _header(block: Block) -> dict[str, Any]:
    found = _json(block, HEADER_KEYS)
    for key, types in _TYPES.items():
        if not isinstance(found[key], types):
            raise ValueError(f"its {key} is {found[key]!r}")
    version, airframe = found["version"], found["airframe"]
    airframe["properties"] = airframe.pop(key_of_properties(airframe))
    if not {"sources", "compiled core"} <= version.keys() or not isinstance(version["sources"], dict):
        raise ValueError("its version names no sources")
    if not isinstance(airframe["name"], str) or not all(
        isinstance(airframe[group], dict) for group in ("properties", "parameters")
    ):
        raise ValueError("its airframe has no name, properties or parameters")
    return found


def _end(block: Block) -> dict[str, Any]:
    found = _json(block, END_KEYS)
    time_us, channels = found["time_us"], found["channels"]
    if type(time_us) is not int or not 0 <= time_us < 1 << 63:
        raise ValueError(f"it ends at {time_us!r} us")
    if not isinstance(channels, dict):
        raise ValueError(f"its channels are {channels!r}")
    return found


def _json(block: Block, keys: frozenset[str]) -> dict[str, Any]:
    found = documents.of_json(block.data)
    if not isinstance(found, dict) or not keys <= found.keys():
        raise ValueError("it misses " + ", ".join(sorted(keys - set(found))))
    return found
