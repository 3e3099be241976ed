# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's SITL rover (4.7-dev, unmodified) turning to a target 20 m east: its pulses, replayed here, give its path.

``data/ardupilot_rover_turn.csv`` holds the pulses [us] and the simulator's own truth at 25 Hz [s, m, rad, m/s].
"""

from __future__ import annotations

import csv
import math
from itertools import pairwise
from pathlib import Path

from pytest import approx

from sitl.physics.native import truth

RECORDING = Path(__file__).parent / "data" / "ardupilot_rover_turn.csv"


def test_the_same_pulses_give_the_same_path(rig):
    with RECORDING.open() as file:
        rows = [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]
    r = rig("ardupilot_rover", heading=math.degrees(rows[0]["yaw"]))
    ticks = 0
    for before, now in pairwise(rows):
        # Pulses are renewed at 50 Hz, recorded at 25: their mean is the nearest that is known of what came between.
        steering, throttle = ((0.5 * (before[name] + now[name]) - 1500.0) / 500.0 for name in ("servo1", "servo3"))
        r.command(steering, throttle)
        due = round(now["t"] / 0.0025)
        r.move(due - ticks)
        ticks = due
        assert list(r.p.body.pos[:2]) == approx([now["north"], now["east"]], abs=0.12)
        assert math.remainder(truth.read(r.v).euler[2] - now["yaw"], 2.0 * math.pi) == approx(0.0, abs=0.015)
        assert r.p.wheels.forward == approx(now["speed"], abs=0.03)
    assert r.p.body.pos[1] > 19.0
