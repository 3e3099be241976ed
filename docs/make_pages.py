# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/make_pages.py [PAGE ...]``: writes the pages that are made from code and measurements, or those named.

``mavlink`` takes a second; ``comparison`` and ``physics`` fly, on every engine.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

from sitl.bridge import docs as mavlink
from sitl.missions import compare, engines
from sitl.missions.figures import table
from sitl.missions.manoeuvres import __main__ as manoeuvres
from sitl.physics.engines import BACKENDS
from sitl.scenario import ESTIMATORS

HERE = Path(__file__).parent

COMPARISON = """# Beside a real ArduPilot

Made by `python docs/make_pages.py comparison` (the tables alone: `python -m sitl.missions.compare`).

A real ArduPilot SITL (4.7-dev of July 2025, unmodified, default frames and SITL parameters, no wind) was recorded with
a copter flying two scripts, a GUIDED one (take-off 10 m, position 20 m north, velocity 3 m/s east for 10 s, zero
velocity, three yaw commands, RTL) and an AUTO mission (take-off 10 m, 30 m square, land), and with a rover driving one
(2 m/s north for 10 s in GUIDED, silence, positions 20 m east and back, a 20 m square in AUTO, 2 m/s again, HOLD, RTL).
The columns are in `sitl/missions/reference/`. Here the same commands are sent at the same times, as MAVLink bytes, to
this simulator with the airframes `ardupilot_quad` and `ardupilot_rover`; both sides are the autopilot's own estimate
(LOCAL_POSITION_NED, ATTITUDE), seed 0.

## Copter, with the Kalman filter

{copter_ekf}

## Copter, with the true state (`--estimator truth`)

{copter_truth}

### Where it differs by more than 5 % or 0.5 m, and why

- *take-off: 0.1 m.* The recorded vehicle lifts its first 10 cm more slowly, in its own ground truth too; from 5 m on
  the times agree.
- *3 m/s east: 2.85 m/s* (95 % of the step) *with the true state.* Both curves are almost level there, and little
  speed is much time. With the filter it agrees: the simulated receiver is 33 ms later than the filter takes it for,
  as the recorded one (its position is 0.1 m behind the truth at 3 m/s), and the position loop (PSC_POSXY_P 1) makes
  that up as speed.

## Rover, with the Kalman filter

{rover_ekf}

## Rover, with the true state (`--estimator truth`)

{rover_truth}

### Where it differs by more than 5 % or 0.5 m, and why

- *AUTO: item 1 reached with the true state*, and with it the times of the later items and the path since AUTO began.
  The rover stands with its tail to the first waypoint. Path time runs only as fast as the vehicle moves along the
  leg, and at the first moment that is decided by the estimate's errors: the recorded estimate goes 0.03 m/s towards
  the waypoint while the recorded vehicle stands still, so its target gets away; with the true state ours stands. It
  is the estimator, not the loop: with the filter, a receiver as late as the recorded one and gyros that drift as
  ArduPilot's simulated ones do (SIM_DRIFT_SPEED on all axes), our estimate goes 0.01 m/s and the first waypoint is
  reached after 10.4 s. With the recorded velocity put into our estimate it is reached as recorded
  (`tests/autopilot/rover/modes/test_rover_square.py`).
- *HOLD: below 0.5 m/s and 0.1 m/s.* The recorded estimate is 0.03 m/s slower than the recorded vehicle, which itself
  still does 0.10 m/s after 6.0 s; then RTL begins (a dash: it was not so slow by then).
- *errors at the end* of the position targets differ by centimetres: GUIDED stops as soon as the target has come within
  WP_RADIUS, wherever the vehicle is then.
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
        f"{kind}_{estimator}": table(compare.figures(kind, estimator))
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
