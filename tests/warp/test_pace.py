# SPDX-License-Identifier: BSD-3-Clause
"""The clock page alone, and the pacer: constant speed, and the speed that follows what the script does."""

from __future__ import annotations

import math
import os
import time

import pytest

from sitl.warp import ClockPage, Pacer, pace
from sitl.warp.page import FOREVER_NS, RELEASED, WAITING, PageReader
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


def test_clock_stands_still_before_the_first_publish():
    with ClockPage() as page:
        assert page.now_us() == 0
        assert PageReader(page.path).line()[-1] == WAITING
        assert PageReader(page.path).now_us() == 0


def test_clock_never_passes_what_was_granted():
    with ClockPage() as page:
        page.publish(1000, rate=1e9, grant_us=500)
        assert page.now_us() == 1500
        page.publish(2000, rate=1e9)
        assert page.now_us() == 2000


def test_clock_never_goes_back():
    with ClockPage() as page:
        reader = PageReader(page.path)
        last = 0.0
        for sim_us in (1000, 5000, 5000, 5200, 9000):
            page.publish(sim_us, rate=1e9, grant_us=1000)
            assert reader.now_us() >= max(last, sim_us)
            last = reader.now_us()


def test_clock_runs_at_its_rate_below_the_ceiling():
    with ClockPage() as page:
        reader = PageReader(page.path)
        page.publish(0, rate=1000.0, grant_us=10**12)
        before, first, after = time.monotonic_ns(), reader.now_us(), time.monotonic_ns()
        while time.monotonic_ns() < after + 1_000_000:
            pass
        then, last, end = time.monotonic_ns(), reader.now_us(), time.monotonic_ns()
        # 1000 x: 1 us of simulated time per ns; each reading lies between two of the wall clock.
        assert then - after - 2 <= last - first <= end - before + 2


def test_pause_stops_the_clock():
    with ClockPage() as page:
        page.publish(10_000, rate=50.0, grant_us=10**9)
        page.publish(10_000, rate=0.0, grant_us=10**9)
        assert page.now_us() == page.now_us()


def test_release_lets_the_clock_go_on_at_real_time():
    with ClockPage() as page:
        page.publish(7000, rate=50.0)
        page.release()
        _, _, sim_ns, rate, ceiling_ns, state = PageReader(page.path).line()
        assert (sim_ns, rate, ceiling_ns, state) == (7_000_000, 1.0, FOREVER_NS, RELEASED)


def test_file_is_gone_after_close():
    page = ClockPage()
    page.close()
    page.close()
    assert not os.path.exists(page.path)


@pytest.mark.parametrize(("rate", "grant_us"), [(-1.0, 0), (1.0, -1)])
def test_publish_refuses_negative_numbers(rate, grant_us):
    with ClockPage() as page, pytest.raises(ValueError, match="must be 0 or more"):
        page.publish(0, rate, grant_us)


def test_reader_refuses_another_file(tmp_path):
    other = tmp_path / "other"
    other.write_bytes(bytes(4096))
    with pytest.raises(ValueError, match="not 0x"):
        PageReader(str(other))
