# SPDX-License-Identifier: BSD-3-Clause
"""``--fail``: faults of the vehicle and of its links, and what is said of them at the end."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest

from sitl import cli
from sitl.bridge.links import LinkFaults
from sitl.cli.fault_options import vehicle_faults
from sitl.cli.link_options import add_link_options, link_faults
from sitl.cli.options import add_vehicle_options
from sitl.errors import OptionError


def parsed(*words: str, links: bool = True) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    add_vehicle_options(parser)
    if links:
        add_link_options(parser)
    return parser.parse_args(words)


def test_links_fail_as_vehicles_do() -> None:
    options = parsed("--fail", "link@60..75", "--fail", "gps@12", "--link-cut", "1..2", "--fail", "link@90")
    assert vehicle_faults(options) == ["gps@12"]
    assert link_faults(options) == LinkFaults(cuts=((1.0, 2.0), (60.0, 75.0), (90.0, 1e9)))
    assert link_faults(parsed("--fail", "gps@12")) is None
    with pytest.raises(OptionError, match=r"--fail link=0\.3: links are cut, as in link@60\.\.75; --link-loss"):
        link_faults(parsed("--fail", "link=0.3"))
    with pytest.raises(OptionError, match="--fail link@3: this command has no links that can fail"):
        vehicle_faults(parsed("--fail", "link@3", links=False))


def test_a_run_says_what_became_of_its_faults(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    run = ["run", "copter", "--out", "none", "--tcp", "0", "--quiet", "--speedup", "max", "--duration", "4"]
    assert cli.main([*run, "--fail", "gps@1..3", "--fail", "motor:1=0.5", "--fail", "baro@99"]) == 0
    out, err = capsys.readouterr()
    assert "fault gps/off acted from 1.0 to 3.0 s\n" in out
    assert "sitl: fault motor:1/off=0.5 never acted: the vehicle was not armed\n" in err
    assert "sitl: fault baro/off never acted: it begins at 99.0 s, and the flight ended at 4.0 s\n" in err
    assert cli.main([*run, "--fail", "motor:6=0"]) == 2
    assert "there is no number 6; airframe erle_copter has 1, 2, 3, 4, and 0 for all" in capsys.readouterr().err
