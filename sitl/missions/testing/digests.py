# SPDX-License-Identifier: BSD-3-Clause
"""Golden flights of a real ArduPilot: digests of all true states, one for each second, since its flights repeat bit for
bit. There is no recording: to fly it again is to run the test again."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sitl.core.whole_file import write_whole
from sitl.envs.mavlink.foreign import Foreign

SUFFIX = ".digests"
_FORMAT = "gym-sitl digests 1"


def to_text(flight: Foreign) -> str:
    """The digests of a flight until now, as a file."""
    assert flight.process is not None
    program = Path(flight.process.command[0])
    values = {
        "format": _FORMAT,
        "program": program.name,
        "program_sha256": hashlib.sha256(program.read_bytes()).hexdigest(),
        "frame": flight.plant.vehicle.airframe.name,
        "digests": flight.digests,
    }
    return json.dumps(values, indent=0) + "\n"


def write(path: Path, flight: Foreign) -> bool:
    """Write the digests of a flight; False: the file was like that already."""
    text = to_text(flight)
    if path.exists() and path.read_text(errors="replace") == text:
        return False
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, text.encode(), title=f"golden flight {path}")
    return True


def differences(path: Path, flight: Foreign) -> list[str]:
    """What is wrong with a flight, in lines; nothing when it is the golden one, bit for bit."""
    try:
        golden: dict[str, Any] = json.loads(path.read_bytes())
        kept: Sequence[str] = golden["digests"]
        if golden["format"] != _FORMAT:
            raise KeyError
    except (ValueError, KeyError, TypeError, RecursionError):
        return [f"golden flight {path} cannot be used: it is no file of {_FORMAT!r}"]
    present = json.loads(to_text(flight))
    lines = []
    common = min(len(kept), len(flight.digests)) - (
        len(kept) != len(flight.digests)
    )  # the last one is of no whole second
    for second, (then, now) in enumerate(zip(kept[:common], flight.digests[:common], strict=True)):
        if then != now:
            lines = [f"DIFFERS: true states are other ones between {second} and {second + 1} s of simulated time"]
            break
    if not lines and len(kept) != len(flight.digests):
        lines = [f"DIFFERS: the flight has {len(flight.digests)} s of simulated time, golden {len(kept)}"]
    if lines:
        lines += [
            f"  note: {name} is another one: {golden.get(name)} -> {present[name]}"
            for name in ("program", "program_sha256", "frame")
            if golden.get(name) != present[name]
        ]
        return [f"golden flight {path}", *lines]
    return []
