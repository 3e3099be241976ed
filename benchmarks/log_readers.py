# SPDX-License-Identifier: BSD-3-Clause
"""How fast a DataFlash log is read and identified, beside other readers of Python that are installed.

    python -m benchmarks.log_readers                       # flies 120 MB of half an hour: 3 minutes, 3 GB of memory
    python -m benchmarks.log_readers --log flight.bin      # another log
    pip install mavparser ardupilot-log-reader pandas      # readers that are compared besides pymavlink

Each reader gets all messages into columns, by field, in a process of its own; "rows only" stops at what the reader
itself gives. Processor time, and the greatest memory above that of the process before it reads. The log is flown by our
autopilot: the plan of ``sitl identify`` again and again with gusts, the attitude at 400 Hz as ArduPilot logs it.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from sitl import Simulation, vehicles
from sitl.client import Client
from sitl.identify.flight_plan import write
from sitl.logs.dataflash import bits
from sitl.logs.dataflash.log import attach
from sitl.missions import files
from sitl.vehicles import CopterAirframe

_PLAN_S = 290.0
"""How long the plan takes, about."""
_PARAMETERS = {
    "SIM_WIND_SPD": 3.0, "SIM_WIND_DIR": 60.0, "SIM_WIND_TURB": 0.4, "SIM_WIND_T": 1.0, "LOG_DISARMED": 1.0,
    "WP_YAW_BEHAVIOR": 0.0, "WPNAV_ACCEL": 400.0, "WPNAV_JERK": 10.0, "LOG_BITMASK": 4194303.0,
}  # fmt: skip
_LOOP_HZ = 400.0
"""Rate at which ArduPilot logs the attitude with bit 0 of LOG_BITMASK."""


def fly(path: Path, minutes: float) -> None:
    """Write a log of about this length."""
    airframe = vehicles.load("erle_copter")
    assert isinstance(airframe, CopterAirframe)
    large = {"battery_capacity": max(2.0 * minutes, 20.0)}
    bits.FAST, usual = _LOOP_HZ, bits.FAST
    simulation = Simulation(replace(airframe, properties={**airframe.properties, **large}), seed=1, params=_PARAMETERS)
    try:
        attach(simulation, path)
        vehicle = Client(simulation)
        vehicle.wait_ready()
        vehicle.delay(30)
        vehicle.take_off(5)
        plan = path.with_suffix(".waypoints")
        latitude, longitude, _ = vehicle.home()
        write(plan, (1e-7 * latitude, 1e-7 * longitude))
        home, up, *legs, back = files.load(plan).mission.items
        vehicle.upload([home, up, *legs * max(round(60.0 * minutes / _PLAN_S), 1), back])
        vehicle.start_mission()
        vehicle.wait_disarmed(timeout=120.0 * minutes + 600.0)
    finally:
        simulation.close()
        bits.FAST = usual


def _ours(path: str) -> int:
    from sitl.logs.dataflash.columns import Columns

    log = Columns(path)
    count = 0
    for table in map(log.__getitem__, log):
        columns = {field: table[field] for field in table.fields}
        count += len(table) if columns else 0
    return count


def _pymavlink(path: str) -> int:
    from pymavlink import DFReader

    log, columns = DFReader.DFReader_binary(path), dict[str, list[list[Any]]]()
    count = 0
    while (message := log.recv_msg()) is not None:
        count += 1
        name = message.get_type()
        if name not in columns:
            columns[name] = [[] for _ in message.fmt.columns]
        for column, label in zip(columns[name], message.fmt.columns):
            column.append(getattr(message, label))
    arrays = {name: [np.array(column) for column in found] for name, found in columns.items()}
    return count if arrays else 0


def _pymavlink_rows(path: str) -> int:
    from pymavlink import DFReader

    log, count = DFReader.DFReader_binary(path), 0
    while log.recv_msg() is not None:
        count += 1
    return count


def _mavparser_rows(path: str) -> int:
    import mavparser

    return sum(1 for _ in mavparser.parse(path))


def _mavparser(path: str) -> int:
    import mavparser

    columns: dict[str, dict[str, list[Any]]] = {}
    count = 0
    for message in mavparser.parse(path):
        count += 1
        found = columns.setdefault(message["mavpackettype"], {label: [] for label in message})
        for label, value in message.items():
            found[label].append(value)
    arrays = {name: {k: np.array(v) for k, v in found.items()} for name, found in columns.items()}
    return count if arrays else 0


def _log_reader(path: str) -> int:
    from ardupilot_log_reader.reader import Ardupilot

    return sum(map(len, Ardupilot.parse(path, types=["*"]).dfs.values()))


def _identify(path: str) -> int:
    from sitl.identify import identify

    return sum(estimate.is_observed for estimate in identify(path).estimates)


READERS: dict[str, tuple[str, Callable[[str], int], str]] = {
    "ours": ("sitl", _ours, "sitl.logs.dataflash.columns"),
    "pymavlink": ("pymavlink", _pymavlink, "DFReader"),
    "pymavlink, rows only": ("pymavlink", _pymavlink_rows, "DFReader"),
    "mavparser": ("mavparser", _mavparser, "in C"),
    "mavparser, rows only": ("mavparser", _mavparser_rows, "in C"),
    "ardupilot-log-reader": ("ardupilot_log_reader", _log_reader, "pandas, on pymavlink"),
    "ours: sitl identify": ("sitl", _identify, "reads and identifies"),
}
"""Reader -> package, function of a path that gives the number of messages, remark."""


def measure(reader: str, path: str) -> dict[str, float]:
    """In this process: messages, processor time [s], memory [bytes]."""
    from sitl.logs.kind import kinds_with_logs

    kinds_with_logs()
    if reader.endswith("identify"):
        import sitl.identify.identification  # noqa: F401 its libraries do not count
    Path("/proc/self/clear_refs").write_text("5")  # the peak counts from here
    before, began = _memory("VmRSS"), time.process_time()
    count = READERS[reader][1](path)
    return {"count": count, "seconds": time.process_time() - began, "bytes": _memory("VmHWM") - before}


def _memory(what: str) -> float:
    """Of this process: VmRSS, or VmHWM, the peak (Linux) [bytes]."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024.0 * next(float(line.split()[1]) for line in lines if line.startswith(what))


def main(argv: list[str] | None = None) -> int:
    """Fly, read, print the table."""
    parser = argparse.ArgumentParser(prog="benchmarks.log_readers", description=__doc__.partition("\n")[0])
    parser.add_argument("--log", type=Path, metavar="FILE.bin", help="this log instead of one that is flown")
    parser.add_argument("--minutes", type=float, default=30.0, metavar="N", help="of the flight (default 30)")
    parser.add_argument("--readers", nargs="+", default=list(READERS), choices=list(READERS), metavar="NAME")
    parser.add_argument("--one", metavar="NAME", choices=list(READERS), help=argparse.SUPPRESS)
    options = parser.parse_args(argv)
    if options.one:
        print(json.dumps(measure(options.one, str(options.log))))
        return 0
    with tempfile.TemporaryDirectory() as folder:
        path = options.log or Path(folder) / "flight.bin"
        if options.log is None:
            fly(path, options.minutes)
        size = path.stat().st_size
        print(f"{path.name}: {1e-6 * size:.1f} MB")
        print("| reader | messages | processor time [s] | by ours | memory by the file's size |\n|---|---|---|---|---|")
        ours = 0.0
        for name in options.readers:
            package, _, remark = READERS[name]
            if importlib.util.find_spec(package) is None:
                print(f"| {name} ({remark}) | not installed | | | |")
                continue
            command = [sys.executable, "-m", "benchmarks.log_readers", "--one", name, "--log", str(path)]
            result = subprocess.run(command, capture_output=True, text=True)
            if result.returncode:
                print(f"| {name} ({remark}) | fails: {result.stderr.strip().splitlines()[-1][:80]} | | | |")
                continue
            found = json.loads(result.stdout)
            ours = ours or found["seconds"]
            count = f"{found['count']:,}" if not name.endswith("identify") else f"{found['count']} properties"
            print(
                f"| {name} ({remark}) | {count} | {found['seconds']:.2f} | {found['seconds'] / ours:.0f} | "
                f"{found['bytes'] / size:.1f} |",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
