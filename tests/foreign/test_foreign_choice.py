# SPDX-License-Identifier: BSD-3-Clause
"""What autopilot= and --autopilot mean."""

from __future__ import annotations

import pytest

from sitl.errors import OptionError
from sitl.foreign.choice import Choice, choose


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "arducopter"
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return path


def test_native_is_no_foreign_autopilot():
    assert choose("native", "copter") is None


def test_a_program_by_its_path(program):
    assert choose(f"ardupilot:{program}", "copter") == Choice("ardupilot", program)
    assert choose("ardupilot", "copter", program) == Choice("ardupilot", program)


def test_a_program_by_its_usual_name(program, monkeypatch):
    monkeypatch.setenv("PATH", str(program.parent))
    assert choose("ardupilot", "copter") == Choice("ardupilot", program)
    with pytest.raises(OptionError, match="ardurover"):
        choose("ardupilot", "rover")


def test_one_that_runs_already_by_its_connection():
    assert choose("ardupilot:tcp:10.0.0.1:5760", "rover") == Choice("ardupilot", None, "tcp:10.0.0.1:5760")
    assert choose("px4:udp:127.0.0.1:14540", "copter").connection == "udp:127.0.0.1:14540"


@pytest.mark.parametrize("text", ["", "betaflight", "native:/bin/true", "Ardupilot:", None, 7])
def test_other_texts_are_refused_with_the_forms(text):
    with pytest.raises(OptionError, match='"ardupilot:PROGRAM"'):
        choose(text, "copter")


def test_a_program_that_is_not_there_or_cannot_be_run_is_named(program):
    with pytest.raises(OptionError, match="nowhere' is not there"):
        choose("px4:/nowhere", "copter")
    program.chmod(0o644)
    with pytest.raises(OptionError, match="may be run"):
        choose(f"ardupilot:{program}", "copter")


def test_our_own_autopilot_takes_no_program(program):
    with pytest.raises(OptionError, match="native"):
        choose("native", "copter", program)
