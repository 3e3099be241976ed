# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/make_pages.py [PAGE ...]``: writes the pages that are made from code and measurements, or those named.

``mavlink`` takes a second; ``comparison`` and ``physics`` fly, on every engine.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))  # benchmarks are no part of the installed package

from benchmarks import engines
from benchmarks.manoeuvres import __main__ as manoeuvres
from benchmarks.recorded import __main__ as compare
from benchmarks.recorded.metrics import table
from sitl.bridge import docs as mavlink
from sitl.physics.engines import BACKENDS
from sitl.scenario import ESTIMATORS

HERE = Path(__file__).parent

COMPARISON = """# Compared with a real ArduPilot

This page compares the flights of our autopilot with those of a real ArduPilot SITL.
`python docs/make_pages.py comparison` generates it (`python -m benchmarks.recorded` prints the first tables).

The first tables use recordings of ArduPilot 4.7-dev of July 2025 (unmodified, default frames and SITL parameters,
no wind):

- a copter in GUIDED: take-off to 10 m, position 20 m north, velocity 3 m/s east for 10 s, zero velocity, three yaw
  commands, RTL;
- a copter in AUTO: take-off to 10 m, 30 m square, land;
- a rover: 2 m/s north for 10 s in GUIDED, no set-points, positions 20 m east and back, a 20 m square in AUTO, 2 m/s
  again, HOLD, RTL.

The recordings are in `benchmarks/reference/`. gym-sitl gets the same MAVLink commands at the same times, with
the airframes `ardupilot_quad` and `ardupilot_rover` and seed 0. All values are from the autopilot's own estimate
(LOCAL_POSITION_NED, ATTITUDE).

## Copter, with the Kalman filter

{copter_ekf}

## Copter, with the true state (`--estimator truth`)

{copter_truth}

### Reasons for differences above 5 % or 0.5 m

- *take-off: 0.1 m.* The recorded vehicle climbs the first 10 cm more slowly, also in its true state. From 5 m on
  the times agree.
- *3 m/s east: 2.85 m/s* (95 % of the step) *with the true state.* Both curves are almost flat there, so a small
  difference of speed is a large difference of time. With the EKF the times agree: the simulated GPS is 33 ms later
  than the EKF assumes, as in the recording (its position is 0.1 m behind the true one at 3 m/s), and the position
  controller (PSC_POSXY_P 1) corrects that by a higher speed.

## Rover, with the Kalman filter

{rover_ekf}

## Rover, with the true state (`--estimator truth`)

{rover_truth}

### Reasons for differences above 5 % or 0.5 m

- *AUTO: item 1 reached with the true state*, and so the times of the later items and the path since the start of
  AUTO. The rover stands with its back to the first waypoint. The target moves along the leg only as fast as the
  vehicle does, so the start depends on errors of the estimate. In the recording the estimated velocity is 0.03 m/s
  towards the waypoint while the vehicle stands still, so the target moves. With the true state ours stands. The
  cause is the estimator, not the controller: with the EKF, with a GPS as late as the recorded one and with the gyro
  drift of ArduPilot's SITL (SIM_DRIFT_SPEED on all axes), our estimate is 0.01 m/s, and the first waypoint is
  reached after 10.4 s. With the recorded velocity in our estimate, it is reached at the recorded time
  (`tests/autopilot/rover/modes/test_rover_square.py`).
- *HOLD: below 0.5 m/s and 0.1 m/s.* The recorded estimate is 0.03 m/s slower than the recorded vehicle, whose true
  speed is still 0.10 m/s after 6.0 s, when RTL begins (a dash: the speed was not reached).
- *errors at the end* of the position targets differ by centimetres: GUIDED stops when the moving target is within
  WP_RADIUS of the end, wherever the vehicle is at that time.
"""


def physics() -> str:
    """physics.md; draws its pictures too."""
    tables = {}
    for frame in engines.FLIGHTS:
        flown = engines.fly_all(frame, list(BACKENDS))
        tables[frame] = engines.table(flown)
        engines.plot(flown, f"{frame} on {len(BACKENDS)} engines", HERE / "images" / f"{frame}-engines.png")
    return (HERE / "templates" / "physics.md").read_text(encoding="utf-8").format(**tables)


def comparison() -> str:
    """comparison.md."""
    tables = {
        f"{kind}_{estimator}": table(compare.metrics(kind, estimator))
        for kind in compare.FLIGHTS
        for estimator in ESTIMATORS
    }
    return f"{COMPARISON.format(**tables)}\n{manoeuvres.kept_beside_ours()}"


def messages() -> str:
    """mavlink.md."""
    return mavlink.page((HERE / "templates" / "mavlink.md").read_text(encoding="utf-8"))


PAGES: dict[str, Callable[[], str]] = {"comparison": comparison, "mavlink": messages, "physics": physics}


def main(words: Sequence[str] | None = None) -> None:
    """Write the pages that the command line names."""
    parser = argparse.ArgumentParser(
        prog="python docs/make_pages.py", description="Writes pages that are made from code."
    )
    parser.add_argument("pages", nargs="*", metavar="PAGE", help=f"{', '.join(PAGES)}; default: all of them")
    names = parser.parse_args(words).pages
    for name in names:
        if name not in PAGES:
            parser.error(f"page {name!r} is not made here; there are {', '.join(PAGES)}")
    for name in names or PAGES:
        (HERE / f"{name}.md").write_text(PAGES[name](), encoding="utf-8")


if __name__ == "__main__":
    main()
