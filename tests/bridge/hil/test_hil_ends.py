# SPDX-License-Identifier: BSD-3-Clause
"""The two ends of the link as machines of bytes: lockstep, repetitions, other worlds, numbers that cannot be right."""

from __future__ import annotations

import math
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter
from sitl.bridge.hil import controls, sensor, truth
from sitl.bridge.hil.autopilot_end import ELSEWHERE, TAKEN, WAITING
from sitl.bridge.hil.controls import (
    ALIKE,
    LATE,
    LONGEST_WAIT_S,
    SHORTEST_WAIT_S,
    SILENT,
    SILENT_ARMED,
    START_US,
    TRUSTED,
    Controls,
    ForeignClock,
)
from sitl.bridge.hil.protocol import Sender
from sitl.core.records import first_difference
from tests.bridge.hil.hil_bench import Bench

PX4 = 12


def names(data: bytes) -> list[str]:
    return [frame.kind.name for frame in Splitter().feed(data)]


def decoded(data: bytes, name: str):
    return [frame.kind.decode(frame.payload) for frame in Splitter().feed(data) if frame.kind.name == name]


@pytest.fixture
def bench() -> Bench:
    bench = Bench()
    assert bench.join() == TAKEN
    return bench


def test_joining_takes_the_state_and_no_time(bench: Bench) -> None:
    assert bench.there.time_us == 0 and bench.physics.log == []
    assert first_difference(bench.autopilot.fleet[1]["sensors"], bench.physics.fleet[1]["sensors"]) is None


def test_each_answer_is_one_tick(bench: Bench) -> None:
    for k in range(100):
        assert bench.tick(0.01 * k) == TAKEN
        assert bench.autopilot.v.time_us == bench.physics.v.time_us == 2500 * (k + 1)
        assert bench.autopilot.v.tick == k + 1
    assert bench.physics.log == [round(0.01 * k, 6) for k in range(100)]
    assert first_difference(bench.autopilot.fleet[1]["sensors"], bench.physics.fleet[1]["sensors"]) is None


def test_a_repeated_answer_is_not_flown_twice(bench: Bench) -> None:
    answer = bench.here.controls()
    first = bench.there.feed(answer)
    assert bench.there.feed(answer) == first
    assert bench.there.ticks == bench.there.repeated == 1
    assert bench.here.feed(first) == TAKEN
    assert bench.here.feed(first) == WAITING  # the same tick again
    assert bench.here.repeated == 1 and bench.autopilot.v.time_us == 2500


def test_controls_stay_the_same_until_they_are_answered(bench: Bench) -> None:
    first = bench.here.controls()
    bench.autopilot.v.actuators.controls[0] = 0.7
    assert bench.here.controls() == first
    bench.here.feed(bench.there.feed(first))
    assert bench.here.controls() != first


def test_a_link_lost_before_and_after_the_tick_resumes_exactly(bench: Bench) -> None:
    bench.tick(0.1)
    bench.autopilot.v.actuators.controls[0] = 0.2
    bench.here.controls()  # lost on the way there
    bench.there.greet()
    assert bench.here.feed(bench.there.feed(bench.here.hello({}) + bench.here.controls())) == TAKEN
    bench.autopilot.v.actuators.controls[0] = 0.3
    bench.there.feed(bench.here.controls())  # its tick is lost on the way back
    bench.there.greet()
    assert bench.here.feed(bench.there.feed(bench.here.hello({}) + bench.here.controls())) == TAKEN
    assert bench.physics.log == [0.1, 0.2, 0.3]
    assert first_difference(bench.autopilot.fleet[1]["sensors"], bench.physics.fleet[1]["sensors"]) is None


def test_physics_that_began_anew_is_another_world(bench: Bench) -> None:
    for _ in range(5):
        bench.tick()
    bench.physics.power_on()
    bench.say("COMMAND_LONG", command=246, param1=1)
    before = bench.autopilot.v.time_us
    assert bench.tick() == ELSEWHERE
    assert bench.autopilot.v.time_us == before
    bench.physics.log.clear()
    assert bench.here.feed(bench.there.feed(bench.here.hello({}) + bench.here.ask_reboot())) == TAKEN
    assert bench.physics.log == ["power on"] and bench.autopilot.v.time_us == 0


def test_a_tick_under_way_is_not_taken_for_the_one_after_a_reboot(bench: Bench) -> None:
    bench.tick()
    late = bench.there.feed(bench.here.controls())
    answer = bench.there.feed(bench.here.ask_reboot())
    assert bench.here.feed(late) == WAITING
    assert bench.here.feed(answer) == TAKEN
    assert bench.autopilot.v.time_us == 0


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e9])
def test_physics_refuses_absurd_controls_and_holds_time(bench: Bench, bad: float) -> None:
    outputs = [0.0] * 16
    outputs[5] = bad
    for _ in range(3):
        answer = bench.say("HIL_ACTUATOR_CONTROLS", time_usec=0, controls=outputs, flags=1)
        assert "HIL_SENSOR" not in names(answer)
    assert bench.there.refused == 3 and len(bench.there.notes) == 1 and "controls[5]" in bench.there.notes[0]
    assert bench.there.ticks == 0
    assert bench.tick() == TAKEN


@pytest.mark.parametrize("field", ["xacc", "zgyro", "ymag", "abs_pressure", "temperature"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -1e30])
def test_the_autopilot_refuses_absurd_sensors_and_holds_time(bench: Bench, field: str, bad: float) -> None:
    good = bench.there.feed(bench.here.controls())
    before = bench.autopilot.fleet.copy()
    spoilt = Sender(1, 158).frame(
        sensor.SENSOR_KIND, sensor.SENSOR_KIND.payload(**{**decoded(good, "HIL_SENSOR")[0]._asdict(), field: bad})
    )
    assert bench.here.feed(spoilt) == WAITING
    assert bench.here.refused == 1 and field in bench.here.notes[0]
    assert first_difference(before[1], bench.autopilot.fleet[1]) is None
    assert bench.here.feed(good) == TAKEN


def test_a_bad_gps_fix_spoils_its_tick(bench: Bench) -> None:
    good = bench.there.feed(bench.here.controls())
    gps = message("HIL_GPS")
    bad = Sender(1, 158).frame(gps, gps.payload(time_usec=2500, lat=2_000_000_000, fix_type=3))
    assert bench.here.feed(bad + good) == WAITING
    assert bench.autopilot.v.sensors.gps_count == 0 and bench.autopilot.v.time_us == 0
    assert bench.here.feed(good) == TAKEN


def test_bytes_in_pieces_and_rubbish_between_frames(bench: Bench) -> None:
    rng = random.Random(4)
    for _ in range(50):
        data = rng.randbytes(rng.randrange(20)) + b"\xfd\xff" + bench.here.controls()
        answer = b"".join(bench.there.feed(data[k : k + 7]) for k in range(0, len(data), 7))
        while not answer:  # what looked like a frame is waited for
            answer = bench.there.feed(bench.here.controls())
        found = [bench.here.feed(answer[k : k + 11]) for k in range(0, len(answer), 11)]
        assert TAKEN in found
    assert bench.autopilot.v.time_us == bench.physics.v.time_us == 50 * 2500


def test_parameters_and_seeds_go_before_the_next_controls(bench: Bench) -> None:
    bench.tick(0.5)
    bench.here.set_parameter("SIM_WIND_SPD", 4.5)
    bench.here.reseed(-2)
    bench.tick(0.6)
    assert bench.physics.log == [0.5, ("SIM_WIND_SPD", 4.5), ("seed", (1 << 64) - 2), 0.6]


def test_truth_on_demand(bench: Bench) -> None:
    bench.tick()
    body = bench.physics.v.physics.body
    body.vel, body.q = (1.0, -2.0, 0.5), (0.6, 0.0, 0.0, 0.8)
    bench.here.feed(bench.there.feed(bench.here.ask_truth()))
    assert bench.here.truth_us == 2500
    assert bench.here.truth == bench.physics.truth()
    assert bench.physics.log == [0.0]


def test_px4_time_goes_by_itself_until_it_drives() -> None:
    bench = Bench()
    bench.there.greet()
    assert not bench.there.freewheels  # silent so far
    command = message("COMMAND_LONG")
    bench.say("COMMAND_LONG", command=511, param1=truth.TRUTH_KIND.id, param2=5000)
    bench.say("HEARTBEAT", autopilot=PX4)
    assert bench.there.freewheels
    assert "COMMAND_ACK" not in names(bench.there.go_on())
    ticks = [names(bench.there.go_on()) for _ in range(4)]
    assert sum("HIL_STATE_QUATERNION" in tick for tick in ticks) == 2
    assert all(tick[-1] == "HIL_SENSOR" for tick in ticks)
    answer = bench.say("HIL_ACTUATOR_CONTROLS", time_usec=9000, controls=[0.4], flags=1)  # by its own clock
    assert names(answer)[-1] == "HIL_SENSOR" and not bench.there.freewheels
    assert bench.say("HIL_ACTUATOR_CONTROLS", time_usec=9000, controls=[0.5], flags=1) == b""
    assert bench.say("HIL_ACTUATOR_CONTROLS", time_usec=11000, controls=[0.6], flags=1)
    assert bench.physics.log[5:] == [round(0.838 * part, 6) for part in (0.4, 0.6)]  # of the rotors' range
    assert command.id == 76


def driven(bench: Bench, time_us: int) -> bytes:
    """What PX4 gets for its answer to a tick."""
    return bench.say("HIL_ACTUATOR_CONTROLS", time_usec=time_us, controls=[0.4], flags=1)


def test_px4_that_answers_late_is_waited_for_by_going_on() -> None:
    bench = Bench()
    bench.there.greet()
    bench.say("HEARTBEAT", autopilot=PX4)
    for _ in range(5):
        bench.there.go_on()
    assert bench.there.freewheels
    for late in (7500, 10_000):  # two ticks are still under way to it
        assert driven(bench, late) == b""
        assert not bench.there.freewheels and bench.there.wait_s == LONGEST_WAIT_S  # none is added to them
    assert names(driven(bench, 12_500))[-1] == "HIL_SENSOR"
    assert not bench.there.freewheels and bench.there.time_us == 15_000
    assert bench.there.clock.began_us == 0


def test_px4_that_joins_later_and_answers_late_drives_with_present_controls() -> None:
    """What a restarted one gets first is no tick of time 0: with that as its beginning, no answer would seem late."""
    bench = booted_px4()
    for _ in range(400):
        bench.there.go_on()
    bench.there.greet()
    bench.say("HEARTBEAT", autopilot=PX4)
    for _ in range(3):
        bench.there.go_on()
    now = bench.there.time_us
    assert driven(bench, now - 5000) == driven(bench, now - 2500) == b""
    assert driven(bench, now) != b"" and bench.there.clock.began_us == 0


def test_px4_that_cannot_keep_up_while_time_goes_by_itself_drives_with_present_controls_later() -> None:
    """It answers one tick while the wall clock has gone on by three, for as long as it is let."""
    bench = Bench()
    bench.there.greet()
    bench.say("HEARTBEAT", autopilot=PX4)
    answered, out = 0, b""
    while not out:
        for _ in range(3 * bench.there.freewheels):
            bench.there.go_on()
        answered += 1
        out = driven(bench, 2500 * answered)
        assert answered < 10
    assert bench.there.time_us == 10_000  # three ticks, and the one that the answer to the last has led to
    assert driven(bench, 2500 * answered) == b"" and driven(bench, 2500 * (answered + 1)) != b""
    assert bench.there.notes == [] and bench.there.unanswered == 0


def test_px4_that_falls_silent_before_it_drives_is_waited_for_by_going_on_again() -> None:
    bench = Bench()
    bench.there.greet()
    bench.say("HEARTBEAT", autopilot=PX4)
    for _ in range(4):
        bench.there.go_on()
    assert driven(bench, 2500) == b"" and not bench.there.freewheels
    assert names(bench.there.go_on())[-1] == "HIL_SENSOR"  # nothing came within ``wait_s``
    assert bench.there.freewheels and bench.there.notes == [] and bench.there.unanswered == 0
    assert driven(bench, 12_500) != b"" and not bench.there.freewheels


def behind() -> Bench:
    """A PX4 that has answered each tick late until it was held for one with another clock."""
    bench = Bench()
    bench.there.greet()
    bench.say("HEARTBEAT", autopilot=PX4)
    bench.there.go_on()
    answers, out = 0, b""
    while not out:
        bench.there.go_on()
        out = driven(bench, 2500 * answers)
        answers += 1
        if not out:
            assert not bench.there.freewheels
    assert answers == LATE + 1
    return bench


def test_a_clock_that_stays_behind_is_another_one_and_stops_nothing() -> None:
    """So is that of a PX4 before 1.14, which counts from the first tick that it got."""
    bench = behind()
    assert bench.there.clock.began_us == 5000
    assert driven(bench, bench.there.time_us - 5000) != b""


def test_px4_that_was_held_for_one_with_another_clock_answers_in_time_later() -> None:
    bench = behind()
    assert driven(bench, bench.there.time_us) != b"" and bench.there.clock.began_us == 0
    assert driven(bench, bench.there.time_us - 2500) == b""  # now that is late
    assert driven(bench, bench.there.time_us) != b""


def booted_px4() -> Bench:
    """It has answered its first tick."""
    bench = Bench()
    bench.there.greet()
    bench.say("HEARTBEAT", autopilot=PX4)
    assert bench.there.wait_s is None and bench.there.is_starting
    bench.there.go_on()
    assert driven(bench, 2500)
    return bench


def test_a_tick_that_px4_does_not_answer_is_followed_by_the_next_one() -> None:
    bench = booted_px4()
    assert bench.there.wait_s == LONGEST_WAIT_S
    bench.there.go_on()
    assert (bench.there.unanswered, bench.there.wait_s) == (1, 0.5 * LONGEST_WAIT_S)
    assert bench.say("HIL_ACTUATOR_CONTROLS", time_usec=5000, controls=[0.5], flags=1) == b""  # of the one before
    assert bench.say("HIL_ACTUATOR_CONTROLS", time_usec=7500, controls=[0.6], flags=1)
    bench.there.go_on()
    assert bench.there.unanswered == 2
    assert [text for text in bench.there.notes if "has not answered" in text] == [
        "the autopilot has not answered the tick at 0.0050 s in 200 ms: time goes on without it, and this is not said "
        "again"
    ]
    assert bench.physics.log[1:] == [round(0.838 * part, 6) for part in (0.4, 0.4, 0.6, 0.6)]


def test_px4_that_answers_every_second_tick_is_waited_for_at_those_and_trusted_again_later() -> None:
    bench = booted_px4()
    for k in range(20):
        bench.there.go_on()
        assert bench.say("HIL_ACTUATOR_CONTROLS", time_usec=7500 + 5000 * k, controls=[0.4], flags=1)
    assert bench.there.wait_s == 0.0
    bench.there.go_on()
    assert SHORTEST_WAIT_S <= bench.there.wait_s < LONGEST_WAIT_S
    now = bench.there.time_us
    for k in range(10 * TRUSTED):
        assert bench.say("HIL_ACTUATOR_CONTROLS", time_usec=now + 2500 * k, controls=[0.4], flags=1)
    assert bench.there.wait_s == LONGEST_WAIT_S


def test_time_stands_when_px4_stays_silent_and_goes_on_when_it_answers() -> None:
    bench = booted_px4()
    for _ in range(SILENT):
        assert bench.there.wait_s is not None
        bench.there.go_on()
    assert bench.there.wait_s is None and not bench.there.freewheels
    assert bench.say("HIL_ACTUATOR_CONTROLS", time_usec=bench.there.time_us, controls=[0.4], flags=1)
    assert bench.there.wait_s == SHORTEST_WAIT_S


def test_px4_without_a_rhythm_is_not_waited_for_long() -> None:
    bench = booted_px4()
    for k in range(40):
        for _ in range(k % 3 + 1):
            bench.there.go_on()
        bench.say("HIL_ACTUATOR_CONTROLS", time_usec=bench.there.time_us, controls=[0.4], flags=1)
        assert bench.there.wait_s > 0.0
    assert bench.there.wait_s == SHORTEST_WAIT_S


@pytest.mark.parametrize("rhythm", [1, 2, 3, 4])
def test_of_a_rhythm_the_ticks_that_are_answered_are_waited_for_though_one_is_missed(rhythm: int) -> None:
    clock, now = ForeignClock(), 0
    for _ in range(ALIKE + 2):
        assert clock.asks_for_step(Controls(now, 1, (0.0,) * 16, 1), now)
        for _ in range(rhythm - 1):
            clock.gave_up()
        now += 2500 * rhythm
    assert clock.asks_for_step(Controls(now, 1, (0.0,) * 16, 1), now)
    waited = []
    for _ in range(3 * rhythm):
        waited.append(clock.wait_s > 0.0)
        clock.gave_up()
    assert waited == [k % rhythm == 0 for k in range(1, 3 * rhythm + 1)]


@pytest.mark.parametrize("count", [1, 7, TRUSTED])
def test_ticks_that_were_answered_elsewhere_count_as_if_they_were_answered_here(count: int) -> None:
    here, there = ForeignClock(), ForeignClock()
    for clock in (here, there):
        assert clock.asks_for_step(Controls(0, 1, (0.0,) * 16, 1), 0)
        clock.gave_up()
        assert clock.asks_for_step(Controls(5000, 1, (0.0,) * 16, 1), 5000)
        for k in range(ALIKE + 2):
            assert clock.asks_for_step(Controls(7500 + 2500 * k, 1, (0.0,) * 16, 1), 7500 + 2500 * k)
        clock.gave_up()
        assert clock.asks_for_step(Controls(27_500, 1, (0.0,) * 16, 1), 27_500)
        assert clock.began_us == 0
    for clock in (here, there):
        for k in range(ALIKE + 1):
            assert clock.asks_for_step(Controls(30_000 + 2500 * k, 1, (0.0,) * 16, 1), 30_000 + 2500 * k)
    first = 30_000 + 2500 * (ALIKE + 1)
    for k in range(count):
        assert here.asks_for_step(Controls(first + 2500 * k, 1, (0.0,) * 16, 129), first + 2500 * k)
    there.was_answered(count, first + 2500 * count, True)
    waits = ("_longest_s",) if count == TRUSTED else ()  # it trusts again when it answers here
    found, wanted = vars(there), vars(here)
    assert {k: v for k, v in found.items() if k not in waits} == {k: v for k, v in wanted.items() if k not in waits}


def test_after_an_answer_that_came_twice_as_many_alike_are_needed_as_before() -> None:
    clock, now = ForeignClock(), 0

    def answered() -> bool:
        return clock.asks_for_step(Controls(now, 1, (0.0,) * 16, 1), now)

    assert answered()
    for _ in range(ALIKE + 2):
        clock.gave_up()
        now += 5000
        assert answered()
    assert clock.wait_s == 0.0 and not answered()
    waited = []
    for _ in range(ALIKE + 1):
        waited.append(clock.wait_s > 0.0)
        clock.gave_up()
        now += 5000
        assert answered()
    assert waited == [True] * ALIKE + [False]


@pytest.mark.parametrize("mode", [1, 129])
def test_a_disarmed_rover_that_answers_no_more_goes_by_the_wall_clock(mode: int) -> None:
    clock = ForeignClock(rests=True)
    assert clock.asks_for_step(Controls(0, 1, (0.0,) * 16, mode), 0)
    for _ in range(SILENT):
        assert clock.holds
        clock.gave_up()
    assert clock.is_silent and clock.holds == (mode != 1)


@pytest.mark.parametrize(("mode", "most"), [(1, SILENT), (129, SILENT_ARMED)])
def test_time_stands_earlier_in_flight(mode: int, most: int) -> None:
    clock = ForeignClock()
    assert clock.asks_for_step(Controls(0, 1, (0.0,) * 16, mode), 0)
    for _ in range(most):
        assert not clock.is_silent
        clock.gave_up()
    assert clock.is_silent


def test_px4_is_starting_for_some_seconds_after_its_first_answer() -> None:
    bench = booted_px4()
    while bench.there.time_us < START_US:
        assert bench.there.is_starting
        bench.say("HIL_ACTUATOR_CONTROLS", time_usec=bench.there.time_us, controls=[0.4], flags=1)
    bench.there.go_on()
    bench.there.go_on()
    assert not bench.there.is_starting


def test_px4_gets_no_position_before_there_is_one_and_then_hears_that_it_is_lost() -> None:
    bench = Bench()
    bench.there.greet()
    bench.say("HEARTBEAT", autopilot=PX4)
    s = bench.physics.v.sensors
    seen = []
    for fix in (1, 1, 3, 1):
        s.gps_count, s.gps_fix = s.gps_count + 1, fix
        seen.append("HIL_GPS" in names(bench.there.go_on()))
    assert seen == [False, False, True, True]


def test_an_autopilot_without_lockstep_never_stops_time() -> None:
    bench = Bench()
    bench.say("HEARTBEAT", autopilot=PX4)
    assert bench.say("HIL_ACTUATOR_CONTROLS", time_usec=5, controls=[0.4], flags=0) == b""
    assert bench.there.freewheels
    bench.there.go_on()
    assert bench.physics.log == [round(0.838 * 0.4, 6)]


def test_sticks_of_the_physics_side(bench: Bench) -> None:
    bench.there.move_sticks((1500, 1500, 1200))
    bench.tick()
    bench.tick()
    s = bench.autopilot.v.sensors
    assert (s.rc_count, s.rc_time_us, int(s.rc_channels[2])) == (1, 2500, 1200)


def test_an_autopilot_of_another_vehicle_is_not_answered() -> None:
    bench = Bench()
    bench.there._type = 10
    answer = bench.there.feed(bench.here.hello({}) + bench.here.ask_state())
    assert names(answer) == ["STATUSTEXT"] and "MAV_TYPE 2" in bench.there.notes[0]
    assert bench.here.feed(answer) == WAITING and "MAV_TYPE 2" in bench.here.notes[0]


def test_unknown_commands_and_parameters(bench: Bench) -> None:
    assert decoded(bench.say("COMMAND_LONG", command=22), "COMMAND_ACK")[0].result == 3
    assert decoded(bench.say("COMMAND_LONG", command=512, param1=30), "COMMAND_ACK")[0].result == 2
    assert bench.say("PARAM_SET", param_id=b"ATC_RAT_RLL_P", param_value=9.0) == b""
    nan = bench.say("COMMAND_LONG", command=511, param1=truth.TRUTH_KIND.id, param2=math.nan)
    assert decoded(nan, "COMMAND_ACK")[0].result == 2
    assert controls.KIND.id == 93


FROM_AUTOPILOT = ("HEARTBEAT", "HIL_ACTUATOR_CONTROLS", "COMMAND_LONG", "COMMAND_INT", "PARAM_SET", "SYSTEM_TIME")
FROM_PHYSICS = (
    "HIL_SENSOR", "HIL_GPS", "BATTERY_STATUS", "WHEEL_DISTANCE", "DISTANCE_SENSOR", "DEBUG_VECT", "DEBUG_FLOAT_ARRAY",
    "HIL_STATE_QUATERNION", "HIL_RC_INPUTS_RAW", "COMMAND_ACK", "STATUSTEXT", "PARAM_VALUE",
)  # fmt: skip


def frames(names: tuple[str, ...]) -> st.SearchStrategy[list[tuple[str, bytes]]]:
    return st.lists(st.tuples(st.sampled_from(names), st.binary(max_size=255)), min_size=1, max_size=8)


@settings(max_examples=300)
@given(frames(FROM_AUTOPILOT))
def test_the_physics_end(messages: list[tuple[str, bytes]]) -> None:
    bench, sender = Bench(), Sender(1, 1)
    for name, payload in messages:
        kind = message(name)
        before = bench.there.ticks
        bench.there.feed(sender.frame(kind, payload[: kind.size]))
        assert bench.there.ticks - before in (0, 1)
        assert bench.there.time_us == bench.physics.v.time_us
        assert all(math.isfinite(value) for value in bench.physics.v.actuators.controls)


@settings(max_examples=300)
@given(frames(FROM_PHYSICS), st.booleans())
def test_the_autopilot_end(messages: list[tuple[str, bytes]], asks: bool) -> None:
    bench, sender = Bench(), Sender(1, 158)
    bench.join()
    if asks:
        bench.here.controls()
    for name, payload in messages:
        kind = message(name)
        bench.here.feed(sender.frame(kind, payload[: kind.size]))
    v = bench.autopilot.v
    assert int(v.time_us) in (0, 2500)
    assert all(math.isfinite(value) for value in (*v.sensors.acc, *v.sensors.gyro, *v.sensors.mag))


@given(st.binary(max_size=600), st.binary(max_size=600))
def test_rubbish(there: bytes, here: bytes) -> None:
    bench = Bench()
    bench.join()
    bench.there.feed(there)
    bench.here.feed(here)
    assert bench.there.ticks == 0 and bench.autopilot.v.time_us == 0


# ---------------------------------------------------------------- how long PX4 is waited for


def answer(clock: ForeignClock, time_us: int, now_us: int, *, flags: int = 1, armed: bool = True) -> bool:
    return clock.asks_for_step(Controls(time_us, flags, (0.0,) * 16, 128 * armed), now_us)


def in_step(rests: bool = False, *, armed: bool = True) -> ForeignClock:
    """One whose tick of time 0 was answered, at 10 s of the physics."""
    clock = ForeignClock(rests)
    assert answer(clock, 0, 10_000_001, armed=armed) and clock.began_us == 10_000_001
    return clock


def test_before_it_answers_nothing_is_waited_for() -> None:
    clock = ForeignClock()
    assert not (clock.holds or clock.is_silent or clock.is_steady) and clock.is_starting(1 << 60)
    clock.gave_up()
    assert clock.unanswered == 0


@pytest.mark.parametrize(("silences", "steps"), [(0, False), (19, False), (20, True)])
def test_a_clock_that_is_always_late_is_another_one(silences: int, steps: bool) -> None:
    clock = ForeignClock()
    for _ in range(silences):
        assert not answer(clock, 5_000, 15_000) and clock.holds
        clock.gave_up()
        assert not clock.holds
    assert answer(clock, 7_500, 15_000) == steps and clock.holds
    assert clock.began_us == 7_500 * steps


@pytest.mark.parametrize(
    ("late_us", "flags", "began_us"), [(1, 1, 1), (0, 1, 0), (-2_500, 1, -2_500), (2_500, 0, 2_500)]
)
def test_it_is_in_step_with_its_first_answer_to_the_present_tick(late_us: int, flags: int, began_us: int) -> None:
    clock = ForeignClock()
    assert answer(clock, 50_000 - late_us, 50_000, flags=flags) == bool(flags)
    assert clock.began_us == began_us and clock.holds == bool(flags)


@pytest.mark.parametrize(
    ("time_us", "steps", "began_us"),
    [(2_500, True, 0), (0, False, 0), (5_000, True, -2_500), (2_501, True, 0), (-1, False, 0)],
)
def test_what_is_an_answer_to_the_present_tick(time_us: int, steps: bool, began_us: int) -> None:
    clock = in_step()
    assert answer(clock, time_us, 10_002_501) == steps
    assert clock.began_us == 10_000_001 + began_us


def test_each_tick_in_vain_halves_the_wait_and_four_hundred_answers_double_it() -> None:
    clock = in_step()
    waits = []
    for _ in range(8):
        waits.append(clock.wait_s)
        clock.gave_up()
    assert waits == [0.2, 0.1, 0.05, 0.025, 0.0125, 0.00625, 0.005, 0.005] and clock.unanswered == 8
    for k in range(1, 4_001):
        assert answer(clock, 20_000 + 2_500 * k, 10_020_001 + 2_500 * k)
        assert clock.wait_s == min(0.005 * 2 ** (k // 400), 0.2), k


@pytest.mark.parametrize("period", [1, 2, 4])
def test_after_four_answers_alike_ticks_between_are_not_waited_for(period: int) -> None:
    clock, now = in_step(), 10_000_001
    waits = []
    for _ in range(6):
        for k in range(period):
            waits.append(clock.wait_s > 0.0)
            now += 2_500
            if k < period - 1:
                clock.gave_up()
        assert answer(clock, now - 10_000_001, now)
    assert clock.is_steady == (period == 1)
    assert waits[: 5 * period] == [True] * (5 * period)
    assert waits[5 * period :] == [False] * (period - 1) + [True]
    assert clock.unanswered == 6 * (period - 1)


@pytest.mark.parametrize(("armed", "ticks"), [(True, 16), (False, 200)])
@pytest.mark.parametrize("rests", [True, False])
def test_time_stands_after_so_many_ticks_in_vain(armed: bool, ticks: int, rests: bool) -> None:
    clock = in_step(rests, armed=armed)
    for k in range(ticks):
        assert not clock.is_silent and clock.holds, k
        clock.gave_up()
    assert clock.is_silent and clock.holds == (armed or not rests)
    answer(clock, 2_500, 10_500_001, armed=armed)
    assert not clock.is_silent


def test_it_is_starting_for_four_seconds() -> None:
    clock = in_step()
    assert clock.is_starting(14_000_000) and not clock.is_starting(14_000_001)


def test_answers_given_elsewhere_count() -> None:
    clock = in_step()
    clock.gave_up()
    clock.was_answered(3, 10_010_001, False)
    assert clock.wait_s == 0.1
    assert not answer(clock, 7_500, 10_007_501, armed=False), "it is the one that was answered"
    for _ in range(199):
        clock.gave_up()
    assert not clock.is_silent, "it is disarmed"
    clock.gave_up()
    assert clock.is_silent and clock.unanswered == 201


# ---------------------------------------------------------------- what the physics is asked


def exchanged(bench: Bench) -> list[str]:
    """Names of what the autopilot gets for a tick."""
    data = bench.there.feed(bench.here.controls())
    bench.here.feed(data)
    return names(data)


def test_the_truth_is_told_at_its_interval(bench: Bench) -> None:
    def every(interval_us: float) -> int:
        said = bench.say("COMMAND_LONG", command=511, param1=truth.TRUTH_KIND.id, param2=interval_us)
        (ack,) = decoded(said, "COMMAND_ACK")
        assert (ack.command, ack.target_system, ack.target_component) == (511, 1, 1)
        return ack.result

    exchanged(bench)
    assert bench.there.truth_due == (0, 0) and every(5_000) == 0
    assert ["HIL_STATE_QUATERNION" in exchanged(bench) for _ in range(6)] == [True, False] * 3
    assert bench.there.truth_due == (5_000, 20_000)
    assert [every(us) for us in (1.1e12, -1.1e12, math.nan, math.inf)] == [2] * 4 and bench.there.truth_due[0] == 5_000
    assert every(-1.0) == 0 and bench.there.truth_due[0] == 0
    assert not any("HIL_STATE_QUATERNION" in exchanged(bench) for _ in range(6))


def test_commands_of_the_physics_and_what_follows_them(bench: Bench) -> None:
    exchanged(bench)
    state = ["COMMAND_ACK", "BATTERY_STATUS", "HIL_SENSOR"]
    assert names(bench.say("COMMAND_LONG", command=512, param1=107)) == state
    assert names(bench.say("COMMAND_LONG", command=512, param1=115)) == ["COMMAND_ACK", "HIL_STATE_QUATERNION"]
    assert decoded(bench.say("COMMAND_LONG", command=31011), "COMMAND_ACK")[0].result == 3, "not as COMMAND_LONG"
    (ack,) = decoded(bench.say("COMMAND_INT", command=31011, x=-2, y=5), "COMMAND_ACK")
    assert ack.result == 0 and bench.physics.log[-1] == ("seed", 5 << 32 | 0xFFFFFFFE)
    assert bench.there.time_us == 2_500
    assert names(bench.say("COMMAND_LONG", command=246)) == state
    assert bench.physics.log[-1] == "power on" and bench.there.time_us == 0


@pytest.mark.parametrize("last", [False, True])
def test_ticks_that_were_answered_elsewhere_have_been(bench: Bench, last: bool) -> None:
    exchanged(bench)
    out = bench.there.go_on_with(5, True, 77_000, last)
    assert names(out)[-1:] == ["HIL_SENSOR"] * last
    assert (bench.there.time_us, bench.there.ticks, bench.there.truth_due) == (15_000, 6, (0, 77_000))


def test_it_is_said_once_that_a_tick_was_not_answered() -> None:
    bench = Bench()
    bench.say("HEARTBEAT", autopilot=PX4)
    assert driven(bench, 0) != b"" and bench.there.wait_s == 0.2
    bench.there.go_on()
    bench.there.go_on()
    assert bench.there.notes == [
        "the autopilot has not answered the tick at 0.0025 s in 200 ms: time goes on without it, and this is not said "
        "again"
    ]
    assert bench.there.unanswered == 2 and bench.there.ticks == 3
    for k in range(14):
        assert bench.there.wait_s is not None, k
        bench.there.go_on()
    bench.say("HIL_ACTUATOR_CONTROLS", time_usec=1, controls=[0.4], flags=1, mode=129)
    for k in range(16):
        assert bench.there.wait_s is not None, k
        bench.there.go_on()
    assert bench.there.wait_s is None, "time stands"


def test_what_is_steady_waits_for_nothing_but_the_next_answer() -> None:
    bench = Bench()
    bench.say("HEARTBEAT", autopilot=PX4)
    while bench.there.time_us < 4_000_000:
        assert not bench.there.is_steady and bench.there.is_starting
        driven(bench, bench.there.time_us)
    assert bench.there.is_steady and not bench.there.is_starting
    bench.there.move_sticks((1500,))
    assert not bench.there.is_steady
    driven(bench, bench.there.time_us)
    assert bench.there.is_steady
    bench.there.feed(b"\xfd\x09")
    assert not bench.there.is_steady
