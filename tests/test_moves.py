# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that is put elsewhere flies on from there as one that was booted and taken off there."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from sitl import vehicles
from sitl.autopilot.copter.modes.autotune_gains import YAW
from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.client import Client, Endpoint
from sitl.core import rng
from sitl.core.geodesy import offset_ne
from sitl.core.vectors import Vec2
from sitl.deprecation import SitlDeprecationWarning
from sitl.errors import OptionError
from sitl.fleet import Fleet
from sitl.move import Move
from sitl.simulation import Simulation, Snapshot
from sitl.vehicle.core_entry import load_core
from sitl.vehicle.kinds import KINDS
from sitl.vehicle.move import MoveOrder

FRAMES = {"copter": "erle_copter", "rover": "erle_rover"}
WORLDS = {"copter": "office_erlecopter", "rover": "maze_erlerover"}
PLACES = [(0.0, 0.0, 2.0), (30.0, -12.0, 0.0), (-400.0, 900.0, -2.9), (3000.0, -2500.0, 1.2), (0.5, 0.5, 3.1)]
"""North, east [m], heading [rad]."""
VELOCITY_ONLY = 0x5C7
BODY_OFFSET = 9
N, SAMPLES = 3, 12


def prepare(frame: str, height: float = 5.0, **options: Any) -> Snapshot:
    """In GUIDED, armed, a copter in the air; telemetry at 10 Hz."""
    kind = KINDS["copter" if frame.endswith(("copter", "quad")) else "rover"]
    simulation = Simulation(frame, core=load_core(kind), **options)
    client = Client(simulation)
    client.wait_ready()
    if kind.flies:
        client.take_off(height)
    else:
        client.set_mode("GUIDED")
        client.arm()
    for name in ("LOCAL_POSITION_NED", "GLOBAL_POSITION_INT", "ATTITUDE", "HOME_POSITION", "DEBUG_FLOAT_ARRAY"):
        client.set_rate(name, 10)
    simulation.advance(4.0)
    return simulation.snapshot()


@pytest.fixture(scope="module", params=FRAMES)
def kind(request: Any) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def prepared(kind: str) -> Snapshot:
    return prepare(FRAMES[kind])


@pytest.fixture
def fleet(kind: str, prepared: Snapshot) -> Iterator[Fleet]:
    made = Fleet(FRAMES[kind], N, core=load_core(KINDS[kind]))
    made.put(range(N), prepared)
    yield made
    made.close()


def drive(fleet: Fleet, rows: Any, seconds: float, forward: float = 0.0, turn: float = 0.0) -> None:
    """Velocity along the body [m/s] and turn rate [rad/s] as set-points, ten times a second."""
    kind = message("SET_POSITION_TARGET_LOCAL_NED")
    for k in range(round(seconds * 10)):
        payload = kind.payload(
            target_system=1, coordinate_frame=BODY_OFFSET, type_mask=VELOCITY_ONLY, vx=forward, yaw_rate=turn
        )
        for row in rows:
            fleet.send(row, encode_v2(kind, payload, k & 0xFF, 255, 190))
        fleet.advance(0.1)
    fleet.drop_telemetry()


def heading(q: Any) -> float:
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


def turn(v: Any, angle: float) -> Any:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]])


def error(v: Any) -> Any:
    """What the estimate of the position is wrong by, NED [m]."""
    place, e, pos = v.physics.origin, v.autopilot.estimate, v.physics.body.pos
    north, east = offset_ne(place.lat, place.lon, e.origin_lat, e.origin_lon)
    return np.array([north + e.pos.x - pos.x, east + e.pos.y - pos.y, e.pos.z - pos.z])


def resets(v: Any) -> tuple[int, ...]:
    e, f = v.autopilot.estimate, v.autopilot.modes.failsafe
    return e.reset_ne_count, e.reset_d_count, e.reset_yaw_count, v.autopilot.ekf.resets, int(f.ekf), int(f.gcs)


def variances(v: Any) -> tuple[float, ...]:
    e = v.autopilot.estimate
    return e.variance_pos, e.variance_vel, e.variance_hgt, e.variance_mag


def numbers(record: Any) -> Iterator[tuple[str, Any]]:
    """(Path, array of numbers) of all fields of a record."""
    for name in record.dtype.names:
        field = record[name]
        if field.dtype.names is None:
            yield name, np.asarray(field, float)
        elif field.shape:
            for k, part in enumerate(field):
                yield from ((f"{name}.{k}.{path}", value) for path, value in numbers(part))
        else:
            yield from ((f"{name}.{path}", value) for path, value in numbers(field))


# ---------------------------------------------------------------------- the record


def test_a_move_that_says_nothing_changes_nothing(fleet: Fleet) -> None:
    before = fleet.records[1].copy()
    fleet.move(1, Move())
    for (path, old), (_, new) in zip(numbers(before), numbers(fleet.records[1])):
        np.testing.assert_array_equal(old, new, path)


def test_there_and_back_is_the_same_record(fleet: Fleet) -> None:
    fleet.move(0, Move(north=0.0, east=0.0, heading=0.3))
    before, body = fleet.records[0].copy(), fleet.view(0).physics.body
    for north, east, angle in PLACES:
        fleet.move(0, Move(north, east, heading=angle))
        assert math.hypot(body.pos.x - north, body.pos.y - east) < 1e-9
    fleet.move(0, Move(north=0.0, east=0.0, heading=0.3))
    for (path, old), (_, new) in zip(numbers(before), numbers(fleet.records[0])):
        places = path.endswith(("lat", "lon"))  # whole 1e-7 degrees, and what was rounded off
        tolerance = 4.0 if places else 0.06 if path.startswith("autopilot") else 1e-6
        if path.startswith(("sensors.gps", "physics.sensors.gps")):
            tolerance = 5.0  # whole 1e-7 degrees, cm/s
        if path.split(".")[-1] in ("q", "target_q") and np.dot(new, old) < 0.0:
            new = -new  # the same attitude
        if path.endswith(("yaw", "heading", "look_ahead", "angle", "euler")):
            new = old + np.remainder(new - old + math.pi, math.tau) - math.pi
        np.testing.assert_allclose(new, old, rtol=1e-9, atol=tolerance, err_msg=path)
    np.testing.assert_allclose(fleet.records[0]["autopilot"]["ekf"]["P"], before["autopilot"]["ekf"]["P"], atol=1e-12)


@pytest.mark.parametrize("place", PLACES)
def test_what_the_estimate_is_wrong_by_turns_along(fleet: Fleet, place: tuple[float, float, float]) -> None:
    moved, stays = fleet.view(1), fleet.view(0)
    was, before = error(stays), heading(stays.physics.body.q)
    fleet.move(1, Move(*place[:2], heading=place[2]))
    angle = place[2] - before
    assert math.remainder(heading(moved.physics.body.q) - place[2], math.tau) == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(error(moved), turn(was, angle), atol=1e-3)
    np.testing.assert_allclose(moved.physics.body.vel, turn(stays.physics.body.vel, angle), atol=1e-12)
    tilt = moved.autopilot.estimate.euler, stays.autopilot.estimate.euler
    assert tilt[0].roll == pytest.approx(tilt[1].roll) and tilt[0].pitch == pytest.approx(tilt[1].pitch)
    yaws = [heading(v.physics.body.q) - v.autopilot.estimate.euler.yaw for v in (moved, stays)]
    assert math.remainder(yaws[0] - yaws[1], math.tau) == pytest.approx(0.0, abs=1e-9)
    home, local = moved.autopilot.home, moved.autopilot.estimate
    there = offset_ne(local.origin_lat, local.origin_lon, home.lat, home.lon)
    assert math.dist(there, home.pos[:2]) < 0.012
    np.testing.assert_allclose(
        math.dist(local.pos, home.pos), math.dist(stays.autopilot.estimate.pos, stays.autopilot.home.pos), atol=1e-9
    )


@pytest.mark.parametrize("place", PLACES[:4])
def test_it_flies_on_as_the_one_that_stayed(kind: str, prepared: Snapshot, place: tuple[float, float, float]) -> None:
    """Twelve that stay and twelve that are moved, each with noise of its own: they are spread alike."""
    fleet = Fleet(FRAMES[kind], 2 * SAMPLES, core=load_core(KINDS[kind]))
    fleet.move(range(SAMPLES), [Move(seed=k) for k in range(SAMPLES)], prepared)
    away = [Move(*place[:2], heading=place[2], seed=100 + k) for k in range(SAMPLES)]
    fleet.move(range(SAMPLES, 2 * SAMPLES), away, prepared)
    views = [fleet.view(k) for k in range(len(fleet))]
    before, was = resets(views[0]), [error(v) for v in views]
    angles = [heading(v.physics.body.q) for v in views]
    starts = [np.array(v.physics.body.pos) for v in views]
    for _ in range(10):
        drive(fleet, range(len(fleet)), 0.1)
        assert max(max(variances(v)) for v in views) < 0.5
    drive(fleet, range(len(fleet)), 6.0, forward=1.0, turn=0.3)
    ways = np.array([turn(np.array(v.physics.body.pos) - a, -yaw) for v, a, yaw in zip(views, starts, angles)])
    drifts = np.array([turn(error(v) - e, -yaw) for v, e, yaw in zip(views, was, angles)])
    courses = [math.remainder(heading(v.physics.body.q) - yaw, math.tau) for v, yaw in zip(views, angles)]
    headings = [math.remainder(v.autopilot.estimate.euler.yaw - heading(v.physics.body.q), math.tau) for v in views]
    assert np.linalg.norm(ways[0]) > 3.0
    for found, least in ((ways, 0.03), (drifts, 0.03), (courses, 0.02), (headings, 0.02)):
        stayed, moved = np.array(found[:SAMPLES]), np.array(found[SAMPLES:])
        spread = np.hypot(stayed.std(axis=0), moved.std(axis=0)) / math.sqrt(SAMPLES)
        assert np.all(np.abs(stayed.mean(axis=0) - moved.mean(axis=0)) < 4.0 * spread + least)
    for v in views:
        assert resets(v) == before and v.autopilot.arming.armed and max(variances(v)) < 0.7
    fleet.close()


def test_compiled_and_plain_python_move_alike(fleet: Fleet, kind: str) -> None:
    fleet.move(0, Move(12.0, -7.0, heading=2.0, wind=(3.0, 40.0, 1.0), properties={"mass": 1.3}, seed=7))
    plain = Fleet(fleet.scenario, 1, core=load_core(KINDS[kind]))
    plain.put(0, fleet.snapshot(1))
    orders = MoveOrder.fleet(1)
    order, v = MoveOrder.of(orders, 0), plain.view(0)
    move = Move(12.0, -7.0, heading=2.0, wind=(3.0, 40.0, 1.0), properties={"mass": 1.3})
    move.write(order, 0, v, plain.kind)
    plain.records["physics"]["airframe"]["mass"][0] = 1.3
    rng.seed(v.rng, 7)
    KINDS[kind].move([v], 0, 1, orders.ctypes.data, 0)  # type: ignore[misc]
    for (path, compiled), (_, here) in zip(numbers(fleet.records[0]), numbers(plain.records[0])):
        np.testing.assert_allclose(here, compiled, rtol=1e-12, atol=1e-12, err_msg=path)
    plain.close()


def test_many_at_once_are_as_one_by_one_and_repeat_bit_by_bit(fleet: Fleet, prepared: Snapshot) -> None:
    moves = [Move(10.0 * k, 1.0, heading=0.5 * k, seed=k) for k in range(N)]
    fleet.move(range(N), moves, prepared)
    together = fleet.records.tobytes()
    for again in range(2):
        for k in range(N):
            fleet.move(k, moves[k], prepared)
        assert fleet.records.tobytes() == together, again
    fleet.advance(1.0)
    after = fleet.records.tobytes()
    fleet.move(range(N), moves, prepared)
    fleet.advance(1.0)
    assert fleet.records.tobytes() == after


# ---------------------------------------------------------------------- telemetry


def test_the_first_telemetry_tells_of_the_new_place(fleet: Fleet) -> None:
    class Link:
        def send(self, data: bytes) -> None:
            fleet.send(0, data)

        def receive(self) -> bytes:
            return fleet.receive(0)

    fleet.move(0, Move(200.0, -50.0, heading=1.0))
    station, v = Endpoint(Link()), fleet.view(0)
    fleet.advance(0.1)
    said = {m.name: m.fields for m in station.receive()}
    pos, place, wrong = v.physics.body.pos, v.physics.origin, error(v)
    everywhere = said["GLOBAL_POSITION_INT"]
    north, east = offset_ne(place.lat, place.lon, everywhere.lat, everywhere.lon)
    assert math.dist((north, east), (pos.x + wrong[0], pos.y + wrong[1])) < 0.05
    assert everywhere.hdg / 100.0 == pytest.approx(math.degrees(1.0), abs=3.0)
    local = said["LOCAL_POSITION_NED"]
    np.testing.assert_allclose((local.x, local.y, local.z), v.autopilot.estimate.pos, atol=1e-4)
    assert said["ATTITUDE"].yaw == pytest.approx(1.0, abs=0.05)
    home = said["HOME_POSITION"]
    north, east = offset_ne(place.lat, place.lon, home.latitude, home.longitude)
    assert math.dist((north, east), (200.0, -50.0)) < 3.0
    assert math.dist((home.x, home.y), (local.x, local.y)) < 2.0


def test_scans_and_solids_are_those_of_the_new_place(kind: str) -> None:
    world, frame = WORLDS[kind], FRAMES[kind]
    start = (1.0, 0.5, 0.0, 60.0) if kind == "rover" else (-1.0, 0.5, 0.0, 60.0)
    there = Simulation(frame, world=world, start=start)
    fleet = Fleet(frame, 1, world=world)
    body, other = fleet.view(0).physics.body, there.v.physics.body
    fleet.move(0, Move(other.pos.x, other.pos.y, heading=heading(other.q)))
    np.testing.assert_allclose(body.pos, other.pos, atol=1e-9)
    np.testing.assert_allclose(fleet.view(0).sensors.lidar_ranges[:70], there.v.sensors.lidar_ranges[:70], atol=1e-4)
    rows = [v.physics.obstacles for v in (fleet.view(0), there.v)]
    assert rows[0].count == rows[1].count > 0 and not rows[0].wanted
    np.testing.assert_allclose(rows[0].rows, rows[1].rows, atol=1e-9)
    fleet.advance(0.3)
    there.advance(0.3)
    np.testing.assert_allclose(fleet.view(0).sensors.lidar_ranges[:70], there.v.sensors.lidar_ranges[:70], atol=1e-4)
    fleet.close()


# ---------------------------------------------------------------------- properties, wind, speed


HOVERS = [
    Move(properties={"mass": 0.8}),
    Move(properties={"mass": 1.6}),
    Move(properties={"thrust_coefficient": 7e-6}),
    Move(properties={"rotor_drag": 2e-4}, wind=(5.0, 200.0, 0.0)),
    Move(wind=(8.0, 90.0, 0.0)),
    Move(heading=2.5, wind=(6.0, 10.0, 0.0), properties={"mass": 1.35, "time_constant_up": 0.02}),
    Move(50.0, 3.0, heading=-2.0, properties={"speed_max": 760.0}),
]


@pytest.fixture(scope="module")
def hovering() -> Snapshot:
    return prepare("erle_copter")


@pytest.mark.parametrize("move", HOVERS)
def test_a_copter_hovers_on_with_other_properties_in_another_wind(hovering: Snapshot, move: Move) -> None:
    fleet = Fleet("erle_copter", 2)
    fleet.put((0, 1), hovering)
    fleet.move(1, move)
    v, stays = fleet.view(1), fleet.view(0)
    before, start = resets(v), np.array(v.physics.body.pos)
    other = np.array(stays.physics.body.pos)
    for _ in range(30):
        fleet.advance(0.1)
        way, own = np.array(v.physics.body.pos) - start, np.array(stays.physics.body.pos) - other
        assert abs(way[2] - own[2]) < 0.05, way
        assert np.linalg.norm(way[:2]) < np.linalg.norm(own[:2]) + 0.15, way
        assert max(variances(v)) < 0.3
    assert resets(v) == before and v.autopilot.arming.armed
    for name, value in move.properties.items():
        assert getattr(v.physics.airframe, name) == value
    if move.wind is not None:
        assert v.physics.wind.speed == v.autopilot.params.SIM.WIND_SPD == move.wind[0]
    fleet.close()


def test_it_hovers_as_one_that_took_off_so(hovering: Snapshot) -> None:
    """Throttle and lean are those of a vehicle that has learnt them."""
    heavy = vehicles.load("erle_copter").changed(mass=1.4)
    wind = {"SIM_WIND_SPD": 5.0, "SIM_WIND_DIR": 130.0}
    own = Simulation(heavy, params=wind)
    client = Client(own)
    client.wait_ready()
    client.take_off(5.0)
    own.advance(15.0)
    fleet = Fleet("erle_copter", 1)
    fleet.put(0, hovering)
    fleet.move(0, Move(properties={"mass": 1.4}, wind=(5.0, 130.0, 0.0)))
    throttles: list[float] = []
    leans: list[Any] = []
    for v, advance in ((fleet.view(0), fleet.advance), (own.v, own.advance)):
        found = []
        for _ in range(40):
            advance(0.05)
            e = v.autopilot.estimate.euler
            found.append((v.autopilot.control.motors.throttle_out, e.roll, e.pitch))
        mean = np.mean(found, axis=0)
        throttles.append(float(mean[0]))
        leans.append(mean[1:])
    assert throttles[0] == pytest.approx(throttles[1], rel=0.01)
    np.testing.assert_allclose(leans[0], leans[1], atol=0.01)
    fleet.close()


def test_what_autotune_and_flowhold_hold_goes_along(hovering: Snapshot) -> None:
    fleet = Fleet("erle_copter", 1)
    fleet.put(0, hovering)
    v = fleet.view(0)
    t, hold, est = v.autopilot.modes.autotune, v.autopilot.modes.flowhold, v.autopilot.estimate
    t.hold_pos, t.heading = Vec2(est.pos.x + 3.0, est.pos.y), est.yaw + 0.5
    t.axis, t.backwards, t.start_angle = YAW, True, -est.yaw - 0.25
    hold.against_wind = Vec2(0.1, 0.0)
    angle = 1.5 - heading(v.physics.body.q)
    fleet.move(0, Move(300.0, -200.0, heading=1.5))
    c, s = math.cos(angle), math.sin(angle)
    away = t.hold_pos.x - est.pos.x, t.hold_pos.y - est.pos.y
    np.testing.assert_allclose(away, (3.0 * c, 3.0 * s), atol=1e-6)
    assert math.remainder(t.heading - est.yaw - 0.5, math.tau) == pytest.approx(0.0, abs=1e-9)
    assert math.remainder(t.start_angle + est.yaw + 0.25, math.tau) == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose((hold.against_wind.x, hold.against_wind.y), (0.1 * c, 0.1 * s), atol=1e-9)
    fleet.close()


def test_the_momentum_model_hovers_on_too() -> None:
    start = prepare("ardupilot_quad")
    fleet = Fleet("ardupilot_quad", 1)
    fleet.put(0, start)
    v = fleet.view(0)
    fleet.move(0, Move(properties={"mass": 1.2 * v.physics.airframe.mass}, wind=(4.0, 0.0, 0.0), heading=1.0))
    z = v.physics.body.pos.z
    fleet.advance(3.0)
    assert v.physics.body.pos.z == pytest.approx(z, abs=0.2) and np.linalg.norm(v.physics.body.vel) < 0.25
    fleet.close()


def test_gusts_blow_from_the_first_moment(hovering: Snapshot) -> None:
    fleet = Fleet("erle_copter", 200)
    fleet.put(range(200), hovering)
    fleet.move(range(200), [Move(wind=(0.0, 0.0, 1.5), seed=k) for k in range(200)])
    gusts = fleet.records["physics"]["wind"]["gust"]
    assert np.std(gusts) == pytest.approx(1.5, rel=0.15) and abs(np.mean(gusts)) < 0.3
    fleet.close()


def test_height_and_velocity(hovering: Snapshot) -> None:
    fleet = Fleet("erle_copter", 2)
    fleet.put((0, 1), hovering)
    fleet.move(1, Move(height=40.0, velocity=(2.0, -1.0, 0.5)))
    v = fleet.view(1)
    before, wrong = resets(v), error(v)
    np.testing.assert_allclose(v.physics.body.vel, (2.0, -1.0, 0.5), atol=1e-12)
    assert v.physics.body.pos.z == pytest.approx(-40.0)
    np.testing.assert_allclose(wrong, error(fleet.view(0)), atol=1e-9)
    assert v.autopilot.home.alt == fleet.view(0).autopilot.home.alt
    for _ in range(20):
        fleet.advance(0.1)
        assert max(variances(v)) < 0.3
    assert resets(v) == before and np.linalg.norm(error(v) - wrong) < 0.4
    fleet.advance(4.0)
    assert np.linalg.norm(v.physics.body.vel) < 0.4
    fleet.close()


def test_a_rover_rolls_on_at_the_speed_it_is_given() -> None:
    fleet = Fleet("erle_rover", 1)
    fleet.put(0, prepare("erle_rover"))
    fleet.move(0, Move(heading=1.0, velocity=(math.cos(1.0), math.sin(1.0), 0.0)))
    v, before = fleet.view(0), resets(fleet.view(0))
    assert v.autopilot.control.speed.forward == pytest.approx(1.0, abs=0.05)
    drive(fleet, (0,), 3.0, forward=1.0)
    assert np.linalg.norm(v.physics.body.pos) == pytest.approx(3.0, abs=0.5)
    assert resets(v) == before and max(variances(v)) < 0.3
    fleet.close()


# ---------------------------------------------------------------------- refusals

WRONG = {
    "copter": [
        (Move(north=math.nan), "north = nan"),
        (Move(east=math.inf), "east = inf"),
        (Move(north=2e5), "-100000 .. 100000 m"),
        (Move(heading=math.inf), "heading = inf"),
        (Move(height=-1.0), "height = -1.0"),
        (Move(velocity=(1.0, math.nan, 0.0)), "velocity east = nan"),
        (Move(velocity=(1.0, 2.0)), "three numbers"),  # type: ignore[arg-type]
        (Move(wind=(-1.0, 0.0, 0.0)), "wind_speed = -1.0"),
        (Move(wind=7.0), "three numbers"),  # type: ignore[arg-type]
        (Move(properties={"mass": -1.0}), "property mass = -1.0"),
        (Move(properties={"mass": math.nan}), "property mass = nan"),
        (Move(properties={"masss": 1.0}), "did you mean 'mass'"),
        (Move(properties={"substeps": 2.0}), "'substeps' cannot be changed"),
        (Move(properties={"mass": 30.0}), "does not hover"),
        (Move(properties={"thrust_coefficient": 1e-9}), "does not hover"),
    ],
    "rover": [
        (Move(height=2.0), "is not in the air"),
        (Move(velocity=(0.0, 1.0, 0.0), heading=0.0), "along its nose only"),
        (Move(north="1"), "north = '1'"),  # type: ignore[arg-type]
        (Move(properties={"mass": 0.0}), "property mass = 0.0"),
    ],
}


def test_the_old_name_of_the_properties_works_and_warns() -> None:
    with pytest.warns(SitlDeprecationWarning, match=r"Move\(figures=\).* use properties="):
        move = Move(3.0, figures={"mass": 1.3})  # type: ignore[call-arg]
    assert move == Move(3.0, properties={"mass": 1.3})
    with pytest.warns(SitlDeprecationWarning, match=r"Move\.figures"):
        assert move.figures == {"mass": 1.3}  # type: ignore[attr-defined]


def test_what_cannot_be_is_refused_and_changes_nothing(fleet: Fleet, kind: str, prepared: Snapshot) -> None:
    fleet.advance(0.3)
    before, ports = fleet.records.tobytes(), fleet.ports.tobytes()
    for move, complaint in WRONG[kind]:
        for snapshot in (None, prepared):
            with pytest.raises(OptionError, match=complaint):
                fleet.move((0, 2), [Move(5.0, 5.0), move], snapshot)
            assert fleet.records.tobytes() == before and fleet.ports.tobytes() == ports
    for which, moves in (((0, 0), Move()), ((0, 1), [Move()])):
        with pytest.raises(OptionError, match="moved once"):
            fleet.move(which, moves)
    with pytest.raises(OptionError, match="no vehicle 9"):
        fleet.move(9, Move())
    fleet.view(0).autopilot.modes.nav.mission_state = 1
    with pytest.raises(OptionError, match="flies a mission"):
        fleet.move(0, Move(north=1.0))


def test_a_place_in_a_solid_is_refused() -> None:
    fleet = Fleet("erle_rover", 1, world="maze_erlerover")
    before = fleet.records.tobytes()
    world = fleet.scenario.load_world()
    assert world is not None
    x, y, _ = world.solids[0].centre
    with pytest.raises(OptionError, match="would be in a solid of world 'maze_erlerover'"):
        fleet.move(0, Move(x, -y))
    assert fleet.records.tobytes() == before
    fleet.close()
