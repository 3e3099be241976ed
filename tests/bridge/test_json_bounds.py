# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of a line of the JSON interface: the greatest that are a motion, and those beyond."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

from sitl.bridge.ardupilot_json.answer import Motion, MotionError, decode

AT_REST: dict[str, Any] = {
    "timestamp": 1.0,
    "imu": {"gyro": [0.0, 0.0, 0.0], "accel_body": [0.0, 0.0, -9.81]},
    "position": [0.0, 0.0, 0.0],
    "quaternion": [1.0, 0.0, 0.0, 0.0],
    "velocity": [0.0, 0.0, 0.0],
}
ABOVE = 1.0 + 1e-12


def read(*path: str, value: Any = None) -> Motion:
    """A line at rest in which one member has another value (None: it is left out)."""
    fields = json.loads(json.dumps(AT_REST))
    inner = fields
    for key in path[:-1]:
        inner = inner.setdefault(key, {})
    if value is None:
        inner.pop(path[-1], None)
    else:
        inner[path[-1]] = value
    return decode(json.dumps(fields, separators=(",", ":")).encode())


@pytest.mark.parametrize(
    ("path", "found", "most"),
    [
        (("imu", "gyro"), "gyro", 1e3),
        (("imu", "accel_body"), "accel", 1e5),
        (("position",), "position", 1e7),
        (("velocity",), "velocity", 1e4),
    ],
)
def test_vectors(path: tuple[str, ...], found: str, most: float) -> None:
    for sign in (1.0, -1.0):
        for k in range(3):
            inside = [0.0] * 3
            inside[k] = sign * most
            assert getattr(read(*path, value=inside), found) == tuple(inside)
            inside[k] *= ABOVE
            with pytest.raises(MotionError, match=rf"^{path[-1]} .* is out of all bounds$"):
                read(*path, value=inside)
    for short in ([0.0] * 2, [0.0] * 4, 0.0):
        with pytest.raises(MotionError, match=rf"^{path[-1]} .* is not 3 numbers$"):
            read(*path, value=short)
    with pytest.raises(MotionError, match=f"^field {path[-1]} is missing$"):
        read(*path)
    for odd in (True, "1"):
        with pytest.raises(MotionError, match=rf"^{path[-1]} .* is not a number$"):
            read(*path, value=[0.0, odd, 0.0])
    assert getattr(read(*path, value=[1, 2, 3]), found) == (1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("path", "least", "most"),
    [
        (("timestamp",), 0.0, 1e9),
        (("battery", "voltage"), -1e4, 1e4),
        (("battery", "current"), -1e5, 1e5),
        (("rc", "rc_1"), -65535.0, 65535.0),
    ],
)
def test_single_numbers(path: tuple[str, ...], least: float, most: float) -> None:
    def of(value: float) -> Any:
        if path[0] != "battery":
            motion = read(*path, value=value)
            return motion.time if path[0] == "timestamp" else motion.receiver[0]
        motion = read("battery", value={"voltage": 1.0, "current": 1.0, path[1]: value})
        assert motion.battery is not None
        return motion.battery[path[1] == "current"]

    assert (of(least), of(most)) == (least, most)
    with pytest.raises(MotionError, match=f"^{path[-1]} .* is out of all bounds$"):
        of(most * ABOVE)
    with pytest.raises(MotionError, match=f"^{path[-1]} .* (is out of all bounds|is negative)$"):
        of(least * ABOVE if least else -1e-300)


@pytest.mark.parametrize("length, taken", [(0.5, True), (2.0, True), (0.4999, False), (2.0001, False), (0.0, False)])
def test_a_quaternion_has_about_length_one(length: float, taken: bool) -> None:
    given = [0.6 * length, 0.0, 0.8 * length, 0.0]
    if taken:
        assert read("quaternion", value=given).attitude == pytest.approx((0.6, 0.0, 0.8, 0.0))
    else:
        with pytest.raises(MotionError, match=r"quaternion .* has length .*, not 1"):
            read("quaternion", value=given)


@pytest.mark.parametrize("angle, taken", [(1e3, True), (-1e3, True), (1e3 * ABOVE, False)])
def test_angles_may_have_turned_often(angle: float, taken: bool) -> None:
    fields = {key: value for key, value in AT_REST.items() if key != "quaternion"}
    line = json.dumps({**fields, "attitude": [0.0, 0.0, angle]}).encode()
    if taken:
        w, _, _, z = decode(line).attitude
        assert (w, z) == pytest.approx((math.cos(angle / 2), math.sin(angle / 2)))
    else:
        with pytest.raises(MotionError, match=r"attitude .* is out of all bounds"):
            decode(line)


def test_ranges_may_be_far_and_each_may_be_left_out() -> None:
    line = json.dumps({**AT_REST, "rng_1": 1e30, "rng_3": 2, "rng_6": 0.5, "rng_7": 9.0}).encode()
    assert decode(line).ranges == (1e30, None, 2.0, None, None, 0.5)
    assert decode(json.dumps(AT_REST).encode()).ranges == ()


def test_pulses_count_to_the_first_that_is_missing_and_to_sixteen() -> None:
    rc = {f"rc_{k}": 1000.4 + k for k in range(1, 19)}
    assert read("rc", value=rc).receiver == tuple(range(1001, 1017))
    del rc["rc_3"]
    assert read("rc", value=rc).receiver == (1001, 1002)
    assert read("rc", value=[1, 2]).receiver == ()
