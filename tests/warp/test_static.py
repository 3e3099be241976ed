# SPDX-License-Identifier: BSD-3-Clause
"""Static programs, which ignore preloaded libraries, on the clock: a small one compiled here under the
expected name.
"""

import json
import subprocess
import sys

import pytest

from sitl.warp import CannotBuild, ClockPage, start_script
from sitl.warp.build import compiler, static_runtime
from tests.platforms import on_linux
from tests.warp.drive import patiently, run_python

SOURCE = r"""
#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <sys/select.h>
#include <time.h>
#include <unistd.h>

static double now(clockid_t id) {
  struct timespec t;
  clock_gettime(id, &t);
  return (double)t.tv_sec + (double)t.tv_nsec / 1e9;
}

int main(int argc, char **argv) {
  double start = now(CLOCK_MONOTONIC), date = now(CLOCK_REALTIME);
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, NULL); /* must not take the runtime's own signal away */
  sleep(1);
  poll(NULL, 0, 1000);
  struct timeval second = {1, 0};
  select(0, NULL, NULL, NULL, &second);
  pthread_mutex_t m = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t c = PTHREAD_COND_INITIALIZER;
  struct timespec at;
  clock_gettime(CLOCK_REALTIME, &at);
  at.tv_sec++;
  pthread_mutex_lock(&m);
  int result = 0;
  while (result == 0) result = pthread_cond_timedwait(&c, &m, &at);
  printf("{\"monotonic\": %f, \"date\": %f, \"timed_out\": %d, \"argc\": %d, \"name\": \"%s\"}\n",
         now(CLOCK_MONOTONIC) - start, now(CLOCK_REALTIME) - date, result == ETIMEDOUT, argc, argv[1]);
  return 3;
}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    folder = tmp_path_factory.mktemp("static")
    (folder / "program.c").write_text(SOURCE)
    target = folder / "mavsdk_server"
    try:
        static_runtime()
        words = [*compiler(), "-static", "-pthread", "-o", str(target), str(folder / "program.c")]
        subprocess.run(words, check=True, capture_output=True)
    except (CannotBuild, subprocess.CalledProcessError) as error:
        pytest.skip(f"no static programs here: {error}")
    return str(target)


def test_static_child_of_a_script_is_on_the_clock(program):
    code = (
        "import json, subprocess\n"
        f"done = subprocess.run([{program!r}, 'first'], capture_output=True, text=True)\n"
        "print(json.dumps([done.returncode, json.loads(done.stdout)]))"
    )

    def check() -> None:
        code_, said = run_python(code, 20.0)
        assert code_ == 3
        assert (said["argc"], said["name"], said["timed_out"]) == (2, "first", 1)
        assert 4.0 <= said["monotonic"] < 5.0
        assert 4.0 <= said["date"] < 5.0

    patiently(check)


@on_linux
def test_runtime_runs_other_programs_unchanged():
    with ClockPage() as page:
        page.publish(0, 1.0, 10**12)
        words = [
            str(static_runtime()),
            sys.executable,
            "python",
            "-c",
            "import json, sys; print(json.dumps(sys.argv))",
            "x",
        ]
        script = start_script(words, page, stdout=subprocess.PIPE, text=True)
        assert json.loads(script.communicate(timeout=60)[0]) == ["-c", "x"]
