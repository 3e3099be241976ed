# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest
from pytest import approx

from sitl.core import records
from sitl.core.kernels import jit_disabled


@pytest.mark.skipif(jit_disabled(), reason="nothing is compiled")
@pytest.mark.parametrize("frame", ["erle_rover", "ardupilot_rover", "skid_rover"])
def test_compiled_and_plain_python_drive_the_same_bits(rig, frame):
    plain, compiled = rig(frame, gps_start=0.01, grip=0.3), rig(frame, gps_start=0.01, grip=0.3)
    unit = compiled.compiled()
    for k, (first, second) in enumerate(np.random.default_rng(1).uniform(-1.0, 1.0, (200, 2))):
        for r in (plain, compiled):
            if k % 20 == 0:
                r.command(first, second)
        plain.step()
        unit(compiled.fleet.ctypes.data, 1, 0)
        assert records.first_difference(plain.fleet[0], compiled.fleet[0]) is None
    assert plain.v.sensors.gps_count > 0
    assert plain.p.wheels.forward != 0.0


def test_wheel_encoders_count_at_their_rate(rig):
    r = rig("erle_rover")
    r.command(0.0, 0.8)
    r.step(800)
    s = r.v.sensors
    assert s.wheel_count == 100
    assert list(s.wheel_distance) == approx(list(r.p.wheels.distance), abs=0.035)  # up to 7 ticks ago
    counts = s.wheel_distance[0] / 0.002
    assert counts == approx(round(counts), abs=1e-6)


def test_no_encoder_no_samples(rig):
    r = rig("ardupilot_rover")
    r.command(0.0, 0.8)
    r.step(20)
    assert r.v.sensors.wheel_count == 0
    assert list(r.v.sensors.wheel_distance) == [0.0, 0.0]


def test_power_on_forgets_the_drive(rig):
    r, fresh = rig("skid_rover", seed=2), rig("skid_rover", seed=2)
    r.command(0.3, 0.8)
    r.step(20)
    r.power_on(seed=2)
    assert records.first_difference(r.fleet[0], fresh.fleet[0]) is None
