# SPDX-License-Identifier: BSD-3-Clause
"""The clock page alone: no script, no preload library."""

import os
import time

import pytest

from sitl.warp.page import FOREVER_NS, RELEASED, WAITING, ClockPage, PageReader


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
