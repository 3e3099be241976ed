# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/make_pages.py``: writes the pages that are made from code and measurements."""

from __future__ import annotations

from pathlib import Path

from missions import compare
from sitl.autopilot.params import docs
from sitl.bridge import docs as mavlink

HERE = Path(__file__).parent

COMPARISON = """# Beside a real ArduPilot

Made by `python docs/make_pages.py` (the table alone: `python -m missions.compare`).

A real ArduPilot SITL (ArduCopter 4.7-dev of July 2025, unmodified, default quad frame and SITL parameters, no wind) was
recorded flying two scripts: a GUIDED one (take-off 10 m, position 20 m north, velocity 3 m/s east for 10 s, zero
velocity, three yaw commands, RTL) and an AUTO mission (take-off 10 m, 30 m square, land). The columns are in
`missions/reference/`. Here the same commands are sent at the same times, as MAVLink bytes, to this simulator with the
airframe `ardupilot_quad`; both sides are the autopilot's own estimate (LOCAL_POSITION_NED, ATTITUDE), seed 0.

## With the Kalman filter

{ekf}

## With the true state (`--estimator truth`)

{truth}

## Where it differs by more than 5 % or 0.5 m, and why

- *take-off: 0.1 m.* The recorded vehicle lifts its first 10 cm more slowly, in its own ground truth too; from 5 m on
  the times agree.
- *3 m/s east: 2.85 m/s* (95 % of the step). Both curves are almost level there: the speeds at 2.1 s differ by
  little, and little speed is much time. The likely cause is the recorded estimator: its position falls behind its own
  velocity (a figure of its own in the table), and the position loop (PSC_POSXY_P 1) makes that up as speed.
- *3 m/s east: 1 m/s* is 0.04 s later: one telemetry sample of the recording.
"""


def main() -> None:
    """Write comparison.md, mavlink.md and parameters.md."""
    tables = {estimator: compare.table(compare.figures(estimator)) for estimator in ("ekf", "truth")}
    (HERE / "comparison.md").write_text(COMPARISON.format(**tables), encoding="utf-8")
    template = (HERE / "templates" / "mavlink.md").read_text(encoding="utf-8")
    (HERE / "mavlink.md").write_text(mavlink.page(template), encoding="utf-8")
    (HERE / "parameters.md").write_text(docs.page(), encoding="utf-8")


if __name__ == "__main__":
    main()
