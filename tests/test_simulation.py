# SPDX-License-Identifier: BSD-3-Clause
"""The whole vehicle: determinism, snapshots, exact time, plain Python against compiled, reboot."""

from __future__ import annotations

import dataclasses
import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.recorded.pilot import VELOCITY_ONLY, Pilot
from sitl import vehicles
from sitl.core import records
from sitl.core.constants import TICK_US
from sitl.physics.native import truth
from sitl.simulation import Core, OptionError, Simulation
from sitl.vehicle.copter import Copter
from sitl.vehicle.copter import advance as advance_copter
from sitl.vehicles import AirframeError


def take_off(core: Core, frame: str = "erle_copter", seed: int = 0) -> Pilot:
    pilot = Pilot(Simulation(frame, seed=seed, core=core))
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=5.0)
    return pilot


def telemetry_digest(core: Core, seed: int) -> str:
    """Hash of every byte a client receives over a flight with set-points."""
    pilot = Pilot(Simulation(seed=seed, core=core))
    digest = hashlib.sha256()
    receive = pilot.connection.endpoint.link.receive

    def tapped() -> bytes:
        data = receive()
        digest.update(data)
        return data

    pilot.connection.endpoint.link.receive = tapped  # type: ignore[method-assign]
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=5.0)
    pilot.fly(8.0)
    pilot.stream_setpoint(3.0, VELOCITY_ONLY, (2.0, -1.0, 0.0))
    return digest.hexdigest()


def test_the_same_flight_twice_and_in_another_process_is_the_same_to_the_byte(core: Core) -> None:
    here = telemetry_digest(core, 7)
    assert telemetry_digest(core, 7) == here
    assert telemetry_digest(core, 8) != here
    root = Path(__file__).parents[1]
    program = (
        "from tests.test_simulation import telemetry_digest; from sitl.simulation import load_core; "
        "print(telemetry_digest(load_core(), 7))"
    )
    env = {**os.environ, "PYTHONPATH": str(root), "PYTHONHASHSEED": "99"}
    out = subprocess.run([sys.executable, "-c", program], cwd=root, env=env, capture_output=True, text=True)
    assert out.stdout.strip() == here, out.stderr


def test_the_step_of_the_caller_does_not_change_the_flight(core: Core) -> None:
    records_at_end = []
    for step_us in (2_500, 40_000, 1_000_000):
        pilot = take_off(core)
        simulation = pilot.simulation
        stop = simulation.time_us + 6_000_000
        while simulation.time_us < stop:
            simulation.advance_to(min(stop, simulation.time_us + step_us))
        records_at_end.append(simulation.fleet.copy())
    assert records.first_difference(records_at_end[0][0], records_at_end[1][0]) is None
    assert records.first_difference(records_at_end[0][0], records_at_end[2][0]) is None


def test_plain_python_gives_the_same_bits(core: Core) -> None:
    pilot = take_off(core)
    pilot.fly(4.0)
    pilot.setpoint(VELOCITY_ONLY, velocity=(1.0, 0.0, 0.0))
    pilot.fly(0.1)
    compiled, plain = pilot.simulation.fleet.copy(), pilot.simulation.fleet.copy()
    core(compiled, 0, 80)
    advance_copter({0: Copter.of(plain, 0)}, 0, 80)
    assert int(compiled["tick"][0]) == int(plain["tick"][0])
    assert records.first_difference(compiled[0], plain[0]) is None


def test_plain_python_gives_the_same_bits_from_power_on(core: Core) -> None:
    compiled, plain = (Simulation(core=core, seed=3).fleet for _ in range(2))
    core(compiled, 0, 120)
    advance_copter({0: Copter.of(plain, 0)}, 0, 120)
    assert records.first_difference(compiled[0], plain[0]) is None


def test_a_snapshot_restores_to_the_bit_and_forks(core: Core) -> None:
    pilot = take_off(core)
    pilot.fly(5.0)
    simulation = pilot.simulation
    snapshot = simulation.snapshot()
    time_us = simulation.time_us
    pilot.fly(3.0)
    first = simulation.fleet.copy()
    simulation.restore(snapshot)
    assert simulation.time_us == time_us
    pilot.fly(3.0)
    assert records.first_difference(first[0], simulation.fleet[0]) is None
    simulation.restore(snapshot)
    pilot.setpoint(VELOCITY_ONLY, velocity=(3.0, 0.0, 0.0))
    pilot.fly(3.0)
    assert records.first_difference(first[0], simulation.fleet[0]) is not None


def test_vehicles_of_a_fleet_do_not_touch_each_other(core: Core) -> None:
    pilot = take_off(core)
    pilot.fly(4.0)
    fleet = np.repeat(pilot.simulation.fleet, 5)
    alone = pilot.simulation.fleet.copy()
    core(alone, 0, 400)
    for index in (3, 0):
        core(fleet, index, 400)
        assert records.first_difference(alone[0], fleet[index]) is None
    assert records.first_difference(fleet[1], pilot.simulation.fleet[0]) is None


def test_time_is_exact(core: Core) -> None:
    simulation = Simulation(core=core)
    simulation.advance_to(1)
    assert simulation.time_us == TICK_US, "the first whole tick at or after the time asked for"
    simulation.advance(1.0)
    assert simulation.time_us == 1_002_500
    simulation.advance_to(0)
    assert simulation.time_us == 1_002_500, "time does not go back"


def test_reboot_keeps_parameters_and_time_goes_on(core: Core) -> None:
    pilot = Pilot(Simulation(core=core))
    pilot.fly(3.0)
    pilot.send("PARAM_SET", param_id=b"WPNAV_SPEED", param_value=300.0, param_type=9)
    pilot.fly(1.0)
    pilot.send_command("PREFLIGHT_REBOOT_SHUTDOWN", 1)
    pilot.fly(1.0)
    simulation = pilot.simulation
    assert (246, 0) in pilot.acks
    assert simulation.v.autopilot.params.WPNAV_SPEED == 300.0
    assert simulation.time_us == 5_000_000
    assert int(simulation.v.time_us) < 1_100_000
    pilot.ask_for_telemetry()
    pilot.boot()
    pilot.arm()


def test_truth_and_estimate_agree_after_a_flight(core: Core) -> None:
    """Default noise: within 1 m and 1 degree RMS on the airframe with noise."""
    pilot = take_off(core, seed=11)
    pilot.fly(8.0)
    position, tilt = [], []
    for leg in ((3.0, 0.0, 0.0), (0.0, 3.0, -1.0), (-3.0, -2.0, 0.5), (0.0, 0.0, 0.0)):
        for _ in range(50):
            pilot.setpoint(VELOCITY_ONLY, velocity=leg)
            pilot.fly(0.1)
            v = pilot.simulation.v
            true, e = truth.read(v), v.autopilot.estimate
            position.append([float(e.pos[k]) - true.pos[k] for k in range(3)])
            angles = [float(e.euler[k]) - true.euler[k] for k in range(3)]
            tilt.append([(a + np.pi) % (2 * np.pi) - np.pi for a in angles])
    assert np.sqrt(np.mean(np.sum(np.square(position), axis=1))) < 1.0
    assert np.degrees(np.sqrt(np.mean(np.square(tilt), axis=0))).max() < 1.0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"frame": "no_such_frame"}, "no_such_frame.*erle_copter"),
        ({"estimator": "magic"}, "magic.*ekf, truth"),
        ({"home": (91.0, 0.0, 0.0, 0.0)}, "latitude"),
        ({"home": (1.0, 2.0, 3.0)}, "is not .latitude, longitude, altitude, heading"),
        ({"home": "here"}, "is not .latitude, longitude"),
        ({"seed": 1.5}, "seed 1.5 is not a whole number"),
        ({"params": {"WPNAV_SPEED": float("nan")}}, "WPNAV_SPEED.*finite"),
        ({"params": {"WPNAV_SPEED": "fast"}}, "WPNAV_SPEED: 'fast' is not a number"),
    ],
)
def test_bad_arguments_are_named(core: Core, arguments: dict, says: str) -> None:
    with pytest.raises((OptionError, ValueError), match=says):
        Simulation(core=core, **arguments)


def test_an_airframe_with_a_parameter_that_does_not_exist_is_refused(core: Core) -> None:
    airframe = vehicles.load("erle_copter")
    odd = dataclasses.replace(airframe, parameters={**airframe.parameters, "ATC_TYPO": 1.0})
    with pytest.raises(AirframeError, match="no parameters ATC_TYPO"):
        Simulation(odd, core=core)


@pytest.mark.parametrize("seconds", [-1.0, float("nan"), float("inf"), "5"])
def test_time_that_cannot_pass_is_refused(core: Core, seconds: object) -> None:
    simulation = Simulation(core=core)
    with pytest.raises(OptionError, match="cannot advance"):
        simulation.advance(seconds)  # type: ignore[arg-type]
    assert simulation.time_us == 0


def test_a_snapshot_of_another_airframe_is_refused(core: Core) -> None:
    simulation = Simulation(core=core)
    before = simulation.fleet.copy()
    with pytest.raises(OptionError, match="ardupilot_quad, this is erle_copter"):
        simulation.restore(Simulation("ardupilot_quad", core=core).snapshot())
    assert records.first_difference(before[0], simulation.fleet[0]) is None


def test_an_observer_looks_at_its_times_and_changes_nothing(core: Core) -> None:
    class Looker:
        def __init__(self, simulation: Simulation) -> None:
            self.simulation, self.due_us, self.seen = simulation, 0, []

        def observe(self) -> None:
            self.seen.append(self.simulation.time_us)
            self.due_us += 33_000

    watched, alone = Simulation(core=core, seed=3), Simulation(core=core, seed=3)
    looker = Looker(watched)
    watched.observers.append(looker)
    for simulation in (watched, alone):
        simulation.advance(1.0)
    assert looker.seen[:3] == [2500, 35_000, 67_500]  # the first tick at or after each
    assert watched.fleet.tobytes() == alone.fleet.tobytes()
