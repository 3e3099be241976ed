# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.conformance --suite PATH copter|rover TEST... [--jobs N] [--speedup K] [--binary PATH]``.

``python -m benchmarks.conformance --scan TABLE copter|rover [--binary PATH] [--keep] [--rows PATTERN]``.
"""

from __future__ import annotations

import argparse
import json
import os
import queue
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from benchmarks.manoeuvres.executable import enter_namespace

from . import processes, table
from .scans import TABLES
from .scans.run import scan
from .table import Outcome

ROOT = Path(__file__).parents[2]
DRIVER = Path(__file__).with_name("driver.py")
PROGRAMS = {"copter": "arducopter", "rover": "ardurover"}


@dataclass(frozen=True)
class Run:
    """What every test of a run has."""

    vehicle: str
    speedup: int
    binary: Path
    python: str
    timeout_s: float
    folder: Path
    namespace: tuple[str, ...]

    def test(self, name: str, checkout: Path) -> Outcome:
        """Run a test on a copy of the suite that nobody else uses meanwhile."""
        folder = self.folder / self.vehicle / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        report = folder / "report.json"
        command = [
            *self.namespace, self.python, str(DRIVER), self.vehicle, name, str(self.speedup), str(self.binary),
            str(checkout), str(report),
        ]  # fmt: skip
        tools = str(Path(self.python).parent)  # MAVProxy is beside its Python
        environment = {**os.environ, "BUILDLOGS": str(folder), "PATH": f"{tools}{os.pathsep}{os.environ['PATH']}"}
        start = time.monotonic()
        code = processes.run(command, folder, folder / "log.txt", self.timeout_s, environment)
        wall = time.monotonic() - start
        if report.exists():
            said = json.loads(report.read_text(encoding="utf-8"))
            result = "pass" if said["passed"] else "fail"
            return Outcome(self.vehicle, name, result, said["cause"], said["where"], wall)
        if code is None:
            return Outcome(self.vehicle, name, "timeout", f"ended after {self.timeout_s:g} s", "", wall)
        last = (folder / "log.txt").read_text(encoding="utf-8", errors="replace").strip().splitlines()
        return Outcome(self.vehicle, name, "error", last[-1] if last else f"exit code {code}", "", wall)


def copy_of(suite: Path, folder: Path) -> Path:
    """A checkout of which only ``Tools/autotest`` is copied: the tests write into it."""
    (folder / "Tools").mkdir(parents=True)
    ignored = shutil.ignore_patterns("__pycache__", "*.pyc")
    shutil.copytree(suite / "Tools" / "autotest", folder / "Tools" / "autotest", symlinks=True, ignore=ignored)
    for source, target in ((suite, folder), (suite / "Tools", folder / "Tools")):
        for entry in source.iterdir():
            if not (target / entry.name).exists():
                (target / entry.name).symlink_to(entry)
    return folder


def own_program(vehicle: str, folder: Path) -> Path:
    """An executable of ours, by this Python and this tree."""
    path = folder / PROGRAMS[vehicle]
    start = f"PYTHONPATH='{ROOT}' exec '{sys.executable}' -m sitl {path.name}"
    path.write_text(f'#!/bin/sh\n{start} "$@"\n', encoding="utf-8")
    path.chmod(0o755)
    return path


def names(words: Sequence[str]) -> Iterator[str]:
    """Tests as they were named; ``@FILE`` stands for the first word of each of its lines."""
    for word in words:
        if word.startswith("@"):
            for line in Path(word[1:]).read_text(encoding="utf-8").splitlines():
                if line.strip() and not line.startswith("#"):
                    yield line.split()[0]
        else:
            yield word


def parser() -> argparse.ArgumentParser:
    """The command line."""
    top = argparse.ArgumentParser(prog="python -m benchmarks.conformance", description=__doc__)
    top.add_argument("vehicle", choices=sorted(PROGRAMS))
    top.add_argument("tests", nargs="*", metavar="TEST", help="name of a test, or @FILE with a name a line")
    top.add_argument("--suite", type=Path, metavar="PATH", help="checkout of ArduPilot (Tools/autotest)")
    top.add_argument("--scan", choices=TABLES, metavar="TABLE", help=f"a table instead: {', '.join(TABLES)}")
    top.add_argument("--rows", default="*", metavar="PATTERN", help="of a table: only rows that match")
    top.add_argument("--keep", action="store_true", help="of a table: keep what --binary answered")
    top.add_argument("--jobs", type=int, default=1, metavar="N", help="tests at once (default 1)")
    top.add_argument("--speedup", type=int, default=10, metavar="K", help="default 10")
    top.add_argument("--timeout", type=float, default=600.0, metavar="S", help="wall time of a test (default 600)")
    top.add_argument("--binary", type=Path, metavar="PATH", help="executable to test (default: ours)")
    top.add_argument("--python", default=sys.executable, metavar="PATH", help="Python that has what the suite needs")
    top.add_argument("--folder", type=Path, metavar="DIR", help="keep what the tests write there")
    top.add_argument("--out", type=Path, metavar="FILE", help="write the table there, as .md and .json")
    return top


def main() -> int:
    """Run the tests; the exit code is 0 when all pass."""
    options = parser().parse_args()
    if options.scan:
        if options.binary:
            enter_namespace()
        words = (options.scan, options.vehicle, options.binary, options.keep, options.rows, options.speedup)
        return 1 if scan(*words) else 0
    if options.suite is None or not options.tests:
        sys.exit("name a checkout of ArduPilot (--suite PATH) and tests, or a table (--scan TABLE)")
    suite = options.suite.resolve()
    if not (suite / "Tools" / "autotest").is_dir():
        sys.exit(f"--suite {options.suite}: there is no folder Tools/autotest")
    tests = list(dict.fromkeys(names(options.tests)))
    namespace = processes.namespace()
    jobs = max(options.jobs, 1)
    if jobs > 1 and not namespace:
        print("a network namespace of its own is not allowed here: one test at a time", file=sys.stderr)
        jobs = 1
    outcomes: list[Outcome] = []
    with tempfile.TemporaryDirectory(prefix="conformance-") as temporary:
        scratch = Path(temporary)
        binary = options.binary.resolve() if options.binary else own_program(options.vehicle, scratch)
        folder = (options.folder or scratch / "runs").resolve()
        run = Run(
            options.vehicle, options.speedup, binary, options.python, options.timeout, folder, namespace
        )  # fmt: skip
        copies: queue.SimpleQueue[Path] = queue.SimpleQueue()
        for k in range(min(jobs, len(tests))):
            copies.put(copy_of(suite, scratch / f"suite{k}"))

        def one(name: str) -> Outcome:
            checkout = copies.get()
            try:
                return run.test(name, checkout)
            finally:
                copies.put(checkout)

        shown = str(options.binary) if options.binary else f"sitl {PROGRAMS[options.vehicle]}"
        with ThreadPoolExecutor(jobs) as pool:
            for done in as_completed([pool.submit(one, name) for name in tests]):
                outcome = done.result()
                outcomes.append(outcome)
                print(f"{outcome.test}: {outcome.result} ({outcome.wall_s:.0f} s) {outcome.cause}", flush=True)
                if options.out:
                    table.write(outcomes, shown, options.speedup, options.out)
    print(table.markdown(outcomes, shown, options.speedup))
    return 0 if all(outcome.result == "pass" for outcome in outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
