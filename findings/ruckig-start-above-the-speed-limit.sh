#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# ruckig 0.19.4: a start above max_velocity whose acceleration already brings it below is braked harder all the same. From 9.3 m/s and
# -3 m/s^2 with the limits 7 m/s, 4 m/s^2, 0.657 m/s^3, the plan over 300 m makes the deceleration greater first, until the speed is
# 7 m/s; to take that deceleration away it goes on to -2.1 m/s: backwards. It takes 53.37 s. Two plans of its own, one of the
# velocity interface to 7 m/s and one from there, take 47.20 s together and never go backwards.
# Seen: the lines below. Fails if the first plan becomes as quick, or does not go backwards.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q ruckig==0.19.4
"$work/venv/bin/python" - <<'PYTHON'
from ruckig import ControlInterface, InputParameter, Result, Ruckig, Trajectory


def plan(start, end, interface=ControlInterface.Position):
    """A plan from (position, speed, acceleration) to (position, speed) at no acceleration."""
    wanted, found = InputParameter(1), Trajectory(1)
    wanted.control_interface = interface
    wanted.current_position, wanted.current_velocity, wanted.current_acceleration = ([value] for value in start)
    wanted.target_position, wanted.target_velocity, wanted.target_acceleration = [end[0]], [end[1]], [0.0]
    wanted.max_velocity, wanted.max_acceleration, wanted.max_jerk = [7.0], [4.0], [0.657]
    assert Ruckig(1).calculate(wanted, found) == Result.Working
    return found


def slowest(found):
    return min(found.at_time(found.duration * k / 2000)[1][0] for k in range(2001))


start = (0.0, 9.3, -3.0)
one = plan(start, (300.0, 3.5))
slowing = plan(start, (0.0, 7.0), ControlInterface.Velocity)
rest = plan((slowing.at_time(slowing.duration)[0][0], 7.0, 0.0), (300.0, 3.5))
two = slowing.duration + rest.duration
print(f"one plan: {one.duration:.2f} s, down to {slowest(one):.2f} m/s; two: {two:.2f} s, down to {slowest(slowing):.2f} m/s")
assert abs(one.duration - 53.37) < 0.01 and slowest(one) < -2.0
assert abs(two - 47.20) < 0.01 and slowest(slowing) > 2.0
PYTHON
