# SPDX-License-Identifier: BSD-3-Clause
"""Whatever comes over the link, neither end falls over, and time goes on by whole ticks or not at all."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.bridge.dialect import message
from sitl.bridge.hil.protocol import Sender
from tests.bridge.hil.hil_bench import Bench

FROM_AUTOPILOT = ("HEARTBEAT", "HIL_ACTUATOR_CONTROLS", "COMMAND_LONG", "COMMAND_INT", "PARAM_SET", "SYSTEM_TIME")
FROM_PHYSICS = (
    "HIL_SENSOR", "HIL_GPS", "BATTERY_STATUS", "WHEEL_DISTANCE", "DISTANCE_SENSOR", "DEBUG_VECT", "DEBUG_FLOAT_ARRAY",
    "HIL_STATE_QUATERNION", "HIL_RC_INPUTS_RAW", "COMMAND_ACK", "STATUSTEXT", "PARAM_VALUE",
)  # fmt: skip


def frames(names: tuple[str, ...]) -> st.SearchStrategy[list[tuple[str, bytes]]]:
    return st.lists(st.tuples(st.sampled_from(names), st.binary(max_size=255)), min_size=1, max_size=8)


@settings(max_examples=300)
@given(frames(FROM_AUTOPILOT))
def test_the_physics_end(messages: list[tuple[str, bytes]]) -> None:
    bench, sender = Bench(), Sender(1, 1)
    for name, payload in messages:
        kind = message(name)
        before = bench.there.ticks
        bench.there.feed(sender.frame(kind, payload[: kind.size]))
        assert bench.there.ticks - before in (0, 1)
        assert bench.there.time_us == bench.physics.v.time_us
        assert all(math.isfinite(value) for value in bench.physics.v.actuators.controls)


@settings(max_examples=300)
@given(frames(FROM_PHYSICS), st.booleans())
def test_the_autopilot_end(messages: list[tuple[str, bytes]], asks: bool) -> None:
    bench, sender = Bench(), Sender(1, 158)
    bench.join()
    if asks:
        bench.here.controls()
    for name, payload in messages:
        kind = message(name)
        bench.here.feed(sender.frame(kind, payload[: kind.size]))
    v = bench.autopilot.v
    assert int(v.time_us) in (0, 2500)
    assert all(math.isfinite(value) for value in (*v.sensors.acc, *v.sensors.gyro, *v.sensors.mag))


@given(st.binary(max_size=600), st.binary(max_size=600))
def test_rubbish(there: bytes, here: bytes) -> None:
    bench = Bench()
    bench.join()
    bench.there.feed(there)
    bench.here.feed(here)
    assert bench.there.ticks == 0 and bench.autopilot.v.time_us == 0
