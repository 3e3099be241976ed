# SPDX-License-Identifier: BSD-3-Clause
"""Logs of a test's flight, made afterwards: what the test sent is flown once more, from power-on, with all logs on.

So a test that passes pays nothing for logs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from sitl.logs.track_observer import TrackObserver
from sitl.recording.entries import of_state
from sitl.recording.recorder import Recorder
from sitl.run import runner
from sitl.simulation import Simulation

from .moments import Forking, Said, repeat

SUFFIXES = (".tlog", ".bin", ".rec")
NOT_AGAIN = (
    "flown again from what the test sent, the vehicle does something else: the test reached into the simulation past "
    "MAVLink, or its physics does not repeat itself to the bit after snapshots"
)


@dataclass(frozen=True)
class Flown:
    """A flight that was flown again."""

    files: tuple[Path, ...]
    same: bool
    """Whether it ended in the same state, bit for bit."""


def fly_again(
    vehicle: Forking,
    folder: Path,
    stem: str,
    *,
    log: bool,
    said: Sequence[Said] | None = None,
    end_us: int | None = None,
) -> Flown:
    """Fly again what a vehicle was told, and keep a recording, with ``log`` also .tlog and .bin.

    Args:
        said, end_us: another script than the vehicle's present one, and its end.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for old in (folder / f"{stem}{suffix}" for suffix in (SUFFIXES if log else (".rec",))):
        old.unlink(missing_ok=True)
    simulation = vehicle.build()
    assert isinstance(simulation, Simulation)
    try:
        recorder = Recorder(simulation, folder / f"{stem}.rec")
        recorder.stopped = "the test ended"
        recorder.sections["track"] = TrackObserver(simulation).to_bytes

        def prepare(simulation: Simulation) -> None:
            if log:
                runner.open_log(simulation, folder, stem)

        present = vehicle.simulation.time_us if end_us is None else end_us
        repeat(simulation, list(vehicle.script.said if said is None else said), present, prepare)
        same = said is not None or of_state(simulation) == of_state(vehicle.simulation)
        recorder.close()
    finally:
        simulation.close()
    return Flown(tuple(file for suffix in SUFFIXES if (file := folder / f"{stem}{suffix}").exists()), same)


def keep(vehicle: Forking, folder: Path, stem: str, error: BaseException | None) -> list[str]:
    """Logs of a vehicle whose test failed; what there is to say about them."""
    simulation = vehicle.connection.simulation
    if simulation is None:
        lines = [f"{vehicle.now:.1f} s simulated", f"  {vehicle.describe()}", *vehicle.last_texts(20)]
        return [*lines, f"no logs: {vehicle.cannot_repeat}: its flight cannot be repeated"]
    world = f" in {simulation.world.name}" if simulation.world is not None else ""
    lines = [f"{simulation.airframe.name}{world}, seed {simulation.seed}, {vehicle.now:.1f} s simulated"]
    lines.append(f"  {vehicle.describe()}")
    lines += [f"  {text}" for text in vehicle.last_texts(20)]
    if vehicle.cannot_repeat:
        return [*lines, f"no logs: {vehicle.cannot_repeat}: its flight cannot be repeated"]
    lost = vehicle.failed_fork
    if lost is not None and lost.error is error:
        flown = fly_again(vehicle, folder, stem, log=True, said=lost.said, end_us=lost.end_us)
        lines.append("the flight is the one that failed in its fork")
    else:
        flown = fly_again(vehicle, folder, stem, log=True)
    lines += [] if flown.same else [f"note: {NOT_AGAIN}"]
    return [*lines, *(f"kept {file}" for file in flown.files)]
