# SPDX-License-Identifier: BSD-3-Clause
"""From power-on to the first step of an episode, of a vehicle that answers as a test says: what it is asked, in which
order, and what is said when it refuses."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.bridge.dialect import message
from sitl.core.mavlink import MavResult
from sitl.envs.mavlink import preparation
from sitl.envs.mavlink.last_messages import ATTITUDE, ORIGIN, POSITION, SCAN, SECTORS
from sitl.errors import LinkLostError, NotReadyError

ACCEPTED, FAILED = MavResult.ACCEPTED, MavResult.FAILED
WANTED = message("WIND")


class Vehicle:
    """A link to one; ``answers``: results of commands by name, one after the other, the last one for ever."""

    name = "tcp:1"

    def __init__(self, exact: bool = False, **answers: Any) -> None:
        self.is_exact, self.simulation = exact, None
        self.answers = {name: list(results) for name, results in answers.items()}
        self.said: list[Any] = []
        self.paused: list[int] = []
        self.ran: list[int] = []
        self.parameters: list[Any] = []
        self.comes_back = True
        self.endpoint = SimpleNamespace(send=lambda name, **fields: self.said.append((name, fields)))
        self.inbox: Any = SimpleNamespace(
            system=7, was_rebooted=False, learned=None, parameters={}, acks={}, forgets=0, scan_kind=SCAN,
            scans_by_mavlink=True, scans_used=True, scans=0, wanted=(), reported=set(), position=[0.0] * 7,
            origin=(1, 2, 3), armed=True, mode=4, last_texts=[],
        )  # fmt: skip
        self.inbox.forget = self._forget

    def _forget(self) -> None:
        self.inbox.forgets += 1

    def command(self, name: str, *given: Any, **more: Any) -> int:
        self.said.append((name, given, more) if more else (name, given))
        results = self.answers.get(name, [ACCEPTED])
        found = results.pop(0) if len(results) > 1 else results[0]
        if isinstance(found, Exception):
            raise found
        return int(found)

    def parameter(self, name: str) -> float | None:
        return self.parameters.pop(0)  # type: ignore[no-any-return]

    def reopen(self) -> bool:
        return self.comes_back

    def pause(self, us: int) -> None:
        self.paused.append(us)

    def run(self, us: int) -> None:
        self.ran.append(us)
        self.inbox.scans += 1

    def commands(self, *names: str) -> list[Any]:
        return [said[1] for said in self.said if said[0] in names]


# ---------------------------------------------------------------- reboot


@pytest.mark.parametrize(("exact", "paused"), [(False, [1_000_000, 2_000_000]), (True, [0, 0])])
def test_a_reboot_disarms_and_waits_in_wall_time_alone(exact: bool, paused: list[int]) -> None:
    vehicle = Vehicle(exact)
    vehicle.inbox.parameters = {"MOT_THST_HOVER": 0.35}
    preparation.reboot(vehicle)  # type: ignore[arg-type]
    assert vehicle.said[0] == ("COMPONENT_ARM_DISARM", (), {"arm": 0, "force": 21196})
    assert vehicle.said[1] == ("PARAM_REQUEST_READ", {"param_index": -1, "target_system": 7, "target_component": 1,
                                                      "param_id": b"MOT_THST_HOVER"})  # fmt: skip
    assert vehicle.said[2] == ("PREFLIGHT_REBOOT_SHUTDOWN", (), {"autopilot": 1})
    assert (vehicle.paused, vehicle.inbox.forgets, vehicle.inbox.learned) == (paused, 1, 0.35)


@pytest.mark.parametrize(("learned", "put_back"), [(0.35, True), (None, False)])
def test_what_a_copter_learnt_in_flight_is_put_back_before_the_next_one(learned: Any, put_back: bool) -> None:
    vehicle = Vehicle()
    vehicle.inbox.was_rebooted, vehicle.inbox.learned = True, learned
    preparation.reboot(vehicle)  # type: ignore[arg-type]
    sent = [said for said in vehicle.said if said[0].startswith("PARAM")]
    assert [name for name, _ in sent] == (["PARAM_SET"] if put_back else [])
    assert not put_back or (sent[0][1]["param_value"], sent[0][1]["param_type"]) == (0.35, 9)


def test_one_that_refuses_cannot_be_reset() -> None:
    vehicle = Vehicle(PREFLIGHT_REBOOT_SHUTDOWN=[FAILED])
    with pytest.raises(NotReadyError, match=r"tcp:1: the vehicle refuses to reboot \(MAV_RESULT 4\), so it cannot be"):
        preparation.reboot(vehicle)  # type: ignore[arg-type]
    assert vehicle.inbox.forgets == 0 and vehicle.paused == [1_000_000]


@pytest.mark.parametrize(
    ("answer", "comes_back", "lost", "refused"),
    [(ACCEPTED, True, False, False), (ACCEPTED, False, True, False), (None, True, True, False),
     (FAILED, True, False, True)],
)  # fmt: skip
def test_one_that_closes_its_port_has_answered_before(answer: Any, comes_back: bool, lost: bool, refused: bool) -> None:
    vehicle = Vehicle(PREFLIGHT_REBOOT_SHUTDOWN=[LinkLostError("gone")])
    vehicle.comes_back = comes_back

    class Acks(dict[int, Any]):
        """An answer of before the reboot does not count; the last word comes with the end of the link."""

        def pop(self, *given: Any) -> Any:
            found = super().pop(*given)
            if answer is not None:
                self[given[0]] = SimpleNamespace(result=answer)
            return found

    vehicle.inbox.acks = Acks({preparation._REBOOT: SimpleNamespace(result=ACCEPTED)})
    if lost or refused:
        with pytest.raises(LinkLostError if lost else NotReadyError):
            preparation.reboot(vehicle)  # type: ignore[arg-type]
        return
    preparation.reboot(vehicle)  # type: ignore[arg-type]
    assert vehicle.inbox.forgets == 1


# ---------------------------------------------------------------- intervals


@pytest.mark.parametrize(
    ("wanted", "tried"),
    [
        (100_000, [100_000, 125_000, 150_000, 200_000]),
        (20_000, [20_000, 25_000, 30_000, 40_000]),
        (10_000, [10_000, 20_000, 25_000, 30_000, 40_000]),
    ],
)
def test_intervals_may_be_twice_as_long_or_40_ms(wanted: int, tried: list[int]) -> None:
    assert preparation._longer_ones(wanted) == tried


def asked(vehicle: Vehicle) -> list[Any]:
    return vehicle.commands("SET_MESSAGE_INTERVAL")


def test_position_attitude_scan_and_what_is_wanted_come_at_an_interval() -> None:
    vehicle = Vehicle()
    vehicle.inbox.wanted = (WANTED,)
    preparation.set_intervals(vehicle, 50_000)  # type: ignore[arg-type]
    assert asked(vehicle) == [(kind, 50_000) for kind in (POSITION.id, ATTITUDE.id, SCAN.id, WANTED.id)]


@pytest.mark.parametrize(("by_mavlink", "used"), [(False, True), (True, False)])
def test_scans_that_nobody_uses_are_not_asked_for(by_mavlink: bool, used: bool) -> None:
    vehicle = Vehicle()
    vehicle.inbox.scans_by_mavlink, vehicle.inbox.scans_used = by_mavlink, used
    preparation.set_intervals(vehicle, 50_000)  # type: ignore[arg-type]
    assert [number for number, _ in asked(vehicle)] == [POSITION.id, ATTITUDE.id]


def test_an_interval_that_is_taken_is_that_of_the_others_too() -> None:
    vehicle = Vehicle(SET_MESSAGE_INTERVAL=[FAILED, ACCEPTED, ACCEPTED])
    preparation.set_intervals(vehicle, 20_000)  # type: ignore[arg-type]
    assert asked(vehicle) == [(POSITION.id, 20_000), (POSITION.id, 25_000), (ATTITUDE.id, 25_000), (SCAN.id, 25_000)]


def test_in_exact_time_there_is_one_interval_and_a_refusal_is_named() -> None:
    vehicle = Vehicle(True, SET_MESSAGE_INTERVAL=[ACCEPTED, FAILED])
    vehicle.simulation = SimpleNamespace(bridge=SimpleNamespace(is_stepped=False))  # type: ignore[assignment]
    with pytest.raises(NotReadyError, match=r"tcp:1: the vehicle does not send ATTITUDE every 20 ms$"):
        preparation.set_intervals(vehicle, 20_000)  # type: ignore[arg-type]
    assert asked(vehicle) == [(POSITION.id, 20_000), (ATTITUDE.id, 20_000)]
    assert vehicle.simulation.bridge.is_stepped  # type: ignore[attr-defined]


@pytest.mark.parametrize(("result", "ok"), [(ACCEPTED, True), (FAILED, False)])
def test_a_vehicle_without_whole_scans_is_asked_for_sectors(result: int, ok: bool) -> None:
    vehicle = Vehicle(True, SET_MESSAGE_INTERVAL=[ACCEPTED, ACCEPTED, FAILED, result])
    if not ok:
        with pytest.raises(NotReadyError, match="OBSTACLE_DISTANCE every 100 ms; the environment's observation"):
            preparation.set_intervals(vehicle, 100_000)  # type: ignore[arg-type]
        return
    preparation.set_intervals(vehicle, 100_000)  # type: ignore[arg-type]
    assert asked(vehicle)[2:] == [(SCAN.id, 100_000), (SECTORS.id, 100_000)] and vehicle.inbox.scan_kind is SECTORS


@pytest.mark.parametrize(("used", "scans"), [(True, [SCAN.id]), (False, [])])
def test_what_was_lost_is_asked_for_again(used: bool, scans: list[int]) -> None:
    vehicle = Vehicle()
    vehicle.inbox.scans_used, vehicle.inbox.wanted = used, (WANTED,)
    preparation.request_again(vehicle)  # type: ignore[arg-type]
    assert vehicle.commands("REQUEST_MESSAGE") == [(POSITION.id,), (ATTITUDE.id,), *((k,) for k in scans), (WANTED.id,)]


# ---------------------------------------------------------------- modes and parameters


def test_a_mode_that_is_refused_is_named_with_what_was_said() -> None:
    preparation.set_mode(Vehicle(), 4)  # type: ignore[arg-type]
    vehicle = Vehicle(DO_SET_MODE=[FAILED])
    vehicle.inbox.last_texts.append("No position")
    with pytest.raises(NotReadyError, match="tcp:1: the vehicle refuses mode 4; it said: No position"):
        preparation.set_mode(vehicle, 4)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("values", "may_change", "sent", "ok"),
    [
        ([6.0], False, None, True),
        ([6.0], True, None, True),
        ([1.0, 5.0], True, 5.0, True),
        ([0.0, 4.0], True, 4.0, True),
        ([1.0, 1.0], True, 5.0, False),
        ([1.0], False, None, False),
        ([None], True, None, False),
    ],
)
def test_a_bit_of_a_parameter_is_set_where_the_vehicle_is_ours(
    values: list[Any], may_change: bool, sent: float | None, ok: bool
) -> None:
    vehicle, first = Vehicle(), values[0]
    vehicle.parameters = values
    if ok:
        preparation.set_bit(vehicle, "GUID_OPTIONS", 4, may_change)  # type: ignore[arg-type]
    else:
        error = f"tcp:1: GUID_OPTIONS is {first}; these set-points need its bit 4: set it on the vehicle"
        with pytest.raises(NotReadyError) as told:
            preparation.set_bit(vehicle, "GUID_OPTIONS", 4, may_change)  # type: ignore[arg-type]
        assert str(told.value) == error
    assert [fields["param_value"] for _, fields in vehicle.said] == ([] if sent is None else [sent])


# ---------------------------------------------------------------- to the first step


def prepared(vehicle: Vehicle, take_off: float = 0.0) -> list[str]:
    """What was commanded."""
    preparation.prepare(vehicle, 4, take_off, lambda: vehicle.said.append(("sticks", ())))  # type: ignore[arg-type]
    return [said[0] for said in vehicle.said if said[0] != "SET_MESSAGE_INTERVAL"]


def test_a_rover_is_armed_in_guided_with_its_sticks_at_rest() -> None:
    assert prepared(Vehicle()) == ["REQUEST_DATA_STREAM", "DO_SET_MODE", "COMPONENT_ARM_DISARM", "sticks"]


def test_it_is_asked_until_it_has_a_position_and_arms() -> None:
    vehicle = Vehicle(DO_SET_MODE=[FAILED, ACCEPTED], COMPONENT_ARM_DISARM=[FAILED, ACCEPTED])
    assert prepared(vehicle) == [
        "REQUEST_DATA_STREAM", "DO_SET_MODE", "DO_SET_MODE", "COMPONENT_ARM_DISARM", "DO_SET_MODE",
        "COMPONENT_ARM_DISARM", "sticks",
    ]  # fmt: skip
    vehicle = Vehicle()
    vehicle.inbox.position[1] = math.nan
    with pytest.raises(NotReadyError, match=r"tcp:1: the vehicle does not arm within 90 s"):
        prepared(vehicle)
    assert vehicle.commands("DO_SET_MODE") == []


@pytest.mark.parametrize(("down", "climb", "there"), [(-4.91, 0.0, True), (-4.89, 0.0, False), (-5.0, -0.09, True),
                                                      (-5.0, -0.11, False), (-5.11, 0.0, False)])  # fmt: skip
def test_a_copter_hovers_at_its_height_above_where_it_was_armed(
    down: float, climb: float, there: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked_for: list[bool] = []

    def until(link: Any, done: Any, step: int, what: str, **more: Any) -> None:
        if "climb" in what:
            assert what == "does not climb to 3 m"
            vehicle.inbox.position[3], vehicle.inbox.position[6] = down, climb
        asked_for.append(done())

    monkeypatch.setattr(preparation, "until", until)
    vehicle = Vehicle()
    vehicle.inbox.position[3] = -2.0
    assert "NAV_TAKEOFF" in prepared(vehicle, 3.0) and asked_for == [True, there]
    assert vehicle.said[6] == ("NAV_TAKEOFF", (), {"altitude": 3.0})


def test_a_take_off_that_is_refused_is_named() -> None:
    with pytest.raises(NotReadyError, match="tcp:1: the vehicle refuses to take off; it said nothing"):
        prepared(Vehicle(NAV_TAKEOFF=[FAILED]), 3.0)


def test_the_origin_is_asked_for_three_times() -> None:
    vehicle = Vehicle()
    vehicle.inbox.origin = None
    with pytest.raises(NotReadyError, match="the vehicle does not send GPS_GLOBAL_ORIGIN"):
        prepared(vehicle)
    assert vehicle.commands("REQUEST_MESSAGE") == [(ORIGIN.id,)] * 3


@pytest.mark.parametrize(("now_ms", "begins_s"), [(0, 6.0), (100, 6.0), (5_900, 6.0), (5_950, 12.0), (6_000, 12.0)])
def test_an_episode_of_exact_time_begins_at_a_multiple_of_six_seconds(now_ms: int, begins_s: float) -> None:
    vehicle = Vehicle(True)
    vehicle.inbox.position[0] = float(now_ms)
    prepared(vehicle)
    assert vehicle.ran[-1] == 100_000, "in which the sticks are heard and a scan comes"
    assert min(vehicle.ran) >= 0 and now_ms * 1000 + sum(vehicle.ran) == round(begins_s * 1e6)


def test_without_scans_or_reports_there_is_no_episode() -> None:
    vehicle = Vehicle()
    vehicle.run = lambda us: None  # type: ignore[method-assign, assignment]
    with pytest.raises(NotReadyError, match=r"the vehicle sends no scan \(LASER in DEBUG_FLOAT_ARRAY, or OBSTACLE"):
        prepared(vehicle)
    vehicle.inbox.scans_used = False
    prepared(vehicle)
    vehicle = Vehicle()
    vehicle.inbox.wanted = (WANTED,)
    with pytest.raises(NotReadyError, match="the vehicle takes the wish for WIND, but sends none"):
        prepared(vehicle)
    vehicle.inbox.reported = {WANTED}
    prepared(vehicle)


# ---------------------------------------------------------------- one that somebody else flies


@pytest.mark.parametrize(
    ("fields", "seconds", "error", "looks"),
    [
        ({}, 5.0, None, 1),
        ({"mode": 6}, 0.3, "no episode can begin within 0.3 s: it is in mode 6, not in GUIDED (4)", 3),
        ({"armed": False, "mode": 6}, 0.2, "no episode can begin within 0.2 s: it is disarmed", 2),
        ({"armed": False}, 0.0, "no episode can begin within 0 s: it is disarmed", 1),
    ],
)
def test_one_that_somebody_else_flies_is_waited_for(fields: Any, seconds: float, error: Any, looks: int) -> None:
    vehicle = Vehicle()
    vars(vehicle.inbox).update(fields)
    if error is None:
        preparation.join(vehicle, 4, False, seconds)  # type: ignore[arg-type]
    else:
        with pytest.raises(NotReadyError) as told:
            preparation.join(vehicle, 4, False, seconds)  # type: ignore[arg-type]
        assert f"tcp:1: {error}; it said nothing" == str(told.value)
    assert vehicle.paused == [100_000] * looks
    assert all(said[0] in ("SET_MESSAGE_INTERVAL", "REQUEST_MESSAGE") for said in vehicle.said), "and told nothing"
