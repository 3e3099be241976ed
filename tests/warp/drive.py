# SPDX-License-Identifier: BSD-3-Clause
"""Runs a program on a warped clock against a stand-in for the simulator; for the tests in this folder."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from sitl.warp import CannotBuild, ClockPage, Pacer, preload_library, start_script

TRIES = 25
SCRIPTS = Path(__file__).with_name("scripts")


def need_library() -> None:
    """Skip the test where the preload library cannot be made."""
    try:
        preload_library()
    except CannotBuild as error:
        pytest.skip(str(error))


def patiently(check: Callable[[], None]) -> None:
    """Run a check whose upper bounds are a few tens of milliseconds of wall time.

    On a machine shared with others a script may not get the processor for so long, again and again; one try within the
    bounds shows that the clock is right, and a wrong one is out of them each time.
    """
    for _ in range(TRIES - 1):
        try:
            return check()
        except AssertionError:
            continue
    return check()


def run(
    argv: list[str], speedup: float | str, vehicle: object = None, wall_limit_s: float = 300.0
) -> tuple[str, float]:
    """Run `argv` at `speedup` with `vehicle.advance_to(sim_us)` as the simulator; returns its output and
    sim seconds.

    Fails the test if the program does not end with code 0 within `wall_limit_s`.
    """
    need_library()
    with ClockPage() as page:
        pacer = Pacer(page, speedup)
        sim_us = 0
        script = start_script(argv, page, stdout=subprocess.PIPE, text=True)
        give_up = time.monotonic() + wall_limit_s
        while script.poll() is None and time.monotonic() < give_up:
            sim_us += pacer.slice_us
            if vehicle is not None:
                vehicle.advance_to(sim_us)
            pacer.pace(sim_us)
        script.kill()
        output = script.communicate()[0]
    assert script.returncode == 0, f"{argv} ended with {script.returncode} after {sim_us / 1e6} s simulated: {output}"
    return output, sim_us / 1e6


def run_python(code: str, speedup: float | str) -> object:
    """Run Python `code` at `speedup`; returns the JSON value it printed last."""
    output, _ = run([sys.executable, "-c", code], speedup)
    return json.loads(output.splitlines()[-1])
