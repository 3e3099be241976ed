# SPDX-License-Identifier: BSD-3-Clause
"""An agent on a vehicle that may be real: it is taken over where it is, kept within limits, and left in a safe mode."""

from __future__ import annotations

import contextlib
import json
import math
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.core.algebra import euler_of
from sitl.envs import EnvOptionError, NotReadyError
from sitl.envs.actions import ATTITUDE, POSITION, RATES, VELOCITY
from sitl.envs.mavlink.guard import Guard, Watch, guard_of
from sitl.envs.targets.landing import Land
from tests.envs.test_reset_of_real_vehicles import COPTER, DISARM, REBOOT, RealVehicle, height, hovering

BRAKE, LOITER = 17, 5
STILL = np.zeros(4, np.float32)
pytestmark = pytest.mark.filterwarnings("ignore:.*clock cannot be held")


def environment(vehicle, **options):
    made = {"reset": "none", "patience": 2.0, "wait": 5.0, "setpoint": "velocity", "action": "normalised",
            "observation": "scan", "task": "wander", **options}  # fmt: skip
    return gym.make(COPTER, connection=f"udpout:127.0.0.1:{vehicle.port}", **made).unwrapped


def mode(simulation):
    return int(simulation.v.autopilot.modes.number)


def position(simulation):
    north, east, down = simulation.v.physics.body.pos
    return north, -east, -down


def test_a_copter_in_the_air_is_taken_over_flown_and_left_hovering():
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = environment(vehicle, guard={"late": 30.0})
        env.reset(seed=1)
        before = position(simulation)
        for _ in range(15):
            *_, truncated, info = env.step(np.array([0.2, 0.0, 0.0, 0.0], np.float32))
            assert not truncated
        assert "handed_over" not in info
        assert math.dist(position(simulation)[:2], before[:2]) > 0.5
        watch = env.robot._vehicles.watch
        env.close()
    assert [deed.what for deed in watch.deeds] == ["taken over", "handed over"]
    assert watch.deeds[-1].why == "closed"
    assert not {DISARM, REBOOT} & vehicle.commands()
    simulation.advance(5.0)
    assert mode(simulation) == BRAKE and simulation.v.autopilot.arming.armed == 1
    assert height(simulation) == pytest.approx(5.0, abs=0.7)


def test_return_flies_back_to_where_the_first_episode_began():
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = environment(vehicle, reset="return", guard={"late": 30.0})
        env.reset(seed=1)
        began = position(simulation)
        for _ in range(40):
            env.step(np.array([0.0, 0.4, 0.0, 0.0], np.float32))
        assert math.dist(position(simulation), began) > 3.0
        env.reset()
        assert math.dist(position(simulation), began) < 1.5
        env.close()
    assert not {DISARM, REBOOT} & vehicle.commands()


def asked_lean(simulation):
    """[deg]"""
    lean = euler_of(simulation.v.autopilot.control.attitude.target_q)
    return math.degrees(math.hypot(lean.roll, lean.pitch))


def test_return_takes_off_from_the_ground_where_velocities_asked_for_have_wound_up_a_lean():
    simulation = hovering()
    with RealVehicle(simulation, hidden=False, waits=True) as vehicle:
        env = environment(vehicle, reset="return", guard={"late": 60.0, "floor": -5.0}, wait=30.0)
        env.reset(seed=1)
        began = position(simulation)
        for _ in range(400):
            env.step(np.array([0.3, 0.0, -0.4, 0.0], np.float32))
            if asked_lean(simulation) > 15.0 and position(simulation)[2] < 0.05:
                break
        arming = simulation.v.autopilot.arming
        assert position(simulation)[2] < 0.05 and asked_lean(simulation) > 15.0 and not arming.landed
        env.reset()
        assert arming.armed and math.dist(position(simulation), began) < 1.5
        env.close()
    assert not {DISARM, REBOOT} & vehicle.commands()


def test_a_height_that_has_drifted_is_right_again_after_the_copter_has_stood_on_the_ground():
    simulation = hovering()
    with RealVehicle(simulation, hidden=False, waits=True) as vehicle:
        env = environment(vehicle, reset="return", guard={"late": 60.0, "floor": -5.0}, wait=30.0)
        env.reset(seed=1)
        vehicles = env.robot._vehicles
        drifted = (*vehicles._origin[:2], vehicles._origin[2] - 0.6)  # as if it were higher by so much
        vehicles._origin, env.robot._states[0] = drifted, replace(env.robot._states[0], origin=drifted)
        env.step(STILL)
        assert env.robot.pose[0, 2] - position(simulation)[2] == pytest.approx(0.6, abs=0.2)
        for _ in range(400):
            env.step(np.array([0.0, 0.0, -0.5, 0.0], np.float32))
            if position(simulation)[2] < 0.05:
                break
        env.reset()
        env.step(STILL)
        assert env.robot.pose[0, 2] - position(simulation)[2] == pytest.approx(0.0, abs=0.2)
        env.close()


@pytest.mark.parametrize("error", [0.25, -0.25])
def test_a_landing_ends_on_the_ground_whatever_the_error_of_the_height(error):
    simulation = hovering()
    task, guard = Land(offset=0.0, pad=3.0), {"late": 60.0, "floor": -5.0}
    with (
        RealVehicle(simulation, hidden=False, waits=True) as vehicle,
        contextlib.closing(environment(vehicle, task=task, guard=guard)) as env,
    ):
        env.reset(seed=1)
        state = env.robot._states[0]
        origin = (*state.origin[:2], state.origin[2] - error)
        env.robot._vehicles._origin, env.robot._states[0] = origin, replace(state, origin=origin)
        for _ in range(400):
            down = -0.4 if env.robot.pose[0, 2] > 0.2 else 0.0  # 0.8 m/s, by an agent that does not insist
            _, _, terminated, _, info = env.step(np.array([0.0, 0.0, down, 0.0], np.float32))
            if terminated:
                break
        assert terminated and info["is_success"], info
        assert simulation.v.autopilot.arming.landed and position(simulation)[2] < 0.03
        assert "put down" in [deed.what for deed in env.robot.watch.deeds]


def test_a_vehicle_that_is_put_down_stops_on_the_spot():
    simulation = hovering()
    task, guard = Land(offset=0.0, pad=9.0), {"late": 60.0, "floor": -5.0}
    with (
        RealVehicle(simulation, hidden=False, waits=True) as vehicle,
        contextlib.closing(environment(vehicle, task=task, guard=guard)) as env,
    ):
        env.reset(seed=1)
        put_down = None
        for _ in range(400):
            sideways = np.array([0.0, 0.1, -0.25, 0.0], np.float32)
            _, _, terminated, _, _ = env.step(sideways)
            if put_down is None and any(deed.what == "put down" for deed in env.robot.watch.deeds):
                put_down = position(simulation)
            if terminated:
                break
        assert terminated and put_down is not None
        assert math.dist(put_down[:2], position(simulation)[:2]) < 0.45  # level and sinking it would go on for 0.6 m


def test_what_is_not_ready_is_waited_for_and_said():
    simulation = hovering()
    simulation.bridge.autopilot.set_mode(BRAKE)
    with RealVehicle(simulation) as vehicle:
        env = environment(vehicle, wait=1.0)
        with pytest.raises(
            NotReadyError, match=r"no episode can begin within 1 s: it is in mode 17, not in GUIDED \(4\)"
        ):
            env.reset(seed=1)
        env.close()
    assert mode(simulation) == BRAKE and not {DISARM, REBOOT} & vehicle.commands()


def test_a_pilot_who_takes_it_has_it():
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = environment(vehicle, guard={"late": 30.0})
        env.reset(seed=1)
        env.step(STILL)
        simulation.bridge.autopilot.set_mode(LOITER)
        for _ in range(40):  # until a heartbeat says so
            *_, truncated, info = env.step(STILL)
            if truncated:
                break
        assert truncated and info["handed_over"] == "the vehicle is in mode 5: its pilot or a failsafe has it"
        sent = len([name for name, _ in vehicle.received if name == "SET_POSITION_TARGET_LOCAL_NED"])
        env.step(np.ones(4, np.float32))
        env.close()
        assert sent == len([name for name, _ in vehicle.received if name == "SET_POSITION_TARGET_LOCAL_NED"])
    assert mode(simulation) == LOITER


def test_an_agent_that_is_late_or_flies_out_is_stopped(tmp_path):
    simulation = hovering()
    log = tmp_path / "guard.jsonl"
    with RealVehicle(simulation) as vehicle:
        env = environment(vehicle, guard={"radius": 3.0, "late": 30.0, "log": log})
        env.reset(seed=1)
        began = position(simulation)
        for _ in range(60):
            *_, truncated, info = env.step(np.array([1.0, 0.0, 0.0, 0.0], np.float32))
            assert not truncated
        assert 1.5 < math.dist(position(simulation)[:2], began[:2]) < 4.5
        watch = env.robot._vehicles.watch
        watch._clock = lambda: 1e9
        *_, truncated, info = env.step(STILL)
        assert truncated and info["handed_over"].startswith("the agent is late")
        env.close()
    assert mode(simulation) == BRAKE
    lines = [json.loads(line) for line in log.read_text().splitlines()]
    assert [line["what"] for line in lines] == ["taken over", "limited", "handed over"]


def test_set_points_without_limits_are_for_simulators():
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        env = environment(vehicle, setpoint="rc")
        env.reset(seed=1)
        with pytest.raises(EnvOptionError, match="setpoint 'rc' is for simulators"):
            env.step(STILL)
        env.close()
    assert "RC_CHANNELS_OVERRIDE" not in {name for name, _ in vehicle.received}


def watch(**settings):
    clock = [0.0]
    made = Watch(Guard(**settings), True, lambda: clock[0])
    made.take_over(0.0, (0.0, 0.0, 5.0))
    return made, clock


def test_velocities_stay_within_speed_and_fence():
    w, _ = watch(radius=10.0, speed=3.0, climb=0.8, ceiling=8.0)
    inside = (0.0, 0.0, 5.0, 0.0)
    assert w.limited(VELOCITY, (1.0, 0.5, 0.2, 0.1), inside, 0.0) == [1.0, 0.5, 0.2, 0.1]
    fast = w.limited(VELOCITY, (30.0, 40.0, 9.0, 0.1), inside, 0.0)
    assert fast == pytest.approx([1.8, 2.4, 0.8, 0.1])
    edge = w.limited(VELOCITY, (3.0, 1.0, 1.0, 0.0), (9.9, 0.0, 7.9, 0.0), 0.0)
    assert 0.0 < edge[0] < 0.1 and 0.0 < edge[2] < 0.1
    home = w.limited(VELOCITY, (-3.0, 0.0, -1.0, 0.0), (9.9, 0.0, 7.9, 0.0), 0.0)
    assert home == pytest.approx([-3.0, 0.0, -0.8, 0.0])
    turned = w.limited(VELOCITY, (3.0, 0.0, 0.0, 0.0), (9.9, 0.0, 5.0, math.pi), 0.0)
    assert turned == pytest.approx([3.0, 0.0, 0.0, 0.0])


def test_positions_attitudes_and_others():
    w, _ = watch(radius=10.0, tilt=0.3, floor=1.0, ceiling=8.0)
    pose = (0.0, 0.0, 5.0, 0.0)
    assert w.limited(POSITION, (30.0, 40.0, 20.0, 0.5), pose, 0.0) == pytest.approx([6.0, 8.0, 8.0, 0.5])
    assert w.limited(ATTITUDE, (1.0, -1.0, 0.2, 0.0), pose, 0.0) == pytest.approx([0.3, -0.3, 0.2, 0.0])
    with pytest.raises(EnvOptionError, match="'rates' is for simulators"):
        w.limited(RATES, (0.0, 0.0, 0.0, 0.5), pose, 0.0)


def test_doubts():
    w, clock = watch(radius=10.0, late=0.5, ceiling=8.0)
    assert w.doubt((0.0, 0.0, 5.0, 0.0), (0.0,) * 4) == ""
    assert "no number" in w.doubt((0.0, 0.0, 5.0, 0.0), (math.nan, 0.0, 0.0, 0.0))
    assert "12.5 m away" in w.doubt((12.5, 0.0, 5.0, 0.0), (0.0,) * 4)
    assert "height of 10.1 m" in w.doubt((0.0, 0.0, 10.1, 0.0), (0.0,) * 4)
    w.stepped()
    clock[0] = 0.4
    assert w.doubt((0.0, 0.0, 5.0, 0.0), (0.0,) * 4) == ""
    clock[0] = 0.6
    assert "late" in w.doubt((0.0, 0.0, 5.0, 0.0), (0.0,) * 4)


@pytest.mark.parametrize(
    ("option", "says"),
    [
        ({"radius": -1.0}, r"Guard\(radius=-1.0\)"),
        ({"speed": math.nan}, r"Guard\(speed=nan\)"),
        ({"floor": 5.0, "ceiling": 4.0}, "the floor must be the lower one"),
        ({"fence": 3.0}, "there are radius, floor"),
        ("on", "guard = 'on'"),
        (True, "guard = True"),
    ],
)
def test_guards_that_cannot_be_are_refused(option, says):
    with pytest.raises(EnvOptionError, match=says):
        guard_of(option, True)


def test_a_simulator_needs_none_and_what_may_be_real_has_one():
    assert guard_of(None, True) is None and guard_of(None, False) == Guard() and guard_of(False, False) is None
