# SPDX-License-Identifier: BSD-3-Clause
"""A log's flight in a test: its twin, flown by this version, agrees with it within limits."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sitl.missions.twin.twin import Twin
    from sitl.vehicles import Airframe


def assert_twin(log: str | Path, limits: Mapping[str, float], *, frame: str | Airframe, **options: Any) -> Twin:
    """The flight of a log, flown again (``sitl twin``), agrees with the log.

    Args:
        log: DataFlash log (.bin, .log).
        limits: by name: {"height.rms": 0.5, "segments.roll_rate.vaf": 80.0}; of .vaf the least, of others the greatest.
        frame: airframe of the twin: its name, or the path of a file.
        options: as for ``sitl.missions.twin.twin.fly``: flight, seed, wind, change ...

    Returns:
        The twin with all metrics.

    Raises:
        AssertionError: a metric is beyond its limit; all such are named, and where model or autopilot differ.
        OptionError: a limit is of no metric of this flight; there are no limits.
        sitl.missions.twin.flight_log.TwinError, sitl.logs.tlog.LogError: the log has no flight that can be flown again.
    """
    __tracebackhide__ = True
    from sitl.errors import OptionError
    from sitl.missions.twin import limits as judging
    from sitl.missions.twin import twin

    if not limits:
        raise OptionError("assert_twin without limits tests nothing: {'height.rms': 0.5}")
    found = twin.fly(log, frame, **options)
    beyond = [verdict.words for verdict in judging.judge(found.metrics(), limits) if not verdict.ok]
    if beyond:
        raise AssertionError(
            "\n".join([f"the twin of {log} does not fly like the log:", *(f"  {text}" for text in beyond),
                       *(f"  {text}" for text in (*found.findings, *found.went))])
        )  # fmt: skip
    return found
