# SPDX-License-Identifier: BSD-3-Clause
"""Either side goes, is cut off or falls silent: time stands, nothing hangs, nothing is lost or invented."""

from __future__ import annotations

import os
import random
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.recorded.pilot import Pilot
from sitl.bridge.frame import Splitter
from sitl.bridge.hil import controls, sensor
from sitl.bridge.hil.autopilot_end import TAKEN, AutopilotEnd
from sitl.bridge.hil.physics_end import HEARTBEAT
from sitl.bridge.hil.protocol import Sender
from sitl.cli import main
from sitl.client.endpoint import Endpoint
from sitl.core.mavlink import MavAutopilot
from sitl.core.records import first_difference
from sitl.errors import OptionError
from sitl.physics.engine import EngineError
from sitl.plants import hil
from sitl.plants.plant import PhysicsLostError
from sitl.run.standstill import Patience
from sitl.simulation import Simulation
from tests.bridge.hil.conftest import ROOT, CutWire, PhysicsProcess, WatchedPilot
from tests.bridge.hil.hil_bench import Vehicle


def go_on(simulation: Simulation, time_us: int, tries: int = 1000) -> int:
    """Advance as a run does: again and again while the physics is lost. Gives how often it was."""
    for lost in range(tries):
        try:
            simulation.advance_to(time_us)
        except PhysicsLostError:
            continue
        return lost
    raise AssertionError(f"the physics did not come back within {tries} tries")


class PatientPilot(WatchedPilot):
    """Goes on when the physics is lost."""

    lost = 0

    def step(self, stop_us: int | None = None) -> None:
        later = self.simulation.time_us + 40_000
        self.lost += go_on(self.simulation, later if stop_us is None else min(later, stop_us))
        self.connection.receive()


def start_run(physics: str, folder: Path) -> subprocess.Popen[str]:
    """``sitl run copter`` behind this physics, as soon as it flies."""
    options = ["--out", "none", "--tcp", "0", "--log-dir", str(folder), "--speedup", "max"]
    run = subprocess.Popen(
        [sys.executable, "-m", "sitl", "run", "copter", "--physics", physics, *options],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert run.stdout is not None
    while not run.stdout.readline().startswith("log:"):
        assert run.poll() is None
    return run


def hop(simulation: Simulation) -> PatientPilot:
    pilot = PatientPilot(simulation)
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=3.0)
    pilot.fly(5.0)
    return pilot


@pytest.mark.slow
def test_a_wire_cut_again_and_again_in_flight_changes_no_byte(beside) -> None:
    server = beside(seed=5)
    rng = random.Random(1)
    wire = CutWire(server.address, iter([rng.randrange(200_000) for _ in range(40)]))
    whole = hop(Simulation(seed=5))
    cut = hop(Simulation(physics=f"hil:tcp:127.0.0.1:{wire.port}"))
    cut.simulation.close()
    wire.close()
    assert wire.cuts > 20 and cut.lost > 20
    assert whole.received.frames == cut.received.frames
    assert server.end.ticks * 2500 == whole.simulation.time_us


@pytest.mark.slow
def test_physics_killed_in_flight_and_started_again(physics) -> None:
    process = physics("copter", "--seed", "1")
    pilot = hop(Simulation(physics=process.address))
    simulation = pilot.simulation
    before, height = simulation.time_us, float(simulation.v.autopilot.estimate.pos[2])
    assert height < -1.0
    process.kill()
    for _ in range(3):
        with pytest.raises(PhysicsLostError, match=r"127\.0\.0\.1"):
            simulation.advance(1.0)
    assert simulation.time_us == before
    again = PhysicsProcess("copter", "--seed", "1", port=process.port)
    try:
        assert go_on(simulation, before + 1_000_000) == 0
        assert simulation.time_us == before + 1_000_000 and simulation.before_boot_us == before
        assert simulation.v.time_us == 1_000_000 and not simulation.v.autopilot.arming.armed
        fresh = Simulation(seed=1)
        fresh.advance(1.0)
        expected = fresh.fleet[0]["sensors"].copy()
        for name in (
            "mag2",
            "mag3",
            "mag_us",
            "esc_count",
            "esc_time_us",
            "esc_motors",
            "esc_rpm",
        ):  # they do not cross the link
            expected[name] = 0
        assert first_difference(expected, simulation.fleet[0]["sensors"]) is None
        simulation.close()
        assert again.end()[0] == 0
    finally:
        again.kill()


def test_a_fresh_autopilot_joins_the_world_as_it_stands(beside) -> None:
    server = beside()
    first = Simulation(physics=f"hil:tcp:127.0.0.1:{server.address[1]}")
    first.advance(3.0)
    sensors = first.fleet[0]["sensors"].copy()
    first.close()
    second = Simulation(physics=f"hil:tcp:127.0.0.1:{server.address[1]}")
    assert second.time_us == 3_000_000
    assert list(second.v.sensors.acc) == sensors["acc"].tolist()
    assert second.v.sensors.abs_pressure == sensors["abs_pressure"]
    second.advance(0.5)
    second.close()
    assert server.end.ticks * 2500 == 3_500_000


@pytest.mark.slow
def test_an_autopilot_that_joins_in_mid_world_gets_ready_to_arm(beside) -> None:
    server = beside()
    address = f"hil:tcp:127.0.0.1:{server.address[1]}"
    first = Simulation(physics=address)
    first.advance(100.0)
    first.close()
    pilot = Pilot(Simulation(physics=address))
    pilot.boot()
    pilot.arm()
    assert pilot.simulation.v.autopilot.arming.armed
    pilot.simulation.close()


def test_a_reboot_begins_the_physics_anew_and_goes_on_as_in_process(beside) -> None:
    server = beside(seed=9)
    received = []
    for options in ({"seed": 9}, {"physics": f"hil:tcp:127.0.0.1:{server.address[1]}"}):
        simulation = Simulation(**options)  # type: ignore[arg-type]
        pilot = WatchedPilot(simulation)
        pilot.fly(2.0)
        simulation.request_reboot()
        pilot.fly(2.0)
        simulation.reseed(77)
        pilot.fly(2.0)
        received.append(pilot.received.frames)
        assert simulation.time_us == 6_000_000 and simulation.v.time_us == 4_000_000
        simulation.close()
    assert received[0] == received[1]


def test_a_reboot_while_the_physics_is_away_waits_for_it(beside) -> None:
    server = beside()
    wire = CutWire(server.address, iter([100_000]))
    simulation = Simulation(physics=f"hil:tcp:127.0.0.1:{wire.port}")
    with pytest.raises(PhysicsLostError):
        simulation.advance(10.0)
    simulation.request_reboot()
    simulation.plant.link.address = ("127.0.0.1", 1)  # type: ignore[attr-defined]
    before = simulation.time_us
    for _ in range(3):
        with pytest.raises(PhysicsLostError, match="no physics"):
            simulation.advance(1.0)
    assert simulation.time_us == before
    simulation.plant.link.address = ("127.0.0.1", wire.port)  # type: ignore[attr-defined]
    go_on(simulation, before + 500_000)
    assert (simulation.before_boot_us, int(simulation.v.time_us)) == (before, 500_000)
    simulation.close()
    wire.close()


def test_a_second_autopilot_is_refused_and_told(beside) -> None:
    server = beside()
    simulation = Simulation(physics=f"hil:tcp:127.0.0.1:{server.address[1]}")
    with socket.create_connection(server.address, 10.0) as second:
        answer = b""
        while not answer:
            simulation.advance(1.0)
            second.settimeout(0.05)
            try:
                answer = second.recv(4096)
            except TimeoutError:
                continue
        assert b"another autopilot" in Splitter().feed(answer)[0].payload
    simulation.advance(1.0)
    simulation.close()
    assert any("refused" in text for text in server.said)


def test_physics_that_listens_and_says_nothing(monkeypatch) -> None:
    monkeypatch.setattr(hil, "PATIENCE_S", 0.1)
    with socket.create_server(("127.0.0.1", 0)) as silent, pytest.raises(PhysicsLostError, match="does not answer"):
        Simulation(physics=f"hil:tcp:127.0.0.1:{silent.getsockname()[1]}")


def test_nobody_there(monkeypatch) -> None:
    monkeypatch.setattr(hil, "PATIENCE_S", 0.1)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    with pytest.raises(PhysicsLostError, match=f"no physics at .*{port}"):
        Simulation(physics=f"hil:tcp:127.0.0.1:{port}")


def test_a_rover_behind_the_physics_of_a_copter(beside, monkeypatch) -> None:
    monkeypatch.setattr(hil, "PATIENCE_S", 0.1)
    server = beside()
    with pytest.raises(PhysicsLostError, match="MAV_TYPE 10, this physics is of 2"):
        Simulation("erle_rover", physics=f"hil:tcp:127.0.0.1:{server.address[1]}")


@pytest.mark.parametrize(
    ("option", "value"), [("home", (1.0, 2.0, 3.0, 4.0)), ("seed", 0), ("world", "maze"), ("estimator", "truth")]
)
def test_options_of_the_other_side_are_refused(option: str, value: object) -> None:
    with pytest.raises(OptionError, match="other end"):
        Simulation(physics="hil:tcp:127.0.0.1:4560", **{option: value})  # type: ignore[arg-type]


@pytest.mark.parametrize("address", ["tcp:", "tcp:host", "udp:host:4560", "tcp:host:99999", "host:4560"])
def test_addresses_that_are_none(address: str) -> None:
    with pytest.raises(OptionError, match="allowed"):
        Simulation(physics=f"hil:{address}")


@pytest.mark.slow
def test_a_pilot_with_sticks_at_the_physics_side(beside) -> None:
    server = beside("erle_rover")
    simulation = Simulation("erle_rover", physics=f"hil:tcp:127.0.0.1:{server.address[1]}")
    pilot = Pilot(simulation)
    pilot.boot()
    pilot.choose_mode("MANUAL")
    pilot.arm()
    for _ in range(40):  # frames at 10 Hz
        server.end.move_sticks((1500, 1500, 1700, 1500, 1800, 1000, 1000, 1800))
        pilot.fly(0.1)
    assert simulation.v.autopilot.estimate.vel[0] ** 2 + simulation.v.autopilot.estimate.vel[1] ** 2 > 0.25
    assert simulation.v.autopilot.rc.channels[2] == 1700 and simulation.v.autopilot.rc.receiver_ok
    pilot.fly(3.0)  # the frames have ended
    assert not simulation.v.autopilot.rc.receiver_ok
    simulation.close()


@pytest.mark.slow
def test_physics_stopped_for_a_while_changes_nothing(physics) -> None:
    process = physics("copter", "--seed", "4")
    whole, stopped = Simulation(seed=4), Simulation(physics=process.address)
    listeners = [WatchedPilot(simulation) for simulation in (whole, stopped)]
    for simulation in (whole, stopped):
        simulation.advance(2.0)
    process.signal(signal.SIGSTOP)
    for _ in range(3):
        with pytest.raises(PhysicsLostError, match="does not answer"):
            stopped.advance_to(4_000_000)
    assert stopped.time_us == 2_000_000
    process.signal(signal.SIGCONT)
    go_on(stopped, 4_000_000)
    whole.advance_to(4_000_000)
    assert listeners[0].received.frames == listeners[1].received.frames
    assert stopped.plant.end.repeated > 0  # type: ignore[attr-defined]
    stopped.close()


@pytest.mark.slow
def test_an_autopilot_killed_in_mid_tick_leaves_time_standing(beside, tmp_path) -> None:
    server = beside()
    run = start_run(f"hil:tcp:127.0.0.1:{server.address[1]}", tmp_path)
    while server.end.ticks < 2000:
        assert run.poll() is None
    run.kill()
    run.communicate()
    while not any("has gone" in text for text in server.said):
        pass
    ticks = server.end.ticks
    simulation = Simulation(physics=f"hil:tcp:127.0.0.1:{server.address[1]}")
    assert simulation.time_us == 2500 * ticks
    simulation.advance(1.0)
    assert server.end.ticks == ticks + 400
    simulation.close()


def test_no_snapshots_of_a_physics_elsewhere(beside) -> None:
    server = beside()
    simulation = Simulation(physics=f"hil:tcp:127.0.0.1:{server.address[1]}")
    with pytest.raises(EngineError, match="other end"):
        simulation.snapshot()
    simulation.close()


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_both_commands_end_at_a_signal_with_the_other_gone(physics, tmp_path, number: signal.Signals) -> None:
    process = physics("copter")
    run = start_run(process.address, tmp_path)
    process.kill()
    run.send_signal(number)
    out, err = run.communicate(timeout=30)
    assert run.returncode == 0, out + err


def test_ticks_of_a_real_world_by_hand(beside) -> None:
    """The documented exchange, without a simulation around it."""
    server = beside()
    a = Vehicle()
    end = AutopilotEnd(a.fleet, a.index, a.v)
    with socket.create_connection(server.address, 10.0) as link:
        link.sendall(end.hello({}) + end.ask_state())
        while end.feed(link.recv(65536)) != TAKEN:
            pass
        for k in range(10):
            link.sendall(end.controls())
            while end.feed(link.recv(65536)) != TAKEN:
                pass
            assert a.v.time_us == 2500 * (k + 1)


def test_px4_on_a_real_socket(beside) -> None:
    """Time goes by itself until the first controls, and then waits for each."""
    server = beside()
    px4, splitter = Sender(1, 1), Splitter()
    with socket.create_connection(server.address, 10.0) as link:

        def ticks(count: int) -> list[int]:
            times: list[int] = []
            while len(times) < count:
                for frame in splitter.feed(link.recv(65536)):
                    if frame.kind is sensor.SENSOR_KIND:
                        times.append(frame.kind.decode(frame.payload).time_usec)
            return times

        link.sendall(px4.frame(HEARTBEAT, HEARTBEAT.payload(autopilot=MavAutopilot.PX4)))
        assert ticks(5)[:5] == [2500, 5000, 7500, 10_000, 12_500]
        for k in range(20):
            last = server.end.time_us
            answer = controls.KIND.payload(time_usec=1 + last + k, controls=[0.1] * 4, flags=1)
            link.sendall(px4.frame(controls.KIND, answer))
            if k > 3:  # before that there may still be ticks that nobody asked for
                assert ticks(1) == [last + 2500]
            else:
                while ticks(1)[-1] <= last:
                    pass
    assert any("every tick waits" in text for text in server.said)


class Absent:
    """Physics that answers or not, as it is told, in the place of a plant."""

    def __init__(self, simulation: Simulation) -> None:
        self._run, self.is_gone = simulation.plant.run, False
        simulation.plant.run = self.run  # type: ignore[method-assign]
        simulation.plant.runs_in_core = False

    def run(self, ticks: int) -> None:
        if self.is_gone:
            raise PhysicsLostError("gone")
        self._run(ticks)


def test_it_is_said_once_that_the_physics_has_gone_and_once_that_it_is_back(core) -> None:
    simulation = Simulation(core=core)
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    physics, patience = Absent(simulation), Patience(simulation)
    patience._standstill.wait = lambda: None  # type: ignore[method-assign]
    physics.is_gone = True
    for _ in range(3):  # as a run in lockstep does
        assert patience.advance_to(simulation.time_us)
        assert not patience.advance_to(10_000)
    physics.is_gone = False
    patience.advance_to(10_000)
    patience.advance_to(20_000)
    said = [m.fields.text.decode() for m in client.receive() if m.name == "STATUSTEXT"]
    assert said.count("gone") == said.count("Physics is back") == 1


def test_a_runs_duration_begins_where_it_joins_the_physics(beside, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(signal, "signal", lambda number, act: None)  # the tests keep their own
    server = beside()
    for n in (1, 2):
        options = ["--out", "none", "--tcp", "0", "--log-dir", str(tmp_path), "--speedup", "max", "--duration", "0.5"]
        assert main(["run", "copter", "--physics", f"hil:tcp:127.0.0.1:{server.address[1]}", *options]) == 0
        assert server.end.time_us == n * 500_000
