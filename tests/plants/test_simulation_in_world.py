# SPDX-License-Identifier: BSD-3-Clause
"""Whole vehicles in worlds: start poses, walls, snapshots, plain Python against compiled, messages."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.recorded.pilot import VELOCITY_ONLY, Pilot
from sitl.core import records
from sitl.physics.native import truth
from sitl.simulation import Core, OptionError, Simulation
from sitl.worlds import Box, Start, World, WorldError, contact, names

ROOT = Path(__file__).parents[2]


def behind_a_wall(ahead: float, yaw: float = 0.0) -> World:
    return World("wall", (Box((ahead, 0.0, 1.5), (0.2, 40.0, 3.0), yaw),), (Start("here", (0.0, 0.0, 0.0), 0.0),))


def hovering(core: Core, world: World | str, **options: object) -> Pilot:
    pilot = Pilot(Simulation("erle_copter", world=world, core=core, estimator="truth", **options))  # type: ignore[arg-type]
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=1.2)
    pilot.fly(6.0)
    return pilot


def driving(core: Core, world: World | str, seconds: float, throttle: int = 1900, **options: object) -> Pilot:
    pilot = Pilot(Simulation("erle_rover", world=world, core=core, estimator="truth", **options))  # type: ignore[arg-type]
    pilot.boot()
    pilot.arm()
    pilot.choose_mode("MANUAL")
    drive(pilot, seconds, throttle)
    return pilot


def drive(pilot: Pilot, seconds: float, throttle: int, steering: int = 1500) -> None:
    for _ in range(round(10 * seconds)):
        pilot.send("RC_CHANNELS_OVERRIDE", chan1_raw=steering, chan3_raw=throttle)
        pilot.fly(0.1)


def clearance(simulation: Simulation) -> float:
    """Of the disc in the middle of the vehicle's outline to the world's nearest solid [m]."""
    assert simulation.world is not None
    a, (n, e, d) = simulation.v.physics.airframe, simulation.v.physics.body.pos
    return contact.clearance(simulation.world.geometry, n, e, d - a.contact_top, d, a.contact_radius).distance


def test_a_copter_flown_into_a_wall_stops_there(cores: dict[str, Core]) -> None:
    pilot = hovering(cores["copter"], behind_a_wall(5.0))
    for _ in range(50):
        pilot.setpoint(VELOCITY_ONLY, velocity=(2.0, 0.0, 0.0))
        pilot.fly(0.1)
        assert truth.read(pilot.simulation.v).pos[0] <= 4.9 - 0.32 + 1e-9
    t, o = truth.read(pilot.simulation.v), pilot.simulation.v.physics.obstacles
    assert t.pos[0] == pytest.approx(4.58, abs=1e-6) and abs(t.pos[1]) < 0.1 and -t.pos[2] > 1.0
    assert o.touching == 1 and o.hit_count == 1 and o.hit_speed == pytest.approx(2.0, abs=0.1)
    assert [text for _, _, text in pilot.texts if "obstacle" in text] == [f"SIM Hit obstacle at {o.hit_speed:f} m/s"]
    for _ in range(70):  # its position target has run ahead
        pilot.setpoint(VELOCITY_ONLY, velocity=(-1.0, 0.0, 0.0))
        pilot.fly(0.1)
    assert truth.read(pilot.simulation.v).pos[0] < 4.0 and o.touching == 0, "and it flies away again"


def test_a_copter_lands_on_a_table_rests_and_takes_off_again(cores: dict[str, Core]) -> None:
    table = World("table", (Box((5.0, 0.0, 0.5), (8.0, 8.0, 1.0)),), (Start("here", (0.0, 0.0, 0.0), 0.0),))
    pilot = Pilot(Simulation("erle_copter", world=table, core=cores["copter"]))
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=3.0)
    pilot.fly(8.0)
    for _ in range(50):
        pilot.setpoint(VELOCITY_ONLY, velocity=(1.0, 0.0, 0.0))
        pilot.fly(0.1)
    pilot.fly(3.5)
    pilot.choose_mode("LAND")
    assert pilot.fly(40.0, lambda: not pilot.armed), pilot.texts
    v = pilot.simulation.v
    there = v.physics.body.pos
    assert there[2] == pytest.approx(-1.0, abs=1e-6)
    pilot.fly(30.0)
    assert v.physics.body.pos == pytest.approx(there, abs=0.01)
    assert np.abs(v.physics.body.rates).max() < 1e-6 and v.sensors.acc[2] == pytest.approx(-9.8, abs=0.3)
    assert float(v.sensors.rangefinder_range[0]) == pytest.approx(0.01), "its least"
    pilot.choose_mode("GUIDED")
    pilot.fly(0.5)
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=4.0)
    pilot.fly(8.0)
    assert -v.physics.body.pos[2] > 2.5


@pytest.mark.parametrize("yaw", [0.0, 0.6])
def test_a_rover_driven_into_a_wall_stops_there(cores: dict[str, Core], yaw: float) -> None:
    pilot = driving(cores["rover"], behind_a_wall(7.0, yaw), 9.0)
    v = pilot.simulation.v
    assert v.physics.obstacles.hit_speed == pytest.approx(1.59 * math.cos(yaw), abs=0.03)
    assert sum("Hit obstacle" in text for _, _, text in pilot.texts) == 1
    assert abs(v.physics.wheels.forward) < 0.05
    if yaw == 0.0:
        assert v.physics.body.pos[0] == pytest.approx(6.9 - 0.9 - 0.506, abs=1e-6)
    drive(pilot, 3.0, 1100)
    assert v.physics.wheels.forward < -1.4, "and backs away"


def test_the_estimator_lives_through_a_crash(cores: dict[str, Core]) -> None:
    pilot = Pilot(Simulation("erle_copter", world=behind_a_wall(5.0), core=cores["copter"]))
    pilot.boot()
    pilot.arm()
    pilot.send_command("NAV_TAKEOFF", altitude=1.2)
    pilot.fly(6.0)
    for _ in range(60):
        pilot.setpoint(VELOCITY_ONLY, velocity=(2.0, 0.0, 0.0))
        pilot.fly(0.1)
    v = pilot.simulation.v
    assert v.physics.obstacles.hit_count == 1
    assert np.array(v.autopilot.estimate.vel) == pytest.approx(np.array(v.physics.body.vel), abs=0.5)
    assert v.autopilot.estimate.position_ok == 1 and pilot.armed


def test_worlds_are_walked_round_with_fresh_lists(cores: dict[str, Core]) -> None:
    """The maze has 55 walls, the record room for 24; no wall is entered on the way."""
    pilot = driving(cores["rover"], "maze_erlerover", 0.1)
    simulation, places = pilot.simulation, set()
    for k in range(60):
        drive(pilot, 1.0, 1900, (1500, 1700, 1300)[k % 3])
        o = simulation.v.physics.obstacles
        places.add((o.north, o.east))
        assert clearance(simulation) > -1e-9
    assert simulation.v.physics.obstacles.hit_count >= 1 or len(places) > 1


@pytest.mark.parametrize(
    ("frame", "world", "place", "heading"),
    [
        ("erle_copter", "office_erlecopter", (0.0, 0.0), 180.0),
        ("erle_rover", "maze_erlerover", (0.114, 0.0), 0.0),
        ("ardupilot_rover", "circuit2", (0.0, 0.0), None),
    ],
)
def test_it_stands_at_the_worlds_start(
    cores: dict[str, Core], frame: str, world: str, place: tuple[float, float], heading: float | None
) -> None:
    home = (47.3, 8.5, 400.0, 77.0)
    simulation = Simulation(frame, world=world, home=home, core=cores["copter" if "copter" in frame else "rover"])
    t = truth.read(simulation.v)
    assert t.pos == (pytest.approx(place[0], abs=1e-9), pytest.approx(place[1], abs=1e-9), 0.0)
    if heading is not None:
        assert math.cos(t.euler[2] - math.radians(heading)) == pytest.approx(1.0, abs=1e-6)
    assert t.lat == pytest.approx(47.3, abs=2e-5) and t.alt == 400.0
    assert simulation.home[:3] == home[:3] and t.on_ground


def test_a_start_of_ones_own(cores: dict[str, Core]) -> None:
    simulation = Simulation("erle_copter", world="office_erlecopter", start=(1.0, 2.0, 0.0, 90.0), core=cores["copter"])
    t = truth.read(simulation.v)
    assert t.pos == (1.0, -2.0, 0.0) and t.euler[2] == pytest.approx(-math.pi / 2)
    named = Simulation("erle_copter", world="office_erlecopter", start="floor", core=cores["copter"])
    assert truth.read(named.v).pos == (0.0, 0.0, 0.0)


def test_gps_home_and_local_position_begin_at_the_start(cores: dict[str, Core]) -> None:
    simulation = Simulation("erle_copter", world="office_erlecopter", start=(1.0, 2.0, 0.0, 0.0), core=cores["copter"])
    pilot = Pilot(simulation)
    pilot.boot()
    estimate = np.array(simulation.v.autopilot.estimate.pos)
    assert np.abs(estimate[:2]).max() < 3.0, "local positions count from where it stood"
    assert simulation.v.autopilot.estimate.origin_lat == pytest.approx(simulation.home[0] * 1e7 + 90, abs=400)


@pytest.mark.parametrize(
    ("options", "error", "said"),
    [
        ({"world": "nowhere"}, WorldError, names()[0]),
        ({"world": "office_erlecopter", "start": "roof"}, WorldError, "it has original, floor"),
        ({"start": "original"}, OptionError, "needs a world"),
        ({"world": "office_erlecopter", "start": (1, 2, 3)}, OptionError, r"\(x, y, z, yaw\) in metres and degrees"),
        ({"world": "office_erlecopter", "start": (1, 2, math.nan, 3)}, OptionError, "neither the name"),
        ({"world": "office_erlecopter", "start": (0, 0, 2, 0)}, OptionError, "within 0.5 m of z = 0 m"),
        ({"world": "office_erlecopter", "start": (-5.1737, -9.1038, 0, 0)}, OptionError, "solid Stairs_7 of world"),
        ({"world": 7}, WorldError, "neither a name"),
    ],
)
def test_wrong_worlds_and_starts(options: dict[str, object], error: type[Exception], said: str) -> None:
    with pytest.raises(error, match=said):
        Simulation("erle_copter", **options)  # type: ignore[arg-type]


def test_a_world_file_and_a_reboot(cores: dict[str, Core], tmp_path: Path) -> None:
    file = tmp_path / "yard.toml"
    file.write_text(
        'start = [ { name = "gate", position = [1, 1, 0], yaw_deg = 90 } ]\n'
        "box = [ { centre = [4, 1, 1], size = [0.2, 5, 2] } ]\n"
    )
    simulation = Simulation("erle_copter", world=file, core=cores["copter"])
    simulation.advance(1.05)
    scan = simulation.v.sensors.lidar_ranges.copy()
    simulation.request_reboot()
    simulation.advance(0.25)
    v = simulation.v
    assert simulation.time_us == 1_300_000 and v.sensors.lidar_count == 3
    assert list(v.physics.body.pos) == [1.0, -1.0, 0.0] and v.physics.obstacles.present == 1
    assert (v.sensors.lidar_ranges == scan).all() and np.isfinite(scan[:70]).any()


def test_a_world_without_solids_is_a_floor(cores: dict[str, Core]) -> None:
    empty = World("empty", (), (Start("here", (0.0, 0.0, 0.0), 0.0),))
    simulation = Simulation("erle_copter", world=empty, core=cores["copter"])
    simulation.advance(0.5)
    assert simulation.v.physics.obstacles.present == 0 and simulation.v.sensors.lidar_count == 6
    assert np.isinf(simulation.v.sensors.lidar_ranges[:70]).all()


def test_the_same_from_a_snapshot(cores: dict[str, Core]) -> None:
    pilot = hovering(cores["copter"], behind_a_wall(5.0))
    simulation = pilot.simulation
    for name in ("DEBUG_FLOAT_ARRAY", "DISTANCE_SENSOR", "OBSTACLE_DISTANCE"):
        pilot.set_rate(name, 10.0)
    pilot.fly(0.1)
    snapshot, results = simulation.snapshot(), []
    for _ in range(2):
        received = []
        for _ in range(35):
            pilot.setpoint(VELOCITY_ONLY, velocity=(2.0, 0.5, 0.0))
            simulation.advance(0.1)
            received += [(name, repr(fields)) for name, fields in pilot.connection.endpoint.receive()]
        results.append((simulation.fleet[0].tobytes(), received))
        assert simulation.v.physics.obstacles.hit_count == 1
        simulation.restore(snapshot)
    assert results[0] == results[1]
    assert sum(name == "DEBUG_FLOAT_ARRAY" for name, _ in results[0][1]) == 2 * 35, "70 readings in two parts"


def test_a_snapshot_of_another_world_is_refused(cores: dict[str, Core]) -> None:
    here = Simulation("erle_copter", world="office_erlecopter", core=cores["copter"])
    plain = Simulation("erle_copter", core=cores["copter"])
    with pytest.raises(OptionError, match="of world None, this is world office_erlecopter"):
        here.restore(plain.snapshot())
    with pytest.raises(OptionError, match="of world office_erlecopter"):
        plain.restore(here.snapshot())


def test_plain_python_gives_the_same_bits_at_a_wall(cores: dict[str, Core]) -> None:
    """Ticks about the first touch, of the core."""
    flown = hovering(cores["copter"], behind_a_wall(5.0))
    o = flown.simulation.v.physics.obstacles
    while truth.read(flown.simulation.v).pos[0] < 4.5:
        flown.setpoint(VELOCITY_ONLY, velocity=(2.0, 0.3, 0.0))
        flown.fly(0.02)
    driven = driving(cores["rover"], behind_a_wall(7.0, 0.4), 0.1)
    while driven.simulation.v.physics.obstacles.clear > 0.02 or o.clear == 0.0:
        drive(driven, 0.1, 1900)
    for pilot in (flown, driven):
        core = pilot.simulation.core
        compiled, plain = pilot.simulation.fleet.copy(), pilot.simulation.fleet.copy()
        core(compiled, 0, 40)  # to the event, and on
        core(compiled, 0, 40)
        Core(core.kind, None)(plain, 0, 40)
        Core(core.kind, None)(plain, 0, 40)
        assert compiled["physics"]["obstacles"]["hit_count"][0] == 1
        assert int(compiled["tick"][0]) == int(plain["tick"][0])
        assert records.first_difference(compiled[0], plain[0]) is None


PROGRAM = """
import hashlib
from sitl import vehicles
from sitl.simulation import Simulation
airframe = vehicles.load("erle_copter").changed(lidar_noise=0.02, rangefinder_noise=0.02)
s = Simulation(airframe, world="office_erlecopter", start=(0.5, 0.2, 0.0, 77.0), seed=5)
s.v.physics.body.q = (0.9, 0.1, -0.2, 0.3)
s.v.physics.body.q /= (0.95 ** 0.5)
s.advance(0.31)
print(hashlib.sha256(s.fleet[0].tobytes()).hexdigest(), s.v.sensors.lidar_count)
"""


def test_plain_python_sees_the_same_scan() -> None:
    """The lidar's own kernels, too: in a process without a compiler."""
    digests = set()
    for disabled in ("0", "1"):
        environment = {**os.environ, "NUMBA_DISABLE_JIT": disabled, "PYTHONPATH": str(ROOT)}
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM], env=environment, capture_output=True, text=True, timeout=300, check=True
        )
        digests.add(done.stdout)
    assert len(digests) == 1 and next(iter(digests)).split()[1] == "4"
