# SPDX-License-Identifier: BSD-3-Clause
"""What a DataFlash log is made of: messages, their fields, and the head of the file that describes them.

Every message is two marks, its number and its fields, packed, little-endian. FMT messages come first and give each
number its name, its fields' names and a letter for the type of each; UNIT, MULT and FMTU give the fields' units.
Letters and tables: https://github.com/ArduPilot/ardupilot/blob/master/libraries/AP_Logger/README.md
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Collection, Iterable
from typing import Any, NamedTuple

import numpy as np

HEAD = b"\xa3\x95"

TYPES = {
    "b": ("i1", "b", 1.0),
    "B": ("u1", "B", 1.0),
    "h": ("<i2", "h", 1.0),
    "H": ("<u2", "H", 1.0),
    "i": ("<i4", "i", 1.0),
    "I": ("<u4", "I", 1.0),
    "f": ("<f4", "f", 1.0),
    "d": ("<f8", "d", 1.0),
    "n": ("S4", "4s", 1.0),
    "N": ("S16", "16s", 1.0),
    "Z": ("S64", "64s", 1.0),
    "c": ("<i2", "h", 100.0),
    "C": ("<u2", "H", 100.0),
    "e": ("<i4", "i", 100.0),
    "E": ("<u4", "I", 100.0),
    "L": ("<i4", "i", 1.0),  # readers take 1e-7 of it: degE7 as it is
    "M": ("u1", "B", 1.0),
    "q": ("<i8", "q", 1.0),
    "Q": ("<u8", "Q", 1.0),
}
"""Letter -> (numpy's type, struct's code, stored number for one unit of the value)."""
READ_DIVISORS = {letter: scale for letter, (_, _, scale) in TYPES.items() if scale != 1.0} | {"L": 1e7}
"""Letter -> stored number for one unit, or degree, as readers take it."""

UNITS = {
    "-": "", "?": "UNKNOWN", "A": "A", "a": "Ah", "d": "deg", "b": "B", "k": "deg/s", "D": "deglatitude",
    "e": "deg/s/s", "E": "rad/s", "G": "Gauss", "h": "degheading", "i": "A.s", "J": "W.s", "l": "l", "L": "rad/s/s",
    "m": "m", "n": "m/s", "o": "m/s/s", "O": "degC", "%": "%", "S": "satellites", "s": "s", "q": "rpm", "r": "rad",
    "U": "deglongitude", "u": "ppm", "v": "V", "P": "Pa", "w": "Ohm", "W": "Watt", "X": "W.h", "y": "l/s", "Y": "us",
    "z": "Hz", "#": "instance", "B": "B/s", "t": "N.m",
}  # fmt: skip
"""Letters of FMTU's UnitIds."""
MULTIPLIERS = {
    "-": 0.0, "?": 1.0, "2": 1e2, "1": 1e1, "0": 1e0, "A": 1e-1, "B": 1e-2, "C": 1e-3, "D": 1e-4, "E": 1e-5,
    "F": 1e-6, "G": 1e-7, "I": 1e-9, "!": 3.6, "/": 3600.0,
}  # fmt: skip
"""Letters of FMTU's MultIds: stored number times this is in the unit; MULT has them as rounded to single precision."""

NAME_BYTES, FORMAT_BYTES, LABEL_BYTES = 4, 16, 64

CLOCKS = (("TimeUS", 1e-6), ("TimeMS", 1e-3), ("Time", 1e-3))
"""Field with a message's time, by the versions of ArduPilot, and what makes seconds of it. Before 3.3 many messages
have none, and in 3.0 that of GPS, the only one, is the time of the week."""
_CLOCK_OF_GPS = ("T", 1e-3)
"""Of a GPS whose TimeMS is the time of the week (ArduPilot 3.1 and 3.2)."""
CLOCK_FIELDS = (*(name for name, _ in CLOCKS), "T", "Week")
"""Fields that tell which one is the clock, and the clock."""

Source = str | float | Callable[[Any], Any]
"""Source of a field: the path of a number in the vehicle's record ("autopilot.estimate.vel[0]"), a constant, or a
function of the samples (``s(path)`` returns a column)."""
RING = "@"
"""Prefix of paths of numbers in the ring of inertial samples."""


class Field(NamedTuple):
    """One field of a message."""

    label: str
    kind: str
    """Letter of its type."""
    unit: str = "-"
    multiplier: str = "-"
    source: Source = 0.0
    scale: float = 1.0
    """Value in the log's unit = source times this."""


class Message(NamedTuple):
    """One kind of message."""

    name: str
    rate: float = 0.0
    """Rate [Hz]; 0: written on events."""
    bits: int = 0
    """Bits of LOG_BITMASK, any of which enables it; 0: always written."""
    change: str = ""
    """Path: write it when this number has changed; it is looked at ``rate`` times a second, or more often."""
    time: str = "time_us"
    """Path of its TimeUS: when a number that has changed did so."""
    when: Source = 1.0
    """Write it only while this is not zero."""
    ring: bool = False
    """Whether it holds the samples of ``autopilot.inertial_ring``, at their rate; ``@acc[0]`` is a path there."""
    timed: bool = True
    """Whether TimeUS comes before its fields."""
    fields: tuple[Field, ...] = ()
    """Without TimeUS, which every message but FMT (``timed``) has first."""

    def of(self, *fields: Field) -> Message:
        """The message with these fields: ``Message("SURF", rate, bits).of(Field(...), ...)``."""
        return self._replace(fields=fields)

    @property
    def all_fields(self) -> tuple[Field, ...]:
        """The fields with TimeUS."""
        return (Field("TimeUS", "Q", "s", "F", self.time), *self.fields) if self.timed else self.fields

    @property
    def format(self) -> str:
        """The letters of its fields."""
        return "".join(f.kind for f in self.all_fields)

    @property
    def labels(self) -> str:
        """The names of its fields."""
        return ",".join(f.label for f in self.all_fields)

    @property
    def units(self) -> str:
        """UnitIds"""
        return "".join(f.unit for f in self.all_fields)

    @property
    def multipliers(self) -> str:
        """MultIds"""
        return "".join(f.multiplier for f in self.all_fields)

    @property
    def packer(self) -> struct.Struct:
        """Packs head, number and fields."""
        return struct.Struct("<3B" + "".join(TYPES[f.kind][1] for f in self.all_fields))

    def columns(self) -> list[tuple[str, str]]:
        """numpy's types of head, number and fields."""
        return [("head", "<u2"), ("number", "u1"), *((f.label, TYPES[f.kind][0]) for f in self.all_fields)]


def check(message: Message) -> None:
    """ValueError when a message does not fit what FMT and FMTU can say of it."""
    if not (0 < len(message.name) <= NAME_BYTES and len(message.format) <= FORMAT_BYTES):
        raise ValueError(f"{message.name}: the name has up to 4 letters, a message up to 16 fields")
    if len(message.labels) > LABEL_BYTES:
        raise ValueError(f"{message.name}: its labels have {len(message.labels)} letters, 64 is most")
    for f in message.all_fields:
        if f.kind not in TYPES or f.unit not in UNITS or f.multiplier not in MULTIPLIERS:
            raise ValueError(f"{message.name}.{f.label}: no such type, unit or multiplier")


def clock(fields: Collection[str]) -> tuple[str, float] | None:
    """The field with the time since boot of a message with these fields, and what makes seconds of it; None: it has
    none."""
    if "T" in fields and "Week" in fields:
        return _CLOCK_OF_GPS
    return next((found for found in CLOCKS if found[0] in fields), None)


# ---------------------------------------------------------------------- the head of the file

FMT_NUMBER, UNIT_NUMBER, MULT_NUMBER, FMTU_NUMBER = 128, 129, 130, 131
FIRST_NUMBER = 32
"""Number of the first other message; FMT is 128 in every log, so that readers can start."""
FMT = Message("FMT", timed=False).of(
    Field("Type", "B"), Field("Length", "B", "b"), Field("Name", "n"), Field("Format", "N"), Field("Columns", "Z")
)


def is_binary(start: bytes) -> bool:
    """Whether a file that begins so is a binary log."""
    return HEAD + bytes([FMT_NUMBER]) in start


def is_text(start: bytes) -> bool:
    """Whether a file that begins so is a log as text."""
    return b"FMT, 128," in start and not start.startswith(HEAD)


_DESCRIBED = {
    FMT_NUMBER: FMT,
    UNIT_NUMBER: Message("UNIT").of(Field("Id", "b"), Field("Label", "Z")),
    MULT_NUMBER: Message("MULT").of(Field("Id", "b"), Field("Mult", "d")),
    FMTU_NUMBER: Message("FMTU").of(Field("FmtType", "B"), Field("UnitIds", "N"), Field("MultIds", "N")),
}
"""What describes the other messages."""


def number_all(messages: Iterable[Message]) -> dict[str, int]:
    """A number for each message, by its name."""
    free = (n for n in range(FIRST_NUMBER, 255) if not FMT_NUMBER <= n <= FMTU_NUMBER)
    return dict(zip(dict.fromkeys(message.name for message in messages), free, strict=False))


def head(messages: Iterable[Message], numbers: dict[str, int], time_us: int) -> bytes:
    """All FMT, UNIT, MULT and FMTU messages."""
    described = _DESCRIBED | {numbers[m.name]: m for m in {m.name: m for m in messages}.values()}
    packers = {number: message.packer for number, message in _DESCRIBED.items()}

    def pack(number: int, *values: Any) -> bytes:
        return packers[number].pack(*HEAD, number, *(v.encode() if isinstance(v, str) else v for v in values))

    return b"".join(
        (
            *(pack(FMT_NUMBER, n, m.packer.size, m.name, m.format, m.labels) for n, m in described.items()),
            *(pack(UNIT_NUMBER, time_us, ord(letter), text) for letter, text in UNITS.items()),
            *(pack(MULT_NUMBER, time_us, ord(letter), np.float32(times)) for letter, times in MULTIPLIERS.items()),
            *(pack(FMTU_NUMBER, time_us, n, m.units, m.multipliers) for n, m in described.items()),
        )
    )
