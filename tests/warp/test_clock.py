# SPDX-License-Identifier: BSD-3-Clause
"""Plain Python programs on a warped clock: every way to wait takes the simulated time it should.

Waits may end late on a busy machine, never early; so lower bounds are tight and hold at every try, upper
bounds are wide and may be missed many times.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from sitl.warp import ClockPage, script_environment, start_script
from tests.warp.drive import need_library, patiently, run, run_python

SPEEDUP = 20.0
LATE_S = 1.0  # 50 ms of wall time at this speed-up

WAITS = {
    "time.sleep": "time.sleep(2)",
    "Event.wait": "threading.Event().wait(2)",
    "Lock.acquire": "l = threading.Lock(); l.acquire(); l.acquire(timeout=2)",
    "Condition.wait": "c = threading.Condition(); c.acquire(); c.wait(2)",
    "Queue.get": "swallow(queue.Empty, queue.Queue().get, timeout=2)",
    "Thread.join": "t = threading.Thread(target=time.sleep, args=(60,), daemon=True); t.start(); t.join(2)",
    "select": "select.select([], [], [], 2)",
    "poll": "p = select.poll(); p.register(udp, 1); p.poll(2000)",
    "epoll": "p = select.epoll(); p.register(udp, 1); p.poll(2)",
    "socket.settimeout": "udp.settimeout(2); swallow(TimeoutError, udp.recv, 1)",
    "SO_RCVTIMEO": "udp.setblocking(True); udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, "
    "struct.pack('ll', 2, 0)); swallow(BlockingIOError, udp.recv, 1)",
    "asyncio.sleep": "asyncio.run(asyncio.sleep(2))",
    "asyncio.wait_for": "swallow(TimeoutError, asyncio.run, wait_for())",
    "child process": "subprocess.run(['sleep', '2'])",
    "signal.alarm": "signal.signal(signal.SIGALRM, lambda *_: None); signal.alarm(2); signal.pause()",
    "signal.setitimer": "signal.signal(signal.SIGALRM, lambda *_: None); signal.setitimer(signal.ITIMER_REAL, 2); "
    "time.sleep(1); left = signal.getitimer(signal.ITIMER_REAL)[0]; assert 0.01 < left < 1.01, left; signal.pause()",
    "setitimer with an interval": "signal.signal(signal.SIGALRM, lambda *_: None); "
    "signal.setitimer(signal.ITIMER_REAL, 0.8, 0.6); [signal.pause() for _ in range(3)]; "
    "signal.alarm(0)",
    "alarm that is put off": "signal.signal(signal.SIGALRM, lambda *_: None); signal.alarm(1); signal.alarm(2); "
    "signal.pause()",
    "timer_create": "subprocess.run(['timeout', '2', 'sleep', '60'])",
    "signal.sigtimedwait": "signal.sigtimedwait([signal.SIGUSR1], 2)",
}

# The kernel keeps these in wall time, so they end early where the simulation falls behind on a busy machine.
KEPT_BY_KERNEL = {"SO_RCVTIMEO"}

PROGRAM = """
import asyncio, json, queue, select, signal, socket, struct, subprocess, threading, time
udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM); udp.bind(("127.0.0.1", 0))
def swallow(error, f, *args, **options):
    try: f(*args, **options)
    except error: pass
async def wait_for():
    await asyncio.wait_for(asyncio.Event().wait(), 2)
monotonic, date, cpu = time.monotonic(), time.time(), time.process_time()
WAIT
print(json.dumps([time.monotonic() - monotonic, time.time() - date, time.process_time() - cpu]))
"""


@pytest.mark.parametrize("name", WAITS)
def test_wait_lasts_as_long_in_simulated_time(name):
    shortest = 2.0

    def check() -> None:
        nonlocal shortest
        monotonic, date, cpu = run_python(PROGRAM.replace("WAIT", WAITS[name]), SPEEDUP)
        if name not in KEPT_BY_KERNEL:
            shortest = min(shortest, monotonic)
        assert 1.0 <= monotonic <= 2.0 + LATE_S
        assert abs(monotonic - date) < 0.1
        assert cpu < 1.0  # the processor-time clock is not warped

    patiently(check)
    assert shortest >= 1.99


def test_an_alarm_is_not_early_where_the_speed_changes():
    code = """
import json, signal, time
signal.signal(signal.SIGALRM, lambda *_: None)
start = time.monotonic()
signal.setitimer(signal.ITIMER_REAL, 3)  # while the script waits, time goes 200 times as fast as now
time.sleep(2)
while time.monotonic() - start < 2.05:
    pass
signal.pause()
print(json.dumps([time.monotonic() - start]))
"""

    def check() -> None:
        (lasted,) = run_python(code, "max")
        assert 2.99 <= lasted < 3.0 + LATE_S

    patiently(check)


def test_whole_run_agrees_with_the_simulator():
    def check() -> None:
        code = "import time; t = time.monotonic(); [time.sleep(0.1) for _ in range(100)]; print(time.monotonic() - t)"
        said, simulated = run([sys.executable, "-c", code], SPEEDUP)
        lasted = float(said)
        assert 10.0 <= lasted <= simulated
        assert lasted <= 13.0 and simulated <= 20.0  # with the start of Python and its end

    patiently(check)


def test_script_waits_with_a_paused_simulator_and_ends_when_it_is_released():
    need_library()
    code = "import time; t = time.monotonic(); time.sleep(0.2); print(time.monotonic() - t)"
    page = ClockPage()
    page.publish(1_000_000, rate=0.0)
    script = start_script([sys.executable, "-c", code], page, stdout=subprocess.PIPE, text=True)
    with pytest.raises(subprocess.TimeoutExpired):
        script.wait(0.5)
    page.close()
    assert 0.2 <= float(script.communicate(timeout=20)[0]) < 5.0


def test_clock_of_a_killed_simulator_runs_on():
    need_library()
    simulator = (
        "import sys, os, signal; from sitl.warp import ClockPage, start_script\n"
        "page = ClockPage(); page.publish(5_000_000, 50.0)\n"
        "start_script([sys.executable, '-c', 'import time; time.sleep(0.3); print(\"ended\")'], page)\n"
        "print(page.path, flush=True); os.kill(os.getpid(), signal.SIGKILL)"
    )
    done = subprocess.run([sys.executable, "-c", simulator], capture_output=True, text=True, timeout=60)
    assert done.stdout.splitlines()[-1] == "ended"


def test_a_killed_command_takes_its_script_along_and_its_page_goes_with_the_next():
    need_library()
    command = (
        "import sys, os, signal; from sitl.warp import ClockPage, start_script\n"
        "page = ClockPage(); page.publish(5_000_000, 50.0)\n"
        "forever = 'import time; print(1, flush=True); time.sleep(1e9); print(2)'\n"
        "start_script([sys.executable, '-u', '-c', forever], page, ends_with_us=True)\n"
        "print(page.path, flush=True); sys.stdin.readline(); os.kill(os.getpid(), signal.SIGKILL)"
    )
    running = subprocess.Popen(
        [sys.executable, "-c", command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert running.stdout is not None and running.stdin is not None
    lines = {running.stdout.readline().strip(), running.stdout.readline().strip()}
    (path,) = lines - {"1"}
    left, _ = running.communicate("go on\n", timeout=60)  # returns when the script has closed its output, too
    assert left == "" and Path(path).exists()
    with ClockPage() as page:
        assert not Path(path).exists() and Path(page.path).exists()


def test_time_is_never_seen_going_back_across_threads():
    code = """
import json, threading, time
back = []
def look():
    last = time.monotonic()
    for _ in range(20000):
        now = time.monotonic()
        if now < last: back.append(last - now)
        last = now
threads = [threading.Thread(target=look) for _ in range(4)]
[t.start() for t in threads]; [t.join() for t in threads]
print(json.dumps(back))
"""
    assert run_python(code, 50.0) == []


def test_other_preloaded_libraries_are_kept():
    need_library()
    with ClockPage() as page:
        assert script_environment(page, {"LD_PRELOAD": "libother.so"})["LD_PRELOAD"].endswith(":libother.so")


def test_without_a_page_the_library_changes_nothing():
    need_library()
    with ClockPage() as page:
        env = script_environment(page)
    env["SITL_WARP_PAGE"] = "/nonexistent"
    code = "import time, json; t = time.monotonic(); time.sleep(0.05); print(json.dumps(time.monotonic() - t))"
    done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60)
    assert 0.05 <= json.loads(done.stdout) < 5.0
