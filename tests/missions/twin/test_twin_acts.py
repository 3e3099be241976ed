# SPDX-License-Identifier: BSD-3-Clause
"""What a twin does at a moment of a log: wind, parameters, missions, open segments in step, its end; nothing flies."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.params.parm_files import ParameterError
from sitl.core.constants import TICK_US
from sitl.core.vectors import Vec2, Vec3
from sitl.drop_in.stick_port import FOR_EVER_US
from sitl.missions.twin import log_flight
from sitl.missions.twin.agreement import Window
from sitl.missions.twin.inputs import Inputs, Message, Mode, Wind
from sitl.missions.twin.legs import Begun, Item
from sitl.missions.twin.log_flight import Change, Segments, TwinFlight, _Listener
from sitl.missions.twin.state import LoggedState, Series


class Vehicle:
    """As much of a simulation and its client as a twin acts on; its clock runs by steps of 20 ms."""

    def __init__(self, flies: bool = True) -> None:
        self.time_us = 0
        self.kind = SimpleNamespace(flies=flies, name="copter" if flies else "rover")
        self.set: list[tuple[str, float]] = []
        self.said: list[Any] = []
        self.refuse = ""
        self.bridge = SimpleNamespace(system=7, report=lambda what: self.said.append(("report", what)))
        self.parameters = self
        self.parameter_changed = lambda name: self.said.append(("changed", name))
        self.v = SimpleNamespace(sensors=SimpleNamespace(rc_channels=[0] * 8, rc_count=3, rc_time_us=0))
        self.firmware = SimpleNamespace(mode_names={0: "STABILIZE", 5: "LOITER"})
        self.armed, self.disarms_us = True, 10**12
        self.texts: list[tuple[float, int, str]] = []
        self.connection = SimpleNamespace(endpoint=self)
        self.begins: list[tuple[int, str]] = []
        self.listener = SimpleNamespace(texts=[])

    def update(self, values: dict[str, float]) -> None:
        if self.refuse in values:
            raise ParameterError(f"{self.refuse} is refused")
        self.set += values.items()

    def command(self, *given: Any, **more: Any) -> None:
        self.said.append((given, more))

    def send(self, name: str, **fields: Any) -> None:
        self.said.append((name, fields))

    def step(self, until_us: int | None = None) -> None:
        self.time_us += 20_000 if until_us is None else min(20_000, until_us - self.time_us)
        self.armed = self.armed and self.time_us < self.disarms_us
        self.listener.texts[:] = [(at, text) for at, text in self.begins if at <= self.time_us]

    def passes(self, done: Callable[[], bool], seconds: float) -> bool:
        end = self.time_us + round(seconds * 1e6)
        while not done() and self.time_us < end:
            self.step()
        return done()


def flight(vehicle: Vehicle, inputs: Inputs | None = None, change: Change | None = None, items: Any = (),
           length: float = 10.0, whole: bool = True) -> Any:  # fmt: skip
    """A flight that was armed at 30 s."""
    found: Any = object.__new__(TwinFlight)
    found.simulation = found.station = vehicle
    vehicle.time_us = max(vehicle.time_us, 30_000_000)
    found.inputs, found.change, found.changes, found.segments = inputs or Inputs(), change or Change(), (), None
    found.log = SimpleNamespace(name="a.bin", kind="copter", span=SimpleNamespace(length=length, is_whole=whole))
    found.notes, found.opened, found._items, found._state = [], [], list(items), None
    found._armed_us, found._shift_us, found._listener = 30_000_000, 0, vehicle.listener
    found._position = Vec3(0.0, 0.0, 0.0)
    return found


# ---------------------------------------------------------------- acts


def test_wind_is_the_simulators_parameters() -> None:
    vehicle = Vehicle()
    flight(vehicle)._follow_wind(Wind(3.0, 4.5, 270.0))
    assert vehicle.set == [("SIM_WIND_SPD", 4.5), ("SIM_WIND_DIR", 270.0)]
    assert vehicle.said == [("changed", "SIM_WIND_SPD"), ("changed", "SIM_WIND_DIR")]


def test_wind_that_is_refused_is_noted_and_the_rest_is_taken() -> None:
    vehicle = Vehicle()
    vehicle.refuse = "SIM_WIND_SPD"
    found = flight(vehicle)
    found._blow(99.0, 90.0)
    assert found.notes == ["SIM_WIND_SPD is refused"] and vehicle.set == [("SIM_WIND_DIR", 90.0)]


@pytest.mark.parametrize(("wind", "notes"), [(None, []), ((5.0, 90.0), ["wind has no effect on a rover"])])
def test_wind_that_moves_nothing_is_told_where_it_was_asked_for(wind: Any, notes: list[str]) -> None:
    vehicle = Vehicle(flies=False)
    found = flight(vehicle, change=Change(wind=wind))
    found._blow(5.0, 90.0)
    assert found.notes == notes and vehicle.set == []


def test_parameters_and_messages_are_a_ground_stations_to_this_vehicle() -> None:
    vehicle = Vehicle()
    found = flight(vehicle)
    found._set("RTL_ALT", 900.0)
    found._send(Message(1.0, "SET_MODE", {"custom_mode": 3}))
    assert vehicle.said == [
        ("PARAM_SET", {"target_system": 7, "target_component": 1, "param_id": b"RTL_ALT", "param_value": 900.0,
                       "param_type": 9}),
        ("SET_MODE", {"target_system": 7, "target_component": 1, "custom_mode": 3}),
    ]  # fmt: skip


@pytest.mark.parametrize(("number", "asked"), [(5, True), (0, True), (99, False)])
def test_a_mode_that_the_autopilot_lacks_is_not_asked_for(number: int, asked: bool) -> None:
    vehicle = Vehicle()
    flight(vehicle)._ask_mode(number)
    assert vehicle.said == ([((176, 1.0, float(number)), {"target": 7})] if asked else [])


def test_a_mission_that_is_not_taken_is_noted() -> None:
    vehicle: Any = Vehicle()
    vehicle.firmware.commands = SimpleNamespace(taken={16: None})
    vehicle.sequencer = SimpleNamespace(set_mission=lambda v, mission: ("taken", len(mission.items)))
    found = flight(vehicle)
    found._upload((MissionItem(16, 0), MissionItem(16, 3), MissionItem(16, 3)))
    assert vehicle.said == [("report", ("taken", 3))] and found.notes == []
    found._upload((MissionItem(16, 0), MissionItem(9999, 3)))
    assert len(vehicle.said) == 1 and found.notes[0].startswith("the mission is not taken: ")


def test_a_receiver_is_heard_for_ever_and_counts_its_frames() -> None:
    vehicle = Vehicle()
    found, sensors = flight(vehicle), vehicle.v.sensors
    found._hear([])
    assert (sensors.rc_count, sensors.rc_time_us) == (3, 0)
    found._hear([1100, 1200])
    assert (sensors.rc_channels, sensors.rc_count) == ([1100, 1200, *[0] * 6], 4)
    assert sensors.rc_time_us == FOR_EVER_US
    found._hear(range(1000, 1012))
    assert sensors.rc_channels == list(range(1000, 1008)), "as many as there are"


def test_texts_are_kept_with_their_times() -> None:
    vehicle: Any = Vehicle()
    vehicle.time_us = 5_000
    listener = _Listener(vehicle)
    listener.said(6, "Mission: 1 Takeoff")
    listener.reached(3)
    listener.parameter_set("RTL_ALT")
    listener.commanded({}, 0, False, None, 0)
    assert listener.texts == [(5_000, "Mission: 1 Takeoff")]


# ---------------------------------------------------------------- before arming


@pytest.mark.parametrize(
    ("logged", "armed"),
    [
        (45.0, 45.0),
        (30.5, 30.5),
        (30.4, 32.0),  # hardly time to prepare it
        (12.0, 32.0),
        (90.0, 90.0),
        (90.1, 32.0),  # its vehicle waited for more than a minute longer
    ],
)
def test_it_arms_as_long_after_power_on_as_the_logs_vehicle_or_soon(logged: float, armed: float) -> None:
    vehicle = Vehicle()
    found = flight(vehicle)
    found.log.span.armed = logged
    found._wait()
    assert found._armed_us == round(armed * 1e6) and vehicle.time_us == found._armed_us - 200_000


@pytest.mark.parametrize(
    ("change", "wind"),
    [(None, [("SIM_WIND_SPD", 3.0), ("SIM_WIND_DIR", 90.0)]),
     ((6.0, 10.0), [("SIM_WIND_SPD", 6.0), ("SIM_WIND_DIR", 10.0)])],
)  # fmt: skip
def test_mission_mode_and_wind_are_as_they_were_at_arming(change: Any, wind: Any, monkeypatch: Any) -> None:
    taken: list[Any] = []
    monkeypatch.setattr(TwinFlight, "_upload", lambda self, items: taken.append(items))
    vehicle = Vehicle()
    inputs = Inputs(missions=[(-5.0, ("a",)), (0.0, ("b",)), (0.1, ("c",))],
                    wind=[Wind(0.0, 3.0, 90.0), Wind(5.0, 9.0, 0.0)],
                    modes=[Mode(-1.0, 5, True), Mode(4.0, 0, True)])  # fmt: skip
    found = flight(vehicle, inputs, Change(wind=change))
    found._armed_us = 31_000_000
    found._prepare()
    assert taken == [("a",), ("b",)] and vehicle.set == wind and vehicle.time_us == 31_000_000
    assert [said for said in vehicle.said if said[0] != "changed"] == [((176, 1.0, 5.0), {"target": 7})]


# ---------------------------------------------------------------- in step

MISSION = [Begun(1.0, Item(1, 1)), Begun(4.0, Item(2, 1)), Begun(8.0, Item(3, 1))]


def begins(*at: tuple[float, int]) -> Vehicle:
    """A vehicle whose items of the mission begin so long after arming [s]."""
    vehicle = Vehicle()
    vehicle.begins = [(30_000_000 + round(t * 1e6), f"Mission: {number} WP") for t, number in at]
    return vehicle


@pytest.mark.parametrize(
    ("at", "time", "shift", "now"),
    [
        ([], 0.5, 0.0, 0.5),  # neither has begun
        ([(1.0, 1)], 2.0, 0.0, 2.0),
        ([(1.5, 1)], 2.0, 0.5, 2.5),  # half a second late on the same item
        ([(0.8, 1)], 2.0, -0.2, 2.0),  # early: its time has passed already
        ([(1.0, 1), (4.6, 2)], 4.2, 0.6, 4.8),  # waits for an item that it has not come to
        ([(1.0, 1), (3.0, 2)], 3.5, -1.0, 3.5),  # ahead of the log
    ],
)
def test_time_counts_from_the_item_that_both_are_flying(at: Any, time: float, shift: float, now: float) -> None:
    vehicle = begins(*at)
    found = flight(vehicle, items=MISSION)
    vehicle.time_us += round(time * 1e6) - 20_000
    vehicle.step()
    found._fall_in_step(time)
    assert found._shift_us == round(shift * 1e6) and found._shift_us % TICK_US == 0
    assert found._since_arming_s == pytest.approx(now, abs=1e-6)


def test_a_twin_that_does_not_come_to_an_item_is_waited_for_three_seconds() -> None:
    vehicle = begins((1.0, 1))
    found = flight(vehicle, items=MISSION)
    vehicle.time_us += 4_480_000
    vehicle.step()
    found._fall_in_step(4.5)
    assert found._since_arming_s == pytest.approx(7.5, abs=0.03) and found._shift_us == 0


def test_nobody_waits_for_a_vehicle_that_is_disarmed() -> None:
    vehicle = begins((1.0, 1))
    found = flight(vehicle, items=MISSION)
    vehicle.time_us += 4_480_000
    vehicle.disarms_us = vehicle.time_us + 100_000
    vehicle.step()
    found._fall_in_step(4.5)
    assert found._since_arming_s < 4.7


class State:
    def __init__(self) -> None:
        self.put_at: list[Any] = []
        self.driven_at: list[float] = []

    def put(self, simulation: Any, time: float, position: Any, driven: bool) -> None:
        self.put_at.append((round(time, 3), driven))

    def drive(self, simulation: Any, time: float) -> None:
        self.driven_at.append(time)


def test_a_segment_is_put_driven_or_passed_over() -> None:
    vehicle = Vehicle()
    found = flight(vehicle)
    found._state, found.segments = State(), Segments((), driven=True)
    found._segment((2.0, None))
    found._segment((2.5, Window(2.5, 4.5)))
    assert found._state.driven_at == [2.0] and found._state.put_at == [(2.5, True)]
    assert found.opened == [Window(2.5, 4.5, 0.0)]
    vehicle.armed = False
    found._segment((3.0, None))
    found._segment((3.0, Window(3.0, 5.0)))
    assert len(found._state.driven_at) == len(found._state.put_at) == len(found.opened) == 1, "nobody flies"


@pytest.mark.parametrize(("ahead", "opened"), [(0.0, 2.0), (0.5, 2.5), (0.98, 2.98), (1.02, None)])
def test_of_a_segment_at_least_half_must_be_left(ahead: float, opened: float | None) -> None:
    """A twin that is ahead begins it later, by the log's time."""
    vehicle = begins((1.0 - ahead, 1))
    found = flight(vehicle, items=MISSION)
    found._state, found.segments = State(), Segments(())
    vehicle.time_us += 1_980_000
    vehicle.step()
    found._segment((2.0, Window(2.0, 4.0)))
    assert found._state.put_at == ([] if opened is None else [(opened, False)])
    assert [(round(w.begin, 3), w.end, round(w.shift, 3)) for w in found.opened] == (
        [] if opened is None else [(opened, 4.0, -ahead)]
    )


# ---------------------------------------------------------------- the end


@pytest.mark.parametrize(
    ("disarms", "notes", "until"),
    [
        (9.0, [], 10.0),
        (10.05, [], 10.06),
        (10.5, ["the twin is disarmed 0.5 s later than the log's vehicle"], 10.5),
        (99.0, ["the twin is still armed 20 s after the log's vehicle was disarmed"], 30.0),
    ],
)
def test_a_copter_has_time_to_land(disarms: float, notes: list[str], until: float) -> None:
    vehicle = Vehicle()
    vehicle.disarms_us = 30_000_000 + round(disarms * 1e6)
    found = flight(vehicle)
    found._end()
    assert found.notes == notes and found._since_arming_s == pytest.approx(until, abs=0.03)


def test_a_rover_is_disarmed_and_a_log_that_ends_in_the_air_ends_there() -> None:
    vehicle = Vehicle(flies=False)
    flight(vehicle)._end()
    assert vehicle.said == [((400, 0.0), {"target": 7})]
    vehicle = Vehicle()
    found = flight(vehicle, whole=False)
    found._end()
    assert (found.notes, found._since_arming_s) == ([], 10.0)
    found = flight(Vehicle())
    found._state = State()
    found._end()
    assert (found.notes, found._since_arming_s) == ([], 10.0), "of open segments nothing is to be told"


@pytest.mark.parametrize(("count", "more"), [(1, ""), (4, ""), (5, " (and 1 more)"), (7, " (and 3 more)")])
def test_four_warnings_since_arming_are_named(count: int, more: str) -> None:
    vehicle = Vehicle()
    vehicle.disarms_us = 39_000_000
    vehicle.texts = [(29.9, 2, "PreArm: x"), (35.0, 5, "a notice"), (35.0, 6, "Mission: 1")]
    vehicle.texts += [(30.0 + k, 4 - k % 3, f"warning {k}") for k in range(count)]
    found = flight(vehicle)
    found._end()
    shown = "; ".join(f"{k}.0 s: warning {k}" for k in range(min(count, 4)))
    assert found.notes == [f"the twin says: {shown}{more}"]


def test_what_makes_a_flight_comes_in_its_order(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    monkeypatch.setattr(log_flight, "open_dataflash", lambda simulation, path: done.append(f"log {path}"))
    for name in ("stand_by", "_arm", "_end"):
        monkeypatch.setattr(TwinFlight, name, lambda self, name=name: done.append(name))
    monkeypatch.setattr(TwinFlight, "_timeline", lambda self: [(2_000_000, lambda: done.append("act"))])
    vehicle: Any = Vehicle()
    vehicle.bridge.listeners = []
    found = flight(vehicle)
    found.path = Path("twin.bin")
    found.fly()
    assert done == ["log twin.bin", "stand_by", "_arm", "act", "_end"] and vehicle.time_us == 32_000_000
    assert vehicle.bridge.listeners == [], "texts are heard for open segments of a mission alone"
    found._items = MISSION
    found.fly()
    assert vehicle.bridge.listeners == [found._listener]


# ---------------------------------------------------------------- states


def state(**given: Any) -> Any:
    found: Any = object.__new__(LoggedState)
    found.start, found.motors, found.position = np.array([1.0, 2.0, 3.0]), None, [None, None, None]
    vars(found).update(given)
    return found


def targets(pos: float, vel: float) -> Series:
    return Series(np.array([0.0, 10.0]), np.array([[pos, vel, 0.0]] * 2))


def controllers() -> Any:
    return SimpleNamespace(
        pos_ne=SimpleNamespace(pos_desired=Vec2(5.0, 6.0), vel_desired=Vec2(1.0, 2.0)),
        pos_d=SimpleNamespace(pos_desired=-7.0, vel_desired=0.5),
    )


def test_a_vehicle_is_put_as_far_from_its_own_target_as_the_logs_was_from_its() -> None:
    """The log's targets are 5.5 - 1 m north, 6 - 2 m east, and its start is 3 m down."""
    found = state(position=[targets(5.5, 0.75), targets(8.0, 2.0), targets(-4.5, 0.0)])
    wanted = np.zeros(6)
    assert found._follow_targets(controllers(), 9.9, wanted) == (True, True)
    assert wanted.tolist() == pytest.approx([0.5, 0.0, 0.5, 0.25, 0.0, 0.5])


@pytest.mark.parametrize(
    ("north", "down", "time", "follows"),
    [
        (targets(7.99, 1.0), targets(-4.0, 0.5), 5.0, (False, False)),  # no sample is near
        (targets(7.99, 1.0), targets(-4.0, 0.5), 10.0, (True, True)),
        (targets(8.0, 1.0), targets(-4.0, 0.5), 10.0, (False, True)),  # 2 m are not the same point
        (targets(4.0, 1.0), targets(-4.0, 0.5), 10.0, (False, True)),
        (targets(6.0, 2.0), targets(-4.0, 0.5), 10.0, (False, True)),  # nor is 1 m/s
        (targets(6.0, 1.99), targets(-6.0, 0.5), 10.0, (True, False)),
        (targets(6.0, 1.0), None, 10.0, (True, False)),
        (None, targets(-4.0, -0.49), 10.0, (False, True)),
        (targets(6.0, 1.0), targets(-4.0, 1.5), 10.0, (True, False)),
    ],
)
def test_targets_of_another_point_of_the_path_are_not_followed(
    north: Any, down: Any, time: float, follows: Any
) -> None:
    wanted = np.zeros(6)
    found = state(position=[north, targets(8.0, 2.0), down])
    assert found._follow_targets(controllers(), time, wanted) == follows
    assert follows[0] or wanted[[0, 1, 3, 4]].tolist() == [0.0] * 4
    assert follows[1] or wanted[[2, 5]].tolist() == [0.0] * 2


def rotors(output: Any = (2, 0, 1), pwm: tuple[float, float] = (1000.0, 2000.0), low: float = 0.0, high: float = 1.0,
           share: float = 1.0) -> Any:  # fmt: skip
    physics = SimpleNamespace(
        rotors=SimpleNamespace(share=[share] * 3, command=[9.0] * 3, speed=[9.0] * 3),
        airframe=SimpleNamespace(speed_max=800.0, rotor_count=3, control_min=low, control_max=high),
    )
    params = SimpleNamespace(MOT=SimpleNamespace(PWM_MIN=pwm[0], PWM_MAX=pwm[1]))
    control = SimpleNamespace(motors=SimpleNamespace(output=output))
    return SimpleNamespace(
        v=SimpleNamespace(physics=physics, autopilot=SimpleNamespace(params=params, control=control))
    )


MOTORS = Series(np.array([0.0, 1.0]), np.array([[50.0, 0.0, 100.0], [50.0, 0.0, 100.0]]))


@pytest.mark.parametrize(
    ("given", "command"),
    [
        ({}, [0.0, 1.0, 0.5]),  # motor 1 is rotor 3, motor 2 is rotor 1
        ({"pwm": (1100.0, 1900.0)}, [0.1, 0.9, 0.5]),
        ({"pwm": (0.0, 0.0)}, [0.0, 1.0, 0.5]),  # MOT_PWM_MIN and MAX of 0: 1000 to 2000
        ({"low": 0.25, "high": 0.75}, [0.0, 1.0, 0.5]),
        ({"share": 0.5}, [0.0, 0.5, 0.25]),  # a rotor that has failed in part
        ({"output": (0, -1, 3)}, [0.5, 9.0, 9.0]),  # outputs that turn no rotor
    ],
)
def test_rotors_are_commanded_as_the_logs_motors_were(given: Any, command: list[float], monkeypatch: Any) -> None:
    from sitl.missions.twin import state as states

    monkeypatch.setattr(states, "speed_at_full", lambda physics: 700.0)
    simulation = rotors(**given)
    found = state(motors=MOTORS)
    found.drive(simulation, 0.5)
    turning = simulation.v.physics.rotors
    assert turning.command == pytest.approx(command) and turning.speed == [9.0] * 3
    found.drive(simulation, 0.5, at_once=True)
    assert turning.speed == pytest.approx([x if x == 9.0 else min(800.0 * x, 700.0) for x in command])


def test_a_log_without_motors_drives_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    simulation = rotors()
    state().drive(simulation, 0.5, at_once=True)
    assert simulation.v.physics.rotors.command == [9.0] * 3
