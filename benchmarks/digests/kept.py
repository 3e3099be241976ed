# SPDX-License-Identifier: BSD-3-Clause
"""Digests small enough to keep in the repository: they tell that a flight has changed, when it began, and in what.

Of each flight only what is the flight itself is kept: where the vehicle is and how it moves, what it senses, believes
and commands, and some of its messages. A new parameter, message or field of the record is no difference.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from .compare import NAMED
from .tape import Row, read

FILE = Path("tests/golden/digests.json")
"""From the tree's root."""
RENEW = "python -m benchmarks.digests record"
FIELDS = (
    "rng.s", "physics.body.pos", "physics.body.vel", "physics.body.q", "physics.body.rates", "physics.rotors.speed",
    "physics.wheels.speed", "physics.battery.charge", "physics.wind.vel", "sensors.acc", "sensors.gyro", "sensors.mag",
    "autopilot.estimate.pos", "autopilot.estimate.vel", "autopilot.estimate.q", "autopilot.estimate.euler",
)  # fmt: skip
"""Leaves of a vehicle's record; of several vehicles after "vehicles."."""
MESSAGES = ("STATUSTEXT", "ATTITUDE_TARGET", "GLOBAL_POSITION_INT", "SERVO_OUTPUT_RAW", "OBSTACLE_DISTANCE")
ROBOTS = re.compile(r"robots\.(body|rng)\b")
"""Leaves of Turtlebots."""
GIVEN = ("observation", "reward", "terminated", "truncated", "scan", "episode", "vehicle")
"""What environments give, with all that belongs to it ("observation.goal")."""
SECONDS, STEPS = 8, 25
"""Simulated time, or steps of an environment, between two digests."""


class Kept(NamedTuple):
    """One flight."""

    end: float
    """When it ends [s, or number of a step]."""
    every: int
    """Between two digests [s, or steps]."""
    rows: dict[str, Row]
    """Name -> its check sum, and a digest (1 .. 255; 0: nothing) of each piece of time."""


def keep(digests: Mapping[str, Any]) -> Kept:
    """What is kept of a flight's digests."""
    is_environment = "given" in digests
    every = STEPS if is_environment else SECONDS
    rows: dict[str, Row] = {}
    for tape in ("record", "telemetry", "given"):
        if tape not in digests:
            continue
        times = digests[tape]["times"]
        groups: dict[str, list[Row]] = {}
        for name, row in read(digests[tape]).items() if times else ():
            title = _title(tape, name)
            if title:
                groups.setdefault(title, []).append(row)
        rows |= {title: _together(found, times, every) for title, found in groups.items()}
    return Kept(float(digests["end"]), every, dict(sorted(rows.items())))


def _title(tape: str, name: str) -> str:
    """Under what a row is kept; "": it is not."""
    if tape == "telemetry":
        return name if name in MESSAGES else ""
    if tape == "record":
        within = name.removeprefix("vehicles.")
        return name if within in FIELDS or ROBOTS.match(name) else ""
    first = re.split(r"[.\[]", name)[0]
    return first if first in GIVEN else ""


def _together(rows: list[Row], times: list[float], every: int) -> Row:
    """Rows of the same times as one, with a digest for each piece of time."""
    check_sum = zlib.crc32(b"".join(row.check_sum.to_bytes(4, "little") for row in rows))
    pieces: dict[int, int] = {}
    for step, time in enumerate(times):
        here = bytes(row.steps[step] if step < len(row.steps) else 0 for row in rows)
        if any(here):
            piece = int(time // every)
            pieces[piece] = zlib.crc32(here, pieces.get(piece, 0))
    steps = bytearray(max(pieces, default=-1) + 1)
    for piece, digest in pieces.items():
        steps[piece] = digest % 255 + 1
    return Row(check_sum, bytes(steps))


# ------------------------------------------------------------------ the file


def write(path: Path, flights: Mapping[str, Kept]) -> None:
    """Write the file: a line for each flight, in the order of their names."""
    sets: list[str] = []
    lines = []
    for name in sorted(flights):
        flight = flights[name]
        names = " ".join(flight.rows)
        if names not in sets:
            sets.append(names)
        packed = b"".join(
            row.check_sum.to_bytes(4, "little") + len(row.steps).to_bytes(2, "little") + row.steps
            for row in flight.rows.values()
        )
        entry = [flight.end, flight.every, sets.index(names), base64.b64encode(packed).decode()]
        lines.append(f"{json.dumps(name)}: {json.dumps(entry)}")
    about = f"What flights are, bit for bit, on every machine (docs/digests.md). Made anew by: {RENEW}"
    names = ",\n".join(json.dumps(each) for each in sets)
    body = ",\n".join(lines)
    path.write_text(f'{{"about": {json.dumps(about)},\n"names": [\n{names}\n],\n"flights": {{\n{body}\n}}}}\n')


def load(path: Path) -> dict[str, Kept]:
    """Read the file."""
    found = json.loads(path.read_text())
    flights = {}
    for name, (end, every, which, text) in found["flights"].items():
        packed, rows = base64.b64decode(text), {}
        for title in found["names"][which].split():
            length = int.from_bytes(packed[4:6], "little")
            rows[title] = Row(int.from_bytes(packed[:4], "little"), packed[6 : 6 + length])
            packed = packed[6 + length :]
        flights[name] = Kept(end, every, rows)
    return flights


# ------------------------------------------------------------------ the comparison


def difference(kept: Kept, now: Kept) -> str:
    """When a flight began to be another one, and in what; "" when it is the same."""
    firsts: dict[int, list[str]] = {}
    for title in {**kept.rows, **now.rows}:
        old, new = kept.rows.get(title, Row(0, b"")), now.rows.get(title, Row(0, b""))
        if old != new:
            firsts.setdefault(_first(old.steps, new.steps), []).append(title)
    unit = "s" if kept.every == SECONDS else "steps"
    if not firsts:
        return "" if kept.end == now.end else f"it ends at {now.end:g} {unit}, not at {kept.end:g}"
    piece = min(firsts)
    named = firsts[piece][:NAMED]
    more = sum(map(len, firsts.values())) - len(named)
    begin = piece * kept.every
    return f"between {begin} and {begin + kept.every} {unit}: {', '.join(named)}" + (f"; {more} more" if more else "")


def _first(old: bytes, new: bytes) -> int:
    """The first piece of time that differs; the last one when only the check sums do."""
    size = max(len(old), len(new))
    pairs = zip(old.ljust(size, b"\0"), new.ljust(size, b"\0"))
    return next((k for k, (a, b) in enumerate(pairs) if a != b), max(size - 1, 0))


def differences(kept: Mapping[str, Kept], now: Mapping[str, Kept]) -> Iterator[str]:
    """Flights that have changed, in words, in the order of the second."""
    for name, flight in now.items():
        if name not in kept:
            yield f"{name}: there are no digests of it"
        else:
            words = difference(kept[name], flight)
            if words:
                yield f"{name}: {words}"
