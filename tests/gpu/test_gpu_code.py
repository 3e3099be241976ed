# SPDX-License-Identifier: BSD-3-Clause
"""Code for GPUs, as far as it can be tested without one.

What Numba makes of laws has the bits of the core, and NVIDIA's compilers take it.
"""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks import cuda_driver, gpu, gpu_code
from benchmarks.__main__ import begin, go_on
from sitl import vehicles
from sitl.errors import MissingExtra
from sitl.simulation import load_core
from sitl.vehicle.kinds import KINDS
from tests.gpu import gpu_units
from tests.gpu.fake_cuda import FakeDriver
from tests.gpu.gpu_units import RECORD, Turtlebot, fleet_of, roll, turn
from tests.gpu.on_cpu import OnCpu

ROOT = Path(__file__).parents[2]
needs_cuda = pytest.mark.skipif(
    importlib.util.find_spec("numba_cuda") is None, reason="numba-cuda is not installed: pip install 'gym-sitl[cuda]'"
)


def in_python(fleet, ticks, unit=roll):
    views = [Turtlebot.of(fleet, k) for k in range(len(fleet))]
    for index in range(len(fleet)):
        unit(views, index, ticks)
    return fleet


@needs_cuda
def test_a_unit_has_the_same_bits():
    fleet = fleet_of(3)
    OnCpu(*gpu_code.modules_of(roll, RECORD))(fleet, 20)
    assert fleet.tobytes() == in_python(fleet_of(3), 20).tobytes() != fleet_of(3).tobytes()


@needs_cuda
def test_elementary_functions_have_the_same_bits_and_are_nobody_elses():
    fleet = fleet_of(3)
    OnCpu(*gpu_code.modules_of(turn, RECORD))(fleet, 30)
    assert fleet.tobytes() == in_python(fleet_of(3), 30, turn).tobytes() != fleet_of(3).tobytes()
    text = gpu_code.ptx_of(turn, RECORD).text
    assert "fma.rn" not in text and not re.search(r"__nv_|\.approx", text)


@needs_cuda
@pytest.mark.parametrize("generation", [(8, 0), (9, 0)])
def test_nvidias_compilers_take_a_unit_and_fuse_nothing(generation):
    ptx = gpu_code.ptx_of(roll, RECORD, generation)
    assert f".target sm_{generation[0]}{generation[1]}\n" in ptx.text and f".entry {ptx.name}(" in ptx.text
    assert "mul.f64" in ptx.text.replace(".rn", "") and "fma.rn" not in ptx.text
    code = gpu_code.assemble(ptx)
    assert code.cubin.startswith(b"\x7fELF") and 0 < code.registers <= 255 and 50 < code.instructions < 5000


@needs_cuda
def test_a_kernel_runs_in_the_simulator():
    environment = {**os.environ, "NUMBA_ENABLE_CUDASIM": "1", "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", gpu_units.__name__]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.stdout == "the same\n", done.stderr


@needs_cuda
@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_whole_vehicle_has_the_bits_of_the_core(kind):
    core = load_core(KINDS[kind])
    here = begin(vehicles.names(kind)[0], core).simulation.fleet
    go_on(core, here)
    there = gpu.copy_of(here)
    core(here, 0, 800)
    OnCpu(*gpu_code.modules_of(KINDS[kind].advance, KINDS[kind].record_path))(there, 800)
    assert here["time_us"] == there["time_us"] and (here.view(np.uint8) == there.view(np.uint8)).all()


def test_what_is_missing_is_named(monkeypatch, capsys):
    def nothing(*names):
        raise OSError("libcuda.so.1: cannot open")

    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match=r"gym-sitl\[cuda\]"):
        gpu_code.ptx_of(roll, RECORD)
    monkeypatch.setattr(gpu_code.shutil, "which", lambda name: None)
    with pytest.raises(MissingExtra, match="ptxas"):
        gpu_code.assemble(gpu_code.Ptx("name", "", (9, 0)))
    monkeypatch.setattr(cuda_driver.ctypes, "CDLL", nothing)
    monkeypatch.setattr(sys, "argv", ["benchmarks.gpu"])
    with pytest.raises(SystemExit, match=r"no NVIDIA driver: libcuda.*--compile-only needs none"):
        gpu.main()


@pytest.mark.slow
def test_the_benchmark_checks_and_measures(monkeypatch, capsys, tmp_path):
    core, kind = load_core(KINDS["rover"]), KINDS["rover"]

    def kernel(fleet, ticks):
        for index in range(len(fleet)):
            core(fleet, index, ticks)

    driver = FakeDriver(kernel, kind.record.dtype)
    monkeypatch.setattr(cuda_driver.ctypes, "CDLL", lambda name: driver)
    monkeypatch.setattr(gpu, "SIZES", (65,))
    gpu.save(gpu_code.MachineCode("kernel", b"code", 255, 0, 9), tmp_path, "rover")
    monkeypatch.setattr(sys, "argv", ["benchmarks.gpu", "--vehicle", "rover", "--code", str(tmp_path)])
    gpu.main()
    out = capsys.readouterr().out
    assert "Fake GPU" in out and "differs by 0 m," in out and "64 of 64 records are the same bit for bit" in out
    assert "65 vehicles" in out and driver.launches[-1] == (3, 32) and not driver.memory
