# SPDX-License-Identifier: BSD-3-Clause
"""Flies one case of a suite and compares it with its golden: the result is one line of a table."""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

from sitl import vehicles
from sitl.core.whole_file import write_whole
from sitl.errors import SitlError
from sitl.logs.tlog import LogError
from sitl.physics.engines import NATIVE
from sitl.recording.entries import RecordingError
from sitl.recording.recorder import Recorder
from sitl.recording.recording import read
from sitl.simulation import Simulation
from sitl.vehicle.core_entry import Core, load_core
from sitl.vehicle.kinds import KINDS

from ..comparison import report
from ..comparison.alignment import AlignmentError
from ..comparison.compare import OLD, Comparison, compare
from ..comparison.flight import Flight, of_recording
from ..files import for_vehicle, load
from ..fly import Outcome, fly
from .cases import Case, SuiteError

UPDATE = "sitl mission suite {folder} --update-golden --only {name}"
"""The command that records a golden flight anew."""
OK, DIFFERS, NO_GOLDEN, FAILED = "ok", "DIFFERS", "NO GOLDEN", "ERROR"
KEPT, WRITTEN, REPLACED = "kept", "written", "replaced"
"""What was done with golden, when it may be updated."""
SHOWN = ("position.max", "cross_track.max", "altitude.max", "delay.max", "energy.max")
"""Metrics of the table."""


@dataclass(frozen=True)
class Result:
    """One line of the table."""

    name: str
    status: str
    words: str = ""
    """Differences, or why nothing could be compared."""
    simulated: float = 0.0
    """Simulated time [s]."""
    wall: float = 0.0
    """Wall time [s]."""
    metrics: dict[str, float] = field(default_factory=dict)
    """``SHOWN`` -> value in its own unit."""
    recording: str = ""
    """Path of the flight's recording, if it was kept."""
    report: str = ""
    """Path of its report."""
    note: str = ""

    @property
    def ok(self) -> bool:
        """Whether the flight is as expected."""
        return self.status in (OK, KEPT, WRITTEN, REPLACED)


def fly_case(case: Case, update: bool = False, reports: str | None = None) -> Result:
    """Fly a case, compare, and keep what is needed of it.

    Args:
        case: what to fly.
        update: write golden where there is none, or where the flight is another one.
        reports: folder for recordings and reports of flights that differ; None: nothing is kept.
    """
    began = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="sitl-suite-") as folder:
        path = Path(folder) / f"{case.name}.rec"
        try:
            outcome, simulated = record(case, path)
            return _judged(case, path, outcome, simulated, began, update, reports)
        except SitlError as error:
            return Result(case.name, FAILED, str(error), wall=time.perf_counter() - began)


@cache
def _core(kind: str) -> Core:
    """The compiled core, loaded once per process."""
    return load_core(KINDS[kind])


def record(case: Case, path: Path) -> tuple[Outcome, float]:
    """Fly a case into a recording; also gives the simulated time [s]."""
    file = for_vehicle(load(case.mission), KINDS[case.kind].firmware.commands.taken)
    home = case.home or ((*file.home, 0.0) if file.home is not None else None)
    simulation = Simulation(
        _frame(case.frame),
        home=home,
        seed=case.seed,
        params=case.params,
        core=_core(case.kind) if case.physics == NATIVE else None,
        world=case.world,
        start=case.start,
        physics=case.physics,
    )
    try:
        recorder = Recorder(simulation, path)
        outcome = fly(simulation, file.mission, fence=file.fence_items, rally=file.rally_items, limit_s=case.time_limit)
        recorder.stopped = "mission completed" if outcome.completed else outcome.reason
    finally:
        simulation.close()
    return outcome, simulation.time_us * 1e-6


def _frame(name: str) -> str:
    vehicles.load(name)  # an airframe that is none says so before anything flies
    return name


def _judged(
    case: Case, path: Path, outcome: Outcome, simulated: float, began: float, update: bool, reports: str | None
) -> Result:
    new = of_recording(read(path))
    note = "" if outcome.completed else f"mission not completed: {outcome.reason}"

    def result(status: str, words: str = "", comparison: Comparison | None = None) -> Result:
        metrics = {metric.name: metric.value for metric in comparison.metrics} if comparison else {}
        shown = {name: metrics[name] for name in SHOWN if name in metrics}
        kept = written = ""
        if reports is not None and status in (DIFFERS, NO_GOLDEN):
            folder = Path(reports) / case.name
            folder.mkdir(parents=True, exist_ok=True)
            kept = (folder / path.name).as_posix()
            write_whole(kept, path.read_bytes(), SuiteError, f"recording {kept}")
            if comparison is not None:
                written = str(report.report_write(comparison, folder, case.name))
        wall = time.perf_counter() - began
        return Result(case.name, status, words, simulated, wall, shown, kept, written, note)

    if not case.golden.exists():
        if not update:
            return result(NO_GOLDEN, f"there is no {case.golden}: --update-golden writes it")
        _keep(path, case.golden)
        return result(WRITTEN, note)
    flight = replace(new, name=case.name)
    try:
        comparison = compare(_golden(case), flight, case.tolerance)
    except (RecordingError, LogError, AlignmentError) as error:  # nothing that this flight can be held against
        if not update:
            raise
        _keep(path, case.golden)
        return result(REPLACED, f"golden was of no use: {error}")
    if update:
        if comparison.first_trace is None and comparison.ok and not comparison.is_old:
            return result(KEPT, "", comparison)
        _keep(path, case.golden)
        return result(REPLACED, OLD if comparison.ok and comparison.is_old else comparison.headline, comparison)
    words = [] if comparison.ok else [comparison.headline]
    if comparison.advice:
        folder = case.golden.parents[1]
        words.append(f"{comparison.advice}: {UPDATE.format(folder=folder, name=case.name)}")
    return result(OK if comparison.ok else DIFFERS, "\n    ".join(words), comparison)


def _golden(case: Case) -> Flight:
    return of_recording(read(case.golden))


def _keep(path: Path, golden: Path) -> None:
    """Replace golden by a recording, atomically.

    Raises:
        SuiteError: it cannot be written there.
    """
    try:
        golden.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SuiteError(f"golden flight {golden} cannot be written: {error.strerror or error}") from None
    write_whole(golden, path.read_bytes(), SuiteError, f"golden flight {golden}")
