# SPDX-License-Identifier: BSD-3-Clause
"""Golden flights: this flight must be as one that was kept."""

from __future__ import annotations

import os
import tempfile
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sitl.core.whole_file import write_whole
from sitl.envs.mavlink.foreign import Foreign
from sitl.errors import OptionError, SitlError
from sitl.logs.tlog import LogError
from sitl.recording.entries import RecordingError

from ..comparison.alignment import AlignmentError
from . import digests
from .logs import NOT_AGAIN, fly_again
from .moments import Forking

__tracebackhide__ = True

Limits = str | Path | Mapping[str, Any] | None
"""See ``sitl.missions.comparison.tolerance.load``."""


class FlightChanged(UserWarning):
    """A flight is like golden within the limits of "same", and yet not the same."""


class OldGolden(UserWarning):
    """A golden flight is of a version whose last bits depended on the machine, and is not compared exactly."""


@dataclass
class GoldenStore:
    """What is known of goldens while a test runs."""

    folder: Path = Path()
    """Relative paths are counted from here: the test's own folder."""
    update: bool = False
    """Goldens are to be written."""
    how: str = "run pytest with --sitl-update-golden"
    """How they are made."""
    reports: Path | None = None
    """Where reports of differences go."""
    checked: list[Path] = field(default_factory=list)
    """Goldens of this test that were written, or would have been if they were not like that already."""
    written: list[Path] = field(default_factory=list)
    taken: dict[Path, str] = field(default_factory=dict)
    """Golden -> the test that wrote it in this session."""
    test: str = ""


class Golden(Forking):
    """A vehicle whose flight can be compared with golden."""

    golden: GoldenStore = GoldenStore()

    def save_recording(self, path: str | Path) -> Path:
        """Keep a recording (.rec) of the flight from power-on until now: ``sitl mission replay`` flies it again."""
        path = Path(path)
        self._record(path.parent, path.stem)
        if path.suffix != ".rec":
            os.replace(path.with_suffix(".rec"), path)
        return path

    def assert_flies_like(self, golden: str | Path, tolerance: Limits = None) -> None:
        """The flight from power-on until now is like a golden one.

        Args:
            golden: relative to the test's folder: a recording (.rec), or a .tlog or .bin; of a real ArduPilot, digests
                (.digests), which are compared exactly.
            tolerance: "exact", "same", "alike", a distance with its unit ("0.5 m"), a .toml file relative to the test's
                folder, or a mapping of the same shape; None: if golden is of the same vehicle, world and seed, "exact"
                on native physics, "same" on another engine; else "alike".

        Raises:
            AssertionError: it is not, and where it left golden first; or there is no such golden. Only
                ``--sitl-update-golden`` writes goldens.
        """
        path = self.golden.folder / golden
        if path.suffix == digests.SUFFIX:
            self._assert_digests(path, tolerance)
            return
        self._must_repeat()
        with tempfile.TemporaryDirectory(prefix="sitl-") as folder:
            if self.golden.update:
                self._update(path, self._record(Path(folder), "new"))
                return
            if not path.exists():
                raise AssertionError(
                    f"there is no golden flight {path}; to write it from this flight: {self.golden.how}"
                )
            try:
                problem = self._compare(path, self._record(Path(folder), "new"), tolerance)
            except (RecordingError, LogError, AlignmentError) as error:
                lines = [f"golden flight {path} cannot be used: {error}", f"  to write it again: {self.golden.how}"]
                raise AssertionError("\n".join(lines)) from None
        if problem:
            raise AssertionError("\n".join([*problem, f"  if the change is intended: {self.golden.how}"]))

    def _assert_digests(self, path: Path, tolerance: Limits) -> None:
        """The flight of a real ArduPilot is a golden one, bit for bit."""
        flight = self.connection
        if not isinstance(flight, Foreign) or not flight.repeats:
            raise OptionError(
                f"golden flight {path}: {digests.SUFFIX} is of flights with an ArduPilot that was started here"
            )
        if tolerance not in (None, "exact"):
            raise OptionError(f"golden flight {path}: tolerance {tolerance!r}: digests are compared exactly")
        if self.golden.update:
            self._claim(path)
            if digests.write(path, flight):
                self.golden.written.append(path)
            return
        if not path.exists():
            raise AssertionError(f"there is no golden flight {path}; to write it from this flight: {self.golden.how}")
        if problem := digests.differences(path, flight):
            raise AssertionError("\n".join([*problem, f"  if the change is intended: {self.golden.how}"]))

    def _must_repeat(self) -> None:
        if self.cannot_repeat:
            raise OptionError(
                f"{self.cannot_repeat}: its flight cannot be repeated: there is no recording and no golden flight"
            )

    def _record(self, folder: Path, stem: str) -> Path:
        """A recording of the flight so far."""
        self._must_repeat()
        flown = fly_again(self, folder, stem, log=False)
        if not flown.same:
            raise AssertionError(NOT_AGAIN)
        return folder / f"{stem}.rec"

    def _update(self, path: Path, new: Path) -> None:
        """Write a golden, unless it is this flight already."""
        store = self.golden
        if path.suffix != ".rec":
            raise AssertionError(f"golden flight {path} is not written: it must be a recording (.rec)")
        self._claim(path)
        if path.exists() and _kept(path) == _kept(new):
            return
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(path, new.read_bytes(), title=f"golden flight {path}")
        except OSError as error:
            raise AssertionError(f"golden flight {path} cannot be written: {error.strerror or error}") from None
        except SitlError as error:
            raise AssertionError(str(error)) from None
        store.written.append(path)

    def _claim(self, path: Path) -> None:
        """This flight is the one that the golden is of."""
        store = self.golden
        before = store.taken.setdefault(path.resolve(), store.test)
        if before != store.test or path in store.checked:
            raise AssertionError(
                f"golden flight {path} is already used by another flight of {before}; each flight needs its own"
            )
        store.checked.append(path)

    def _compare(self, path: Path, new: Path, tolerance: Limits) -> list[str]:
        """What is wrong, in lines; nothing when it flies like golden."""
        from ..comparison import flight, report
        from ..comparison.compare import compare
        from ..comparison.tolerance import is_file

        if isinstance(tolerance, str | Path) and is_file(tolerance):
            tolerance = self.golden.folder / tolerance
        found = compare(flight.read(path), flight.read(new), tolerance)
        if found.ok:
            if found.first_trace is not None and found.tolerance.name == "same":
                within = "within the limits of the golden flight, but no longer the same"
                text = f"{path.name}: {within}: {found.first_trace.words}"
                warnings.warn(FlightChanged(text), stacklevel=3)
            if found.is_old:
                warnings.warn(OldGolden(f"{path.name}: {found.advice}: {self.golden.how}"), stacklevel=3)
            return []
        lines = [f"golden flight {path}", *report.lines(found)]
        if self.golden.reports is not None:
            lines.append(f"  report: {report.report_write(found, self.golden.reports / path.stem)}")
        return lines


def _kept(path: Path) -> tuple[bytes | None, ...]:
    """What is compared of a recording: its track and, on native physics, the digests of its bits; nothing: it cannot be
    read."""
    from sitl.physics.engines import NATIVE
    from sitl.recording.recording import read

    try:
        recording = read(path)
    except RecordingError:
        return ()
    names = ("track", "bits") if recording.header["physics"] == NATIVE else ("track",)
    return tuple(recording.sections.get(name) for name in names)
