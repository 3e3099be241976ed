# SPDX-License-Identifier: BSD-3-Clause
"""A program whose clock is held: its time is what it is given, and its threads and datagrams keep to the steps."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys

import pytest

from sitl.warp import CannotBuild, build
from sitl.warp.held_clock import HeldClock, ProgramGone
from tests.platforms import on_linux

PROGRAM = r"""
#include <arpa/inet.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>

static int in, out, heard;
static double heard_at;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static int udp(int port, int listens) {
  struct sockaddr_in a = {.sin_family = AF_INET, .sin_port = htons(port), .sin_addr.s_addr = htonl(INADDR_ANY)};
  int fd = socket(AF_INET, SOCK_DGRAM, 0);
  if (listens && bind(fd, (struct sockaddr *)&a, sizeof a)) perror("bind");
  return fd;
}

static void *listen_for_numbers(void *unused) {
  for (;;) {
    fd_set set;
    struct timeval wait = {0, 100000};
    int number;
    FD_ZERO(&set);
    FD_SET(in, &set);
    if (select(in + 1, &set, NULL, NULL, &wait) != 1) continue;
    if (recvfrom(in, &number, sizeof number, 0, NULL, NULL) == sizeof number) {
      heard = number;
      heard_at = now();
    }
  }
  return unused;
}

int main(void) {
  in = udp(7003, 1);
  out = udp(7002, 0);
  pthread_t thread;
  pthread_create(&thread, NULL, listen_for_numbers, NULL);
  struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(7002), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  struct timespec nap = {0, 1000000};
  for (int before = 0;;) {
    nanosleep(&nap, NULL);
    if (heard == before) continue;
    before = heard;
    double said[3] = {heard, heard_at, now()};
    sendto(out, said, sizeof said, 0, (struct sockaddr *)&to, sizeof to);
  }
}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """A program with a thread that waits for datagrams, and a main loop of 1 ms."""
    if sys.platform != "linux":
        pytest.skip("the clock of a program is held on Linux alone")
    try:
        words = build.compiler()
    except CannotBuild as error:
        pytest.skip(str(error))
    folder = tmp_path_factory.mktemp("held")
    (folder / "program.c").write_text(PROGRAM)
    subprocess.run([*words, "-o", folder / "program", folder / "program.c", "-pthread"], check=True)
    return folder / "program"


@contextlib.contextmanager
def held(program):
    clock = HeldClock()
    process = subprocess.Popen(
        [program], env={**os.environ, **clock.environment}, pass_fds=clock.descriptors, start_new_session=True
    )
    clock.started()
    try:
        assert clock.answer(20.0) == []
        yield clock, process
    finally:
        clock.close()
        assert process.wait(20.0) == 0


def told(clock, until_us, *numbers):
    """(number, when the thread heard it, when the main loop said it) of one step."""
    clock.grant(until_us, [(7003, n.to_bytes(4, "little")) for n in numbers])
    return [tuple(memoryview(data).cast("d")) for port, data in clock.answer(20.0) if port == 7002]


def test_its_time_is_what_it_is_given(program):
    with held(program) as (clock, _):
        assert told(clock, 10_000) == []
        [(number, heard, said)] = told(clock, 20_000, 7)
        assert number == 7
        assert heard == pytest.approx(1.010, abs=1e-9)  # the end of the step before, to threads
        assert 1.010 < said < 1.0115
        assert told(clock, 30_000) == []


def test_the_same_steps_make_it_do_the_same_and_two_share_no_port(program):
    flights = []
    with held(program) as (one, _), held(program) as (other, _):
        for clock in (one, other):
            flights.append([told(clock, 2500 * k, k) for k in range(1, 200)])
    assert flights[0] == flights[1] and sum(map(len, flights[0])) > 190


def test_time_stands_until_it_is_given(program):
    with held(program) as (clock, process):
        assert clock.answer(0.05) is None
        assert process.poll() is None


def test_a_program_that_is_killed_is_gone(program):
    clock = HeldClock()
    process = subprocess.Popen([program], env={**os.environ, **clock.environment}, pass_fds=clock.descriptors)
    clock.started()
    assert clock.answer(20.0) == []
    process.kill()
    process.wait()
    with pytest.raises(ProgramGone, match="closed its end"):
        clock.answer(20.0)
    with pytest.raises(ProgramGone):
        clock.grant(1000)
    clock.close()


def test_other_systems_are_told_what_is_missing(monkeypatch):
    monkeypatch.setattr(build, "lockstep_library", build.lockstep_library.__wrapped__)
    monkeypatch.setattr(build.sys, "platform", "darwin")
    with pytest.raises(CannotBuild, match="held on Linux alone, and this is darwin"):
        build.lockstep_library()


@on_linux
def test_no_compiler_says_what_to_install(monkeypatch, tmp_path):
    monkeypatch.setenv("SITL_CACHE_DIR", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(build, "lockstep_library", build.lockstep_library.__wrapped__)
    monkeypatch.setattr(build.shutil, "which", lambda _name: None)
    monkeypatch.setattr(build.importlib.util, "find_spec", lambda _name: None)
    with pytest.raises(CannotBuild, match=r"a program whose clock is held needs a C compiler.*apt install gcc"):
        build.lockstep_library()
