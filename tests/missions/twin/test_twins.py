# SPDX-License-Identifier: BSD-3-Clause
"""Twins of a log whose truth is known: they lie on it; another airframe, mass or fault does not."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from sitl import vehicles
from sitl.cli import main
from sitl.errors import OptionError
from sitl.missions.testing import assert_twin
from sitl.missions.twin import limits, report, twin
from sitl.missions.twin.flight_log import FlightLog
from sitl.missions.twin.log_flight import Change
from sitl.missions.twin.twin import Twin
from sitl.simulation import Core
from tests.missions.twin.conftest import FRAME, SEED, cut


def test_the_twin_of_our_own_flight_lies_on_it(own_twin: Twin) -> None:
    metrics = own_twin.metrics()
    assert metrics["height.rms"] < 0.1 and metrics["position.rms"] < 0.2 and metrics["yaw.rms"] < 2.5
    for name in ("climb", "speed", "roll", "pitch", "pitch_rate", "throttle", "motors"):
        assert metrics[f"{name}.vaf"] > 95.0, name
    assert own_twin.findings == [] and own_twin.went == []


def test_open_segments_begin_in_the_logged_state(own_twin: Twin) -> None:
    metrics = own_twin.metrics()
    assert len(own_twin.begins) >= 5
    for name in ("height", "position", "roll", "pitch", "yaw"):
        assert metrics[f"segments.{name}.vaf"] > 95.0, name
    assert metrics["segments.yaw_rate.vaf"] > 90.0 and metrics["segments.height.rms"] < 0.05
    for name in ("acceleration", "thrust"):
        assert abs(metrics[f"model.{name}.bias"]) < 0.05  # the log's motor outputs hold the same vehicle


def test_a_segment_begins_in_the_logged_state_wherever_the_twin_is(own_log: Path, core: Core, tmp_path: Path) -> None:
    found = twin.fly(own_log, FRAME, seed=SEED, wind=(8.0, 90.0), core=core, keep=tmp_path)  # the log has no wind
    assert found.metrics()["pitch.rms"] > 1.5
    logged, flown = (log.table("ATT") for log in (found.log, FlightLog(tmp_path / "segments.bin")))
    begins = np.array(found.begins) + found.log.span.armed
    shifts = np.array([window.shift for window in found.opened])
    assert np.abs(shifts).max() > 0.05, "the wind makes it late on its mission"
    for name in ("Roll", "Pitch"):
        then = np.interp(begins + 0.02, logged.time, logged[name])
        now = np.interp(begins + shifts + 0.02, flown.time, flown[name])  # in step with the mission
        assert np.abs(now - then).max() < 1.2, name


def test_another_seed_errs_as_receivers_do(own_log: Path, core: Core) -> None:
    metrics = twin.fly(own_log, FRAME, seed=SEED + 1, segments=False, core=core).metrics()
    assert metrics["height.rms"] < 0.5 and 0.01 < metrics["position.rms"] < 1.0 and metrics["pitch.vaf"] > 90.0


def test_a_twin_that_does_not_leave_the_ground_has_open_segments(own_log: Path, core: Core) -> None:
    heavy = twin.with_mass(vehicles.load(FRAME), "12")
    found = twin.fly(own_log, heavy, core=core)
    assert found.findings[0].startswith("the twin never left the ground")
    assert any("more down than the vehicle did" in text for text in found.findings)
    assert found.metrics()["model.thrust.bias"] < -5.0 and not any("throttle" in text for text in found.findings)


def test_another_airframe_is_a_misfit(own_log: Path, core: Core) -> None:
    found = twin.fly(own_log, "erle_copter", core=core)
    metrics = found.metrics()
    assert metrics["throttle.bias"] < -1.0 and metrics["model.acceleration.bias"] > 0.3
    assert any(text.startswith("model: mean throttle output") for text in found.findings)
    assert any("more up than the vehicle did" in text for text in found.findings)
    assert "The twin flies otherwise than the log's vehicle did" in report.verdict_of(found)
    assert 'class="unsure"' in report.html(found, [])


def test_what_if(own_log: Path, own_twin: Twin, core: Core) -> None:
    change = Change({"WPNAV_SPEED": 150.0}, (6.0, 270.0), (), "+0.5")
    found = twin.fly(own_log, FRAME, seed=SEED, change=change, segments=False, core=core)
    assert found.metrics()["height.rms"] == own_twin.metrics()["height.rms"]  # the twin stays what it was
    metrics = found.metrics()
    assert metrics["changed.throttle.bias"] > 3.0 and metrics["changed.position.max"] > 1.0
    told = {what: (before, after) for what, _, before, after in report.effects(found)}
    assert told["mean throttle output"][1] > told["mean throttle output"][0] + 3.0
    assert 1.4 < told["greatest speed"][1] < 1.6 < told["greatest speed"][0], "it flies at WPNAV_SPEED"
    assert "What the change does" in report.html(found, [])
    assert found.change.words == ["WPNAV_SPEED = 150", "wind of 6 m/s from 270 deg", "mass +0.5 kg"]


def test_what_if_a_motor_fails_in_flight(own_log: Path, core: Core) -> None:
    change = Change(faults=("motor:1=0@12",))  # 12 s after arming
    found = twin.fly(own_log, FRAME, seed=SEED, change=change, segments=False, core=core)
    metrics = found.metrics()
    assert metrics["changed.roll.max"] > 30.0 and metrics["height.rms"] < 0.05
    one = next(one for one in found.difference if one.quantity.name == "roll")
    before = one.time < 11.9
    assert abs(one.flown - one.logged)[before].max() < 0.2


def test_a_log_that_ends_in_the_air_is_compared_up_to_there(own_log: Path, tmp_path: Path, core: Core) -> None:
    found = twin.fly(cut(own_log, tmp_path / "half.bin", 0.6), FRAME, seed=SEED, segments=False, core=core)
    assert any("while armed: it is compared up to there" in note for note in found.notes)
    assert found.metrics()["height.rms"] < 0.05


def test_the_report_is_one_file_with_all_that_matters(own_twin: Twin, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    report.write(own_twin, limits.judge(own_twin.metrics(), {"height.rms": 1e-6}), page)
    text = page.read_text()
    assert "0 of 1 limits are kept" in text and "height.rms is" in text and text.count("data:image/png") == 3
    verdict = "The twin flies as the log&#x27;s vehicle did, as far as these metrics tell"
    assert 0 < text.index(verdict) < text.index("What was taken over"), "the verdict is first"
    assert "http" not in text and "<script" not in text and 'src="data:' in text


def test_the_command_says_by_its_exit_code_whether_limits_are_kept(
    own_log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["twin", str(own_log), "--frame", FRAME, "--seed", str(SEED), "--no-segments"]
    assert main([*words, "--limit", "height=0.1", "--limit", "roll.vaf=90"]) == 0
    assert "ok: roll.vaf is" in capsys.readouterr().out
    assert main([*words, "--limit", "height=1e-6", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert not found["ok"] and found["metrics"]["height.rms"] < 0.1 and found["beyond_limits"]


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--set", "FOO=1"], "no parameters FOO"),
        (["--set", "WPNAV_SPEED"], "is not NAME=VALUE"),
        (["--mass", "heavy"], "mass 'heavy': a mass .kg. is needed"),
        (["--wind", "99"], "is not SPEED"),
        (["--limit", "height"], "is not NAME=VALUE"),
        (["--flight", "4"], "has flights 1 to 1"),
        (["--fail", "link@3"], "has no links"),
        (["--report", "page.pdf"], "does not end in .html"),
    ],
)
def test_mistakes(own_log: Path, capsys: pytest.CaptureFixture[str], words: list[str], text: str) -> None:
    try:
        code = main(["twin", str(own_log), "--frame", FRAME, *words])
    except SystemExit as left:
        code = left.code  # type: ignore[assignment]
    error = capsys.readouterr().err
    assert code == 2 and error.count("\n") == 1
    assert re.search(text, error), error


def test_assert_twin(own_log: Path) -> None:
    assert_twin(own_log, {"height": 0.1, "pitch.vaf": 90.0}, frame=FRAME, seed=SEED, segments=False)
    with pytest.raises(AssertionError, match=r"does not fly like the log:\n  height.max is"):
        assert_twin(own_log, {"height.max": 1e-6}, frame=FRAME, seed=SEED, segments=False)
    with pytest.raises(OptionError, match="without limits tests nothing"):
        assert_twin(own_log, {}, frame=FRAME)
