# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.soak``: episodes by seeds until the time is up; a failure is made short and kept.

Each episode begins at power-on, ready to arm, or in motion, and does random things, right and wrong, to a vehicle.
What must hold after each of them is in ``episode.py``. Besides, memory must stay flat.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from sitl.client import Client
from sitl.simulation import Simulation, Snapshot
from sitl.vehicle.kinds import KINDS

from .deeds import Deed, Dice
from .episode import Episode
from .minimise import minimise

WARM_UP, ALLOWED_KB, ALLOWED_KB_AN_EPISODE = 20, 30_000, 20
"""Memory may grow by so much after the first episodes, and by so much with each."""
REPORT = 250
"""Episodes between two lines of what was done so far."""


@dataclass
class Tally:
    """What was done so far."""

    deeds: int = 0
    frames: int = 0
    clients: int = 0
    """Sequences of deeds by one client, from its first frame to another one in its place."""
    seconds: float = 0.0
    faulty_s: float = 0.0
    """Of them after a fault."""

    def add(self, deeds: Sequence[Deed]) -> None:
        """An episode."""
        self.deeds += len(deeds)
        self.frames += sum(deed.frames for deed in deeds)
        self.clients += 1 + sum(deed.kind == "forget" for deed in deeds)
        self.seconds += sum(deed.seconds for deed in deeds)
        first = next((k for k, deed in enumerate(deeds) if deed.is_fault), len(deeds))
        self.faulty_s += sum(deed.seconds for deed in deeds[first:])

    def __str__(self) -> str:
        return (
            f"{self.deeds} deeds, {self.frames} frames, {self.clients} client sequences, {self.seconds / 3600:.2f} "
            f"simulated hours, {self.faulty_s / 3600:.2f} of them after a fault"
        )


class Soak:
    """One kind of vehicle.

    Args:
        kind: "copter" or "rover".
        deeds: of an episode.
    """

    def __init__(self, kind: str, deeds: int) -> None:
        self.kind, self._count = kind, deeds
        self.end = b""
        """Record of the vehicle at the end of the last episode."""
        simulation = Simulation(KINDS[kind].default_frame)
        self._core = simulation.core
        self._beginnings = self._fly(simulation)
        firmware, profile = simulation.firmware, simulation.bridge.profile
        self._table, self._commands = firmware.table, sorted(profile.commands)
        self._items = sorted(firmware.commands.taken)
        simulation.close()

    def _fly(self, simulation: Simulation) -> list[Snapshot]:
        """At power-on, ready to arm, and in motion."""
        begin = simulation.snapshot()
        client = Client(simulation)
        client.wait_ready(90.0)
        ready = simulation.snapshot()
        if client.flies:
            client.take_off(8.0)
        else:
            client.guided_and_armed()
        client.set_velocity(1.0, 0.5)
        client.delay(2.0)
        return [begin, ready, simulation.snapshot()]

    def deeds(self, seed: int) -> list[Deed]:
        """Of an episode."""
        return Dice(seed, self._table, self._commands, self._items).deeds(self._count)

    def run(self, seed: int, deeds: Sequence[Deed]) -> tuple[int, str] | None:
        """Fly an episode; gives the deed that went wrong, and what; None: all is well."""
        simulation = Simulation(KINDS[self.kind].default_frame, core=self._core)
        found = Episode(simulation, self._beginnings[seed % len(self._beginnings)]).run(deeds)
        self.end = simulation.fleet.tobytes()
        simulation.close()
        return found

    def shorten(self, seed: int, deeds: Sequence[Deed], what: str) -> list[Deed]:
        """The fewest deeds found after which the same goes wrong."""

        def fails(fewer: list[Deed]) -> bool:
            found = self.run(seed, fewer)
            return found is not None and _same(found[1], what)

        return minimise(deeds, fails)


def _same(found: str, what: str) -> bool:
    """Whether two failures are alike: numbers in them may differ."""
    return found.split(":")[0].split("(")[0] == what.split(":")[0].split("(")[0]


def memory_kb() -> int:
    """Resident memory of this process; 0 where it is not told."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
    except OSError:
        return 0
    return pages * 4


def main(words: Sequence[str] | None = None) -> int:
    """The command; 1 when something failed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.soak", description=__doc__.splitlines()[0])
    parser.add_argument("--vehicle", choices=sorted(KINDS), action="append", help="(repeatable; default all)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of the first episode (default 0)")
    parser.add_argument("--episodes", type=int, default=None, metavar="N", help="of each vehicle")
    parser.add_argument("--minutes", type=float, default=1.0, help="wall time, unless --episodes is given (default 1)")
    parser.add_argument("--deeds", type=int, default=60, metavar="N", help="of an episode (default 60)")
    parser.add_argument(
        "--keep", type=Path, default=Path("soak-failures"), metavar="DIR", help="where failures are kept"
    )
    parser.add_argument("--repeat", type=Path, metavar="FILE", help="fly a failure again that was kept")
    options = parser.parse_args(words)
    if options.repeat is not None:
        return repeat(options.repeat)
    kinds = options.vehicle or sorted(KINDS)
    soaks = [Soak(kind, options.deeds) for kind in kinds]
    end, seed, failures, first_kb, total = time.monotonic() + 60.0 * options.minutes, options.seed, 0, 0, Tally()
    done = 0
    while done < options.episodes if options.episodes is not None else time.monotonic() < end:
        for soak in soaks:
            deeds = soak.deeds(seed)
            found = soak.run(seed, deeds)
            total.add(deeds)
            if found is not None:
                failures += 1
                keep(soak, seed, deeds[: found[0] + 1], found[1], options.keep)
        seed, done = seed + 1, done + 1
        if done == WARM_UP:
            first_kb = memory_kb()
        if done % REPORT == 0:
            print(f"{done} episodes: {total}; {failures} failures", flush=True)
    grown = memory_kb() - first_kb if first_kb else 0
    print(
        f"{done} episodes of each of {', '.join(kinds)} (seeds {options.seed} .. {seed - 1}): {total}; {failures} "
        f"failures; memory {memory_kb() / 1000:.0f} MB, {grown / 1000:+.1f} MB since episode {WARM_UP}"
    )
    if grown > ALLOWED_KB + ALLOWED_KB_AN_EPISODE * done:
        print("memory grows")
        failures += 1
    return 1 if failures else 0


def keep(soak: Soak, seed: int, deeds: Sequence[Deed], what: str, folder: Path) -> None:
    """Make a failure short, print it and write it down."""
    print(f"{soak.kind}, seed {seed}: {what}", flush=True)
    short = soak.shorten(seed, deeds, what)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{soak.kind}-{seed}.json"
    path.write_text(json.dumps({"vehicle": soak.kind, "seed": seed, "what": what, "deeds": short}, indent=1))
    print("".join(f"  {deed.what}, then {deed.seconds:g} s\n" for deed in short) + f"kept: {path}", flush=True)


def repeat(path: Path) -> int:
    """Fly a kept failure again."""
    kept = json.loads(path.read_text())
    deeds = [Deed(*row) for row in kept["deeds"]]
    found = Soak(kept["vehicle"], len(deeds)).run(kept["seed"], deeds)
    print(f"{kept['vehicle']}, seed {kept['seed']}: {found[1] if found is not None else 'all is well'}")
    return 0 if found is None else 1


if __name__ == "__main__":
    sys.exit(main())
