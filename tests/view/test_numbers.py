# SPDX-License-Identifier: BSD-3-Clause
"""Each number beside the scene is the vehicle's, as a ground station gets it, or the truth, and says which."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl import Simulation
from sitl.bridge.dialect import message
from sitl.client import Client, Endpoint
from sitl.client.commands import command_number
from sitl.core.algebra import euler_of
from sitl.envs.page.source import EnvSource
from sitl.logs.track import Track
from sitl.logs.track_columns import NAMES
from sitl.simulation import Core
from sitl.view import horizon
from sitl.view.flight_page import state as state_of_flights
from sitl.view.flights import of_track
from sitl.view.frame import Frame
from sitl.view.live import LiveSource
from sitl.view.panel import state
from sitl.view.plots import whose

SEEDS = range(10)
MESSAGES = (
    "GLOBAL_POSITION_INT", "VFR_HUD", "LOCAL_POSITION_NED", "SYS_STATUS", "GPS_RAW_INT", "MISSION_CURRENT",
)  # fmt: skip


def rows(html: str) -> dict[str, tuple[str, str]]:
    """The vehicle's and the true number of each row."""
    cells = re.findall(r"<div[^>]*>([^<>]*)</div>", html)
    begin = cells.index("truth")
    assert cells[begin - 2 : begin + 1] == ["", "vehicle says", "truth"]
    found = [cells[k : k + 3] for k in range(begin + 1, begin + 16, 3)]
    return {name: (vehicle, true) for name, vehicle, true in found}


def fields(html: str) -> dict[str, str]:
    """What stands below."""
    cells = re.findall(r"<div[^>]*>([^<>]*)</div>", html)
    begin = cells.index("time")
    return dict(zip(cells[begin::2], cells[begin + 1 :: 2], strict=False))


def instrument(frame: Frame) -> list[str]:
    """The texts of the horizon: speed, height, heading, whose they are."""
    return re.findall(r"<text[^>]*>([^<]*)</text>", horizon.draw(frame))


def first(text: str) -> float:
    return float(text.split()[0].rstrip("°"))


def telemetry(simulation: Simulation, *names: str) -> dict[str, Any]:
    """What the vehicle answers to a ground station that asks for messages now."""
    station = Endpoint(system=253)
    simulation.bridge.add_link(station.link)
    for name in names:
        station.command(command_number("REQUEST_MESSAGE"), message(name).id, target=simulation.bridge.system)
    simulation.bridge.receive()
    return dict(station.receive())


def compare(simulation: Simulation, source: LiveSource) -> None:
    """Each number with its source."""
    frame = source.frame(source.capture())
    said = telemetry(simulation, *MESSAGES)
    position, hud, local = said["GLOBAL_POSITION_INT"], said["VFR_HUD"], said["LOCAL_POSITION_NED"]
    body, html = simulation.v.physics.body, state(frame, "1.0 x")
    shown, below = rows(html), fields(html)
    height = position.relative_alt * 1e-3
    assert shown["height"] == (horizon.number(height, 2, "m"), horizon.number(-body.pos.z, 2, "m"))
    assert shown["ground speed"][0] == horizon.number(hud.groundspeed, 1, "m/s")
    assert first(shown["ground speed"][1]) == pytest.approx(math.hypot(body.vel.x, body.vel.y), abs=0.051)
    assert first(shown["climb"][0]) == pytest.approx(hud.climb, abs=0.051)
    assert first(shown["climb"][1]) == pytest.approx(-body.vel.z, abs=0.051)
    assert first(shown["heading"][0]) == hud.heading
    yaw = math.degrees(euler_of(body.q).yaw) % 360.0
    assert first(shown["heading"][1]) == round(yaw) % 360
    assert shown["position"][0] == f"{horizon.number(local.x, 1, 'N')}, {horizon.number(local.y, 1, 'E')}"
    assert shown["position"][1] == f"{horizon.number(body.pos.x, 1, 'N')}, {horizon.number(body.pos.y, 1, 'E')}"
    assert first(below["battery (vehicle)"]) == pytest.approx(said["SYS_STATUS"].voltage_battery * 1e-3, abs=0.051)
    assert below["GPS (vehicle)"] == f"3D, {said['GPS_RAW_INT'].satellites_visible} sat"
    assert below["item (vehicle)"] == str(said["MISSION_CURRENT"].seq)
    wind = simulation.v.physics.wind.vel
    assert first(below["wind (truth)"]) == pytest.approx(math.hypot(wind.x, wind.y), abs=0.051)
    assert instrument(frame) == [
        horizon.number(hud.groundspeed, 1, "m/s"), horizon.number(height, 1, "m"),
        f"{hud.heading:03d}°", "vehicle's estimate",
    ]  # fmt: skip


@pytest.mark.parametrize("seed", SEEDS)
def test_each_number_is_its_sources_on_the_ground_and_in_the_air(core: Core, seed: int) -> None:
    simulation = Simulation("erle_copter", core=core, seed=seed, params={"SIM_WIND_SPD": 3.0})
    source = LiveSource(simulation)
    client = Client(simulation)
    client.wait_ready()
    compare(simulation, source)
    client.take_off(10.0)
    client.set_velocity(3.0, 1.0)
    client.delay(3.0)
    compare(simulation, source)


def test_a_rovers_too() -> None:
    simulation = Simulation("erle_rover", seed=2, params={"SIM_WIND_SPD": 3.0})
    source = LiveSource(simulation)
    client = Client(simulation)
    client.wait_ready()
    client.arm()
    client.set_mode("GUIDED")
    client.set_velocity(1.0, 0.5)
    client.delay(4.0)
    compare(simulation, source)


def test_what_the_arming_checks_find_is_said(core: Core) -> None:
    simulation = Simulation("erle_copter", core=core, seed=3, params={"BATT_ARM_VOLT": 30.0})
    client, source = Client(simulation), LiveSource(simulation)
    simulation.advance(60.0)
    before = simulation.fleet.tobytes()
    frame = source.frame(source.capture())
    assert "not ready to arm: Battery 1 below minimum arming voltage" in state(frame, "1")
    assert simulation.fleet.tobytes() == before
    client.params["BATT_ARM_VOLT"] = 0.0
    client.delay(2.0)
    assert "not ready" not in state(source.frame(source.capture()), "1")


def test_without_an_autopilot_there_is_only_the_truth() -> None:
    simulation = Simulation("erle_copter", seed=3)
    source = LiveSource(simulation)
    frame = source.frame(source.capture())
    frame = replace(frame, reported=None)
    assert all(vehicle == "-" and true != "-" for vehicle, true in rows(state(frame, "1")).values())
    assert instrument(frame)[-1] == "truth"


def test_a_flights_numbers_are_those_of_its_log() -> None:
    t = np.arange(0.0, 10.01, 0.1)
    data = np.zeros((len(t), len(NAMES)))
    for name, value in (("t", t), ("north", 2.0 * t), ("down", -3.0), ("vn", 2.0), ("yaw", 1.0)):
        data[:, NAMES.index(name)] = value
    flight = of_track("one", Track("copter", data))
    frame = flight.frame(3.0)
    html = state_of_flights([flight], [frame], 3.0)
    assert "as logged" in html and "above home" in html and "<td>3.0 m</td>" in html and "<td>2.0 m/s</td>" in html
    assert instrument(frame) == ["2.0 m/s", "3.0 m", "057°", "as logged"]


def test_a_plot_says_whose_signal_it_has() -> None:
    names = ("ATTITUDE.roll", "autopilot.estimate.pos[2]", "physics.body.pos[2]", "reward")
    assert [whose(name) for name in names] == [" (vehicle)", " (vehicle)", " (truth)", ""]


def test_an_environments_place_is_the_truth() -> None:
    env = gym.make("GazeboCircuit2TurtlebotLIDAR-v0")
    env.reset(seed=1)
    session = env.unwrapped.session  # type: ignore[attr-defined]
    source = EnvSource(session, "circuit")
    facts = dict(source.frame(source.capture()).facts)
    x, y, z = session.robot.true_state()[0, :3]
    assert facts["position (truth)"] == f"{x:.2f}, {y:.2f}, {z:.2f} m" and "speed (truth)" in facts
    env.close()
