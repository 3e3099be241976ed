# SPDX-License-Identifier: BSD-3-Clause
"""The pacer: constant speed, and the speed that follows what the script does."""

import math
import time

import pytest

from sitl.warp import ClockPage, Pacer, pace
from tests.warp.drive import need_library, patiently, run_python


@pytest.mark.parametrize("speedup", [0, -1.0, math.inf, math.nan, "fast"])
def test_speedup_must_be_a_positive_number_or_max(speedup):
    with ClockPage() as page, pytest.raises(ValueError, match="speedup"):
        Pacer(page, speedup)


@pytest.mark.parametrize(("speedup", "slice_us"), [(1, 1000), (10, 5000), (1000, 10000)])
def test_slices_fit_the_speedup(speedup, slice_us):
    with ClockPage() as page:
        assert Pacer(page, speedup).slice_us == slice_us


def test_clock_stays_within_one_slice_of_the_simulation():
    with ClockPage() as page:
        pacer = Pacer(page, 20.0)
        for sim_us in range(0, 1_000_000, pacer.slice_us):
            pacer.pace(sim_us)
            assert sim_us <= page.now_us() <= sim_us + pacer.slice_us


def test_lost_time_is_not_made_up(monkeypatch):
    wall = time.monotonic()
    monkeypatch.setattr(pace.time, "monotonic", lambda: wall)
    with ClockPage() as page:
        pacer = Pacer(page, 1.0)
        pacer.publish(0)
        pacer._due -= 1000.0  # as if this machine had slept for a quarter of an hour
        pacer.publish(1000)
        pacer.publish(2000)
        pacer.publish(3000)
        assert pacer.remaining() == pytest.approx(0.001)


WORK = """
import json, time
def work(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end: pass
start = time.monotonic()
for _ in range(10):
    work(0.01); time.sleep(0.09)
print(json.dumps(time.monotonic() - start))
"""


def test_at_max_a_script_computes_as_in_real_time():
    need_library()

    # 0.1 s of work and 0.9 s of sleep. A machine shared with others makes the work longer, at any speed.
    def check() -> None:
        assert 1.0 <= run_python(WORK, "max") < 5.0

    patiently(check)
