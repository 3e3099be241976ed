# SPDX-License-Identifier: BSD-3-Clause
"""On-board logs as tools read them (pymavlink's DFReader): of a flight in GUIDED at rest, and of a refused arming.

"format XKF4" has types, names, units and multipliers of a message that ours can write; "value XKF4.SV" the median of a
number at rest and how far ours may be from it, by its unit; "messages" what is written; "changed" the parameters that
are written again; "refused" what is in the log of a refused arming.
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from pymavlink import DFReader

from sitl.logs.dataflash.common import EVENT_MESSAGES
from sitl.logs.dataflash.encoder import EVERY_BIT
from sitl.logs.kind import logs_of

from .fields import agrees
from .program import HEIGHT_M, Programs

__all__ = ["agrees", "scan"]
TOLERANCES = {
    "m": 1.0, "n": 0.3, "d": 2.0, "h": 4.0, "k": 3.0, "E": 0.06, "o": 0.5, "G": 15.0, "v": 0.1, "A": 3.0, "a": 60.0,
    "X": 1.0, "%": 3.0, "?": 0.06, "Y": 40.0, "D": 1e-5, "U": 1e-5, "P": 150.0, "r": 0.06, "-": 0.1, "": 0.1, "w": 0.02,
}  # fmt: skip
"""By the letter of a unit: how far a number may be from the real one's, besides 5 % of it."""
PLACES = ("D", "U")
"""Units of latitude and longitude."""
TIMES = re.compile(r"TimeUS|.*\.(SMS|GMS|S|LastMeasMS|GWk|Spd|GCrs)")
CHANGES = re.compile(
    r"(PID.|RATE|PSC.|THR|STER|NTUN|VIBE|XKF[1235])\..*|(ATT|ANG)\.Des.*|IMU\.T|SIM2\.(V.|ASpdU|UFC)|PM\.(NLon|MaxT|R)"
)
"""Numbers of which the noise of a flight at rest, or of the machine, is all that there is."""
SECONDS = 10.0


def scan(programs: Programs) -> dict[str, Any]:
    """All rows."""
    regular = {m.name for m in logs_of(programs.kind).messages(EVERY_BIT, 0, True)}
    rows: dict[str, Any] = {}
    with TemporaryDirectory(prefix="logs-") as folder:
        begin, end = flown(programs, Path(folder))
        rows |= _of_flight(last(folder), regular, begin, end)
    with TemporaryDirectory(prefix="logs-") as folder:
        with programs.started(folder=Path(folder)) as program:
            program.be_ready()
            program.params["BATT_ARM_VOLT"] = 50.0
            program.delay(2.0)
            program.send_command("COMPONENT_ARM_DISARM", 1)
            program.delay(20.0)
        rows["refused"] = _of_refusal(last(folder))
    return {name: value for name, value in rows.items() if fnmatchcase(name, programs.rows)}


def flown(programs: Programs, folder: Path) -> tuple[float, float]:
    """A short flight in GUIDED; when it began and ceased to rest [s since boot]. Its log is in ``folder``."""
    with programs.started({"FS_OPTIONS": 0.0, "FS_GCS_ENABLE": 0.0}, folder=folder) as program:
        program.be_flying()
        program.goto(20.0, 10.0, **({"altitude": HEIGHT_M} if program.of == "copter" else {}))
        program.delay(10.0)
        begin = program.now
        program.delay(SECONDS)
        end = program.now
        program.set_mode("LAND" if program.of == "copter" else "HOLD")
        if program.of == "rover":
            program.disarm()
        program.passes(lambda: not program.armed, 60.0)
        program.delay(3.0)
    return begin, end


def last(folder: str) -> Path | None:
    """The last log below a folder; None: there is none."""
    return max((Path(folder) / "logs").glob("*.BIN"), default=None)


def _of_flight(path: Path | None, regular: set[str], begin: float, end: float) -> dict[str, Any]:
    wanted = regular | {m.name for m in EVENT_MESSAGES}
    assert path is not None, "a flight is logged"
    log = DFReader.DFReader_binary(str(path))
    try:
        rows: dict[str, Any] = {f"unit {letter}": label for letter, label in sorted(log.unit_lookup.items())}
        rows |= {f"multiplier {letter}": factor for letter, factor in sorted(log.mult_lookup.items())}
        ids = _ids(log)
        for name, form in sorted((form.name, form) for form in log.formats.values() if form.name in wanted):
            rows[f"format {name}"] = " ".join((form.format, ",".join(form.columns), *ids.get(form.type, ("", ""))))
        values: dict[str, list[Any]] = defaultdict(list)
        written, changed = set(), set()
        log.rewind()
        while (m := log.recv_msg()) is not None:
            name = m.get_type()
            written.add(name)
            if name == "PARM" and math.isnan(m.Default):
                changed.add(m.Name)
            at = getattr(m, "TimeUS", 0) * 1e-6
            is_first = getattr(m, m.fmt.instance_field, 0) == 0 if m.fmt.instance_field else getattr(m, "C", 0) == 0
            if name in regular and begin <= at <= end and is_first:
                for column in m.fmt.columns:
                    values[f"{name}.{column}"].append(getattr(m, column))
        letters = {form.name: (form.columns, ids.get(form.type, ("", ""))[0]) for form in log.formats.values()}
        for name, samples in sorted(values.items()):
            if not (TIMES.fullmatch(name) or name.endswith(".TimeUS") or CHANGES.fullmatch(name)):
                message, _, column = name.partition(".")
                columns, units = letters[message]
                k = columns.index(column)
                rows[f"value {name}"] = _value(samples, units[k : k + 1])
        rows["messages"] = sorted(written)
        rows["changed"] = sorted(changed)
        return rows
    finally:
        log.close()


def _ids(log: Any) -> dict[int, tuple[str, str]]:
    """Letters of units and multipliers by the number of a message."""
    found: dict[int, tuple[str, str]] = {}
    log.rewind()
    while (m := log.recv_match(type="FMTU")) is not None:
        found[m.FmtType] = (m.UnitIds, m.MultIds)
    return found


def _value(samples: list[Any], unit: str) -> Any:
    if not all(isinstance(x, int | float) for x in samples):
        return str(samples[-1])
    x = median(samples)
    if not math.isfinite(x):
        return str(x)
    spread = max(samples) - min(samples)
    tolerance = max(TOLERANCES.get(unit, 0.0), 0.0 if unit in PLACES else 0.05 * abs(x), spread)
    return [float(f"{x:.9g}"), float(f"{tolerance:.3g}")]


def _of_refusal(path: Path | None) -> Mapping[str, Any]:
    """What a reader finds."""
    if path is None:
        return {"log": False}
    log = DFReader.DFReader_binary(str(path))
    try:
        count: dict[str, int] = defaultdict(int)
        times: list[float] = []
        while (m := log.recv_msg()) is not None:
            count[m.get_type()] += 1
            if m.get_type() == "ATT":
                times.append(m.TimeUS * 1e-6)
        seconds = round(times[-1] - times[0]) if times else 0
        return {"log": True, "PARM": count["PARM"] > 1000, "ARM": count["ARM"] > 0, "seconds": 10 <= seconds <= 16}
    finally:
        log.close()
