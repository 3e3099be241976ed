# SPDX-License-Identifier: BSD-3-Clause
"""The benchmarks run and print what they measure; how fast is not asked here."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks import cameras, identification, log_readers
from benchmarks import envs as benchmark
from sitl import envs
from sitl.simulation import Core, load_core
from sitl.vehicle.kinds import KINDS

ROOT = Path(__file__).parents[1]


@pytest.mark.slow
def test_every_value_of_both_vehicles_is_printed(core: Core) -> None:
    load_core(KINDS["rover"])
    command = [sys.executable, "-m", "benchmarks", "--repeats", "1"]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    factors = [float(x) for x in re.findall(r"(\d+)x   \(", result.stdout)]
    assert len(factors) == 14 and all(f > 0 for f in factors), result.stdout
    assert len(re.findall(r"restore +[\d.]+ us", result.stdout)) == 2


def test_every_environment_has_a_row(monkeypatch, capsys):
    pytest.importorskip("pygame")
    monkeypatch.setattr(sys, "argv", ["benchmarks.envs", "--repeats", "1", "--steps", "2000"])
    monkeypatch.setattr(benchmark, "VECTORS", (16,))
    benchmark.main()
    out = capsys.readouterr().out
    for name in (benchmark.CARTPOLE, *envs.PAPER):
        row = re.search(rf"^{name} +([\d,]+) +([\d,]+)x +([\d.]+) ", out, re.MULTILINE)
        assert row, f"no row of {name} in\n{out}"
        assert float(row[2].replace(",", "")) > 0.0 and float(row[3]) > 0.0
    assert re.search(r", reset +[\d.]+ us", out)


def test_each_observation_by_camera_has_a_row(monkeypatch, capsys):
    monkeypatch.setattr(cameras, "ROBOTS", 2)
    cameras.main(["--repeats", "1", "--steps", "20"])
    rows = re.findall(r"^\| (.+) \| ([\d,]+) \| ([\d,]+) \|$", capsys.readouterr().out, re.M)
    assert [name for name, *_ in rows] == list(cameras.observations())
    assert all(int(rate.replace(",", "")) > 0 for _, *rates in rows for rate in rates)
    with pytest.raises(SystemExit):
        cameras.main(["--steps", "0"])


def test_another_checkout_is_measured_beside_this_one(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["benchmarks.envs", "--repeats", "1", "--steps", "1024", "--beside", str(ROOT),
                                      "--ids", "GazeboCircuitTurtlebotLIDAR-v0", "--vectors", "0", "16"])  # fmt: skip
    benchmark.main()
    rows = re.findall(r"^Gazebo\w+-v0, (\w+) +([\d.]+) +([\d.]+) +([\d.]+)$", capsys.readouterr().out, re.MULTILINE)
    assert [row[0] for row in rows] == ["single", "16"] and all(float(row[3]) > 0.0 for row in rows)


def test_intervals_of_identification_are_counted():
    nan = float("nan")
    results = [
        {"hover_output": row} for row in ((0.5, 0.51, 0.49, 0.53), (0.5, 0.52, 0.51, 0.53), (0.5, nan, nan, nan))
    ]
    assert list(identification.rows("quad", results)) == ["| hover_output | quad | 0.5 | 2 of 3 | 1 | 3.0 % | 3.0 % |"]
    turned = [{"wind_from": (1.0, 359.0, 355.0, 363.0)}]
    assert list(identification.rows("quad", turned)) == ["| wind_from | quad | 1 | 1 of 1 | 1 | 2 | 4 |"]
    assert identification.seeds("3..5") == (3, 4, 5) and identification.seeds("3,7") == (3, 7)
    heavy = identification.airframe_of("erle_copter, 10 mm tail-heavy")
    assert heavy.rotors[0].x == 0.141 + 0.01


@pytest.mark.slow
def test_readers_of_logs_are_compared_by_the_same_messages(capsys, tmp_path):
    path = tmp_path / "flight.bin"
    log_readers.fly(path, 0.1)
    named = ["ours", "pymavlink", "pymavlink, rows only", "ours: sitl identify"]
    assert log_readers.main(["--log", str(path), "--readers", *named]) == 0
    rows = re.findall(
        r"^\| (.+?) \(.+\) \| ([\d,]+)(?: properties)? \| ([\d.]+) \| (\d+) \|", capsys.readouterr().out, re.M
    )
    assert [row[0] for row in rows] == named
    counts = [int(row[1].replace(",", "")) for row in rows]
    assert counts[0] == counts[1] == counts[2] > 100_000 and counts[3] > 10
