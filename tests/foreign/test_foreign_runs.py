# SPDX-License-Identifier: BSD-3-Clause
"""``sitl run --autopilot``, ``sitl physics --listen json`` and the recorded scripts, with stand-in programs."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys

import pytest

from benchmarks.recorded import __main__ as compare
from sitl.bridge.dialect import message
from sitl.errors import LinkLostError, OptionError
from sitl.foreign.choice import choose
from sitl.foreign.process import AutopilotEndedError
from sitl.foreign.px4_session import Px4Session
from sitl.foreign.session import ArduPilotSession
from sitl.logs.tlog import read_tlog
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import GoldenStore
from sitl.missions.testing.setup import Defaults, Setup
from sitl.missions.testing.vehicle import Copter
from sitl.simulation import Simulation
from tests.foreign.arducopter_stand_in import install
from tests.platforms import on_linux

_TEXT, _POSITION = message("STATUSTEXT"), message("HEARTBEAT")


@contextlib.contextmanager
def command(*words, cwd):
    process = subprocess.Popen(
        [sys.executable, "-m", "sitl", *map(str, words)], cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )  # fmt: skip
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        for stream in (process.stdout, process.stderr):
            stream.close()


def line_with(stream, text):
    for line in stream:
        if text in line:
            return line.strip()
    raise AssertionError(f"no line with {text!r}")


@pytest.mark.slow
def test_a_program_is_run_relayed_and_logged_until_the_duration_is_over(arducopter, tmp_path):
    words = ("--speedup", "max", "--out", "none", "--tcp", "0", "--log-dir", tmp_path / "logs", "--duration", "30")
    with command("run", "copter", "--autopilot", f"ardupilot:{arducopter}", *words, cwd=tmp_path) as process:
        out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert "flies erle_copter; physics: native" in out and "MAVLink on tcp:127.0.0.1:" in out
    (log,) = (tmp_path / "logs").iterdir()
    texts = b"".join(raw for _, raw in read_tlog(log) if raw[7] == 253)
    assert b"ArduPilot Ready" in texts


@pytest.mark.slow
def test_a_program_that_dies_ends_the_run_with_its_last_words(tmp_path):
    program = tmp_path / "arducopter"
    program.write_text("#!/bin/sh\necho cannot find my eeprom\nexit 7\n")
    program.chmod(0o755)
    words = ("--out", "none", "--tcp", "0", "--log-dir", tmp_path / "logs")
    with command("run", "copter", "--autopilot", f"ardupilot:{program}", *words, cwd=tmp_path) as process:
        _, err = process.communicate(timeout=60)
    assert process.returncode == 2
    assert "ended with code 7; it said: cannot find my eeprom" in err


@pytest.mark.slow
def test_ctrl_c_ends_the_run_and_the_program(arducopter, tmp_path):
    words = ("--speedup", "max", "--out", "none", "--tcp", "0", "--log-dir", tmp_path / "logs")
    with command("run", "copter", "--autopilot", f"ardupilot:{arducopter}", *words, cwd=tmp_path) as process:
        line_with(process.stdout, "log:")
        line_with(process.stderr, "autopilot at")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
    assert process.returncode == 0


@on_linux
@pytest.mark.slow
def test_a_script_is_run_on_the_clock_of_a_program(arducopter, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    words = ("--speedup", "20", "--out", "none", "--tcp", "0", "--log-dir", tmp_path / "logs")
    run = ("--autopilot", f"ardupilot:{arducopter}", *words, "--", sys.executable, script, "{tcp}")
    with command("exec", "--vehicle", "copter", *run, cwd=tmp_path) as process:
        out, err = process.communicate(timeout=200)
    assert process.returncode == 3, err
    *slept, since, passed = map(float, line_with(iter(out.split("\n")), "slept").split()[1:])
    # A busy machine wakes a sleeper late: 10 ms of its time are 0.2 s of the script's. One of five is on time.
    assert 1.0 <= min(slept) < 1.1, slept
    assert passed == pytest.approx(since, rel=0.2)  # a wrong clock is wrong by a factor of 20


class AsFastAsItGoes:
    slice_us = 10_000

    def after_slice(self, session):
        pass


@pytest.fixture
def held(arducopter, copter_plant, tmp_path):
    """A session in slices."""
    choice, said = choose(f"ardupilot:{arducopter}", "copter"), []
    session = ArduPilotSession(choice, copter_plant, is_relayed_by_slice=True, say=said.append, folder=tmp_path / "its")
    session.said = said
    yield session
    session.close()


@pytest.mark.slow
def test_a_program_that_is_killed_ends_its_slices(held):
    held.serve_slices(AsFastAsItGoes(), until_us=1_000_000)
    held.process._signal(signal.SIGKILL)
    with pytest.raises(AutopilotEndedError, match="ended by signal 9"):
        held.serve_slices(AsFastAsItGoes())


@pytest.mark.slow
def test_a_program_that_asks_for_nothing_any_more_ends_its_slices(held, monkeypatch):
    held.serve_slices(AsFastAsItGoes(), until_us=1_000_000)
    held.process._signal(signal.SIGSTOP)
    monkeypatch.setattr("sitl.foreign.slices.LOST_S", 0.5)
    monkeypatch.setattr("sitl.plants.physics_server.PATIENCE_S", 0.2)
    with pytest.raises(LinkLostError, match=r"has not asked its physics in 0.5 s; it said: .*Ready"):
        held.serve_slices(AsFastAsItGoes())
    assert held.said[-1].startswith("the autopilot is silent: time stands at 1.")


SCRIPT = """
import sys, time
from pymavlink import mavutil

link = mavutil.mavlink_connection(f"tcp:127.0.0.1:{sys.argv[1]}")
link.wait_heartbeat()
link.mav.command_long_send(1, 1, 511, 0, 30, 20000, 0, 0, 0, 0, 0)
first, began = link.recv_match(type="ATTITUDE", blocking=True), time.monotonic()
slept = []
for _ in range(5):
    before = time.monotonic()
    time.sleep(1.0)
    slept.append(time.monotonic() - before)
while link.recv_match(type="ATTITUDE", blocking=False):
    pass
last = link.recv_match(type="ATTITUDE", blocking=True)
print("slept", *slept, time.monotonic() - began, (last.time_boot_ms - first.time_boot_ms) * 1e-3)
raise SystemExit(3)
"""


@pytest.mark.parametrize("words", [("--rec", "a.rec"), ("--lockstep",)])
def test_what_only_our_own_autopilot_has_is_refused(tmp_path, capsys, words):
    from sitl.cli import main

    assert main(["run", "copter", "--autopilot", f"ardupilot:{install(tmp_path)}", *words]) == 2
    assert words[0] in capsys.readouterr().err


@on_linux
def test_a_program_that_runs_already_cannot_be_held_by_a_script(capsys):
    from sitl.cli import main

    assert main(["exec", "--autopilot", "ardupilot:tcp:127.0.0.1:5760", "--", "true"]) == 2
    assert "use ardupilot:PROGRAM" in capsys.readouterr().err


@pytest.mark.slow
def test_a_test_of_pytest_is_flown_by_a_program(arducopter, tmp_path):
    factory = VehicleFactory(Defaults(autopilot=f"ardupilot:{arducopter}"), GoldenStore(tmp_path), tmp_path / "logs")
    try:
        copter = factory("copter", wind=(5.0, 0.0))
        assert isinstance(copter, Copter) and copter.kind == "copter"
        copter.takeoff(5.0)
        assert copter.height == pytest.approx(5.0, abs=0.5)
        assert copter.connection.plant.vehicle.v.physics.wind.vel[0] < -2.0
        with pytest.raises(OptionError, match="cannot be repeated"):
            copter.save_recording(tmp_path / "flight.rec")
        (_, lines), *_ = factory.keep_logs(None)
        assert lines[-1].startswith("no logs: autopilot")
        copter.connection.process._signal(9)
        with pytest.raises(LinkLostError, match="ended by signal 9"):
            copter.delay(1.0)
    finally:
        factory.close()


@pytest.mark.slow
def test_px4_is_run(px4, tmp_path):
    words = ("--speedup", "max", "--log-dir", tmp_path / "logs", "--duration", "5", "--instance", "7")
    with command("run", "copter", "--autopilot", f"px4:{px4}", *words, cwd=tmp_path) as process:
        out, err = process.communicate(timeout=60)
    assert process.returncode == 0, err
    assert "udpout:127.0.0.1:14547" in out and "tcp:127.0.0.1:5830" in out
    assert list((tmp_path / "logs").glob("px4-*.tlog"))
    assert "every tick waits for the autopilot" in err


def test_a_program_that_ends_because_the_run_is_over_is_no_error(tmp_path, copter_plant):
    """It loses its connection before the session looks at it for the last time."""
    program, looks = tmp_path / "px4", []
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    session = Px4Session(choose(f"px4:{program}", "copter"), copter_plant, instance=9)
    try:
        session.process.ended(10.0)
        session.server.serve = lambda goes_on: looks.append(goes_on())
        session.serve(lambda: False, lambda: None)
        assert looks == [False]
        with pytest.raises(AutopilotEndedError, match="ended with code 0"):
            session.serve(lambda: True, lambda: None)
    finally:
        session.close()


@on_linux
@pytest.mark.slow
def test_a_script_is_run_on_the_clock_of_px4_and_a_parameter_that_it_has_not_is_named(px4, tmp_path):
    script, params = tmp_path / "script.py", tmp_path / "my.params"
    script.write_text(SCRIPT)
    params.write_text("MC_ROLRATE_P 0.2\nMPC_XY_CRUISE 3\nSIM_WIND_SPD 2\nSIM_BAT_DRAIN 60\n")
    words = ("--speedup", "20", "--out", "none", "--tcp", "0", "--instance", "6", "--params", params)
    run = ("--autopilot", f"px4:{px4}", *words, "--log-dir", tmp_path / "logs", "--", sys.executable, script, "{tcp}")
    with command("exec", "--vehicle", "copter", *run, cwd=tmp_path) as process:
        out, err = process.communicate(timeout=200)
    assert process.returncode == 3, err
    *slept, since, passed = map(float, line_with(iter(out.split("\n")), "slept").split()[1:])
    assert 1.0 <= min(slept) < 1.1, slept
    assert passed == pytest.approx(since, rel=0.2)
    assert err.count("has no parameter") == 1 and "has no parameter MC_ROLRATE_P; it is left out" in err


@pytest.fixture
def held_px4(px4, copter_plant, tmp_path):
    """A session in slices."""
    choice, said = choose(f"px4:{px4}", "copter"), []
    session = Px4Session(choice, copter_plant, instance=5, is_relayed_by_slice=True, say=said.append)
    session.said = said
    yield session
    session.close()


@pytest.mark.slow
def test_a_px4_that_is_killed_or_silent_ends_its_slices(held_px4, monkeypatch):
    held_px4.serve_slices(AsFastAsItGoes(), until_us=2_000_000)
    held_px4.process._signal(signal.SIGSTOP)
    monkeypatch.setattr("sitl.foreign.slices.LOST_S", 0.5)
    monkeypatch.setattr("sitl.plants.physics_server.PATIENCE_S", 0.2)
    with pytest.raises(LinkLostError, match=r"px4:.* has not asked its physics in 0.5 s; it said: "):
        held_px4.serve_slices(AsFastAsItGoes())
    assert any(text.startswith("the autopilot is silent: time stands at ") for text in held_px4.said)
    held_px4.process._signal(signal.SIGCONT)
    held_px4.serve_slices(AsFastAsItGoes(), until_us=held_px4.time_us + 500_000)  # it goes on
    held_px4.process._signal(signal.SIGKILL)
    with pytest.raises(AutopilotEndedError, match="ended by signal 9"):
        held_px4.serve_slices(AsFastAsItGoes())


@pytest.mark.slow
def test_a_px4_whose_estimator_skips_ticks_does_not_stop_time(px4, tmp_path):
    (tmp_path / "slow.params").write_text("IMU_INTEG_RATE 200\n")
    words = ("--speedup", "max", "--duration", "3", "--instance", "8", "--params", tmp_path / "slow.params")
    with command("run", "copter", "--autopilot", f"px4:{px4}", *words, cwd=tmp_path) as process:
        _, err = process.communicate(timeout=60)
    assert process.returncode == 0, err
    assert err.count("has not answered the tick") == 1


@pytest.mark.slow
def test_the_physics_command_listens_for_json(tmp_path):
    with command("physics", "copter", "--listen", "json:0", cwd=tmp_path) as process:
        where = line_with(process.stdout, "JSON on udp").rpartition(" ")[2]
        simulation = Simulation("erle_copter", physics=f"json:{where}")
        simulation.advance(2.0)
        simulation.close()
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
    assert process.returncode == 0


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--estimator", "truth"), "its own estimators"),
        (("--lockstep",), "control its time"),
        (("--physics", "json:127.0.0.1:9002"), "native, pybullet"),
    ],
)
def test_options_that_a_foreign_autopilot_cannot_have_are_refused(tmp_path, capsys, words, why):
    from sitl.cli import main

    program = install(tmp_path)
    assert main(["run", "copter", "--autopilot", f"ardupilot:{program}", *words]) == 2
    assert why in capsys.readouterr().err


@pytest.mark.slow
def test_the_rovers_drive_is_repeated_by_a_program(ardurover):
    metrics = {metric.name: metric for metric in compare.metrics("rover", autopilot=f"ardupilot:{ardurover}")}
    compared = [f for name, f in metrics.items() if f.theirs and "reached" in name]
    assert compared
    for metric in compared:
        assert abs(metric.percent) < 20.0, metric


@pytest.mark.slow
def test_the_copters_mission_is_repeated_by_a_program(arducopter):
    metrics = compare.metrics("copter", autopilot=f"ardupilot:{arducopter}")
    compared = [f for f in metrics if f.theirs and f.name.startswith("AUTO") and "reached" in f.name]
    assert compared
    for metric in compared:
        assert abs(metric.percent) < 20.0, metric


def test_an_estimator_of_ours_is_refused_where_another_autopilot_flies(tmp_path):
    other = f"ardupilot:{install(tmp_path)}"
    with pytest.raises(OptionError, match=r"^estimator 'truth': autopilot ardupilot:.* has estimators of its own"):
        Setup("erle_copter", estimator="truth", autopilot=other).build()
    with pytest.raises(OptionError, match=r"^estimator 'truth'"):
        compare.metrics("copter", estimator="truth", autopilot=other)


def test_px4_does_not_speak_the_scripts_commands(px4):
    with pytest.raises(OptionError, match="for ArduPilot"):
        compare.metrics("copter", autopilot=f"px4:{px4}")
