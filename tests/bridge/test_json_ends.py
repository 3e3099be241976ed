# SPDX-License-Identifier: BSD-3-Clause
"""Both ends of the JSON interface as state machines: lockstep, repeats, restarts, strangers. Wall time is given."""

from __future__ import annotations

import pytest

from sitl.bridge.ardupilot_json.autopilot_end import AutopilotEnd
from sitl.bridge.ardupilot_json.physics_end import Asked, PhysicsEnd, lines, named, ticks
from sitl.bridge.ardupilot_json.servos import Servos, decode, encode
from tests.bridge import json_lines

HERE, THERE = ("127.0.0.1", 1111), ("127.0.0.1", 2222)


def frame(number: int, rate: int = 400) -> bytes:
    return encode(Servos(rate, number, (1500,) * 16))


def line(time: float) -> bytes:
    return json_lines.encode((time, 0, 0, 0, 0, 0, -9.8, 0, 0, 0, 1.0, 0, 0, 0, 0, 0, 0))


@pytest.mark.parametrize(
    ("rate", "steps"), [(0, 1), (1200, 1), (401, 1), (400, 1), (399, 1), (201, 1), (200, 2), (100, 4), (50, 8), (1, 8)]
)
def test_a_step_is_whole_ticks_no_longer_than_asked_for_but_for_the_first(rate, steps):
    assert ticks(rate) == steps


@pytest.mark.parametrize(
    ("rate", "count"), [(0, 1), (50, 1), (400, 1), (401, 1), (799, 1), (801, 2), (1200, 3), (1201, 3), (9999, 5)]
)
def test_a_tick_is_told_in_as_many_lines_as_are_asked_for(rate, count):
    assert lines(rate) == count


class Physics:
    """The end, and what is stepped for it."""

    def __init__(self) -> None:
        self.end, self.now, self.steps, self.restarts = PhysicsEnd(), 0.0, 0, 0

    def receive(self, datagram: bytes, peer=HERE) -> bytes | None:
        request = self.end.receive(datagram, peer, self.now)
        if request.asked is Asked.REPEAT:
            return self.end.repeat(self.now)
        if request.asked is Asked.NOTHING:
            return None
        if request.asked is Asked.RESTART:
            self.steps, self.restarts = 0, self.restarts + 1
        self.steps += 1
        self.end.answer([b"line %d" % self.steps], self.now)
        return self.end.lines[0]


def test_each_new_frame_is_one_step():
    physics = Physics()
    assert [physics.receive(frame(n)) for n in range(3)] == [b"line 1", b"line 2", b"line 3"]


def test_a_frame_that_comes_again_after_a_second_gets_the_same_line_and_no_step():
    physics = Physics()
    physics.receive(frame(0))
    physics.receive(frame(1))
    for _ in range(3):
        physics.now += 1.0
        assert physics.receive(frame(1)) == b"line 2"
    assert physics.receive(frame(2)) == b"line 3"


def test_a_repeat_that_crossed_our_answer_is_not_answered_again():
    physics = Physics()
    assert physics.receive(frame(7)) == b"line 1"
    physics.now += 0.01
    assert physics.receive(frame(7)) is None
    physics.now += 1.0
    assert physics.receive(frame(7)) == b"line 1"


def test_an_autopilot_that_was_started_anew_finds_physics_at_power_on():
    physics = Physics()
    for number in range(5):
        physics.receive(frame(number))
    physics.now += 0.3
    assert physics.receive(frame(0), THERE) == b"line 1"
    assert physics.restarts == 1
    physics.receive(frame(1), THERE)
    assert physics.receive(frame(0), THERE) == b"line 1"  # from the same port as well


def test_an_autopilot_that_lives_on_is_joined_by_a_new_physics():
    physics = Physics()
    assert physics.receive(frame(5000)) == b"line 1"
    assert physics.receive(frame(5001)) == b"line 2"
    assert physics.restarts == 0


def test_lost_frames_are_one_step():
    physics = Physics()
    physics.receive(frame(3))
    assert physics.receive(frame(9)) == b"line 2"


def test_the_count_goes_over_its_end():
    physics = Physics()
    physics.receive(frame(0xFFFFFFFF))
    assert physics.receive(frame(0)) == b"line 2"
    assert physics.restarts == 0


def test_a_second_autopilot_is_refused_while_the_first_lives_and_told_once():
    physics = Physics()
    physics.receive(frame(0))
    request = physics.end.receive(frame(0), THERE, physics.now + 0.01)
    assert request.asked is Asked.NOTHING and "second autopilot" in request.note
    assert physics.end.receive(frame(0), THERE, physics.now + 0.02).note == ""
    assert physics.receive(frame(1)) == b"line 2"
    assert physics.end.refused == 2


class TwoLines:
    """The end that answers each step with two lines at once."""

    def __init__(self) -> None:
        self.end, self.steps, self.now = PhysicsEnd(), 0, 0.0

    def receive(self, datagram: bytes, peer=HERE) -> Asked:
        asked = self.end.receive(datagram, peer, self.now).asked
        if asked in (Asked.STEP, Asked.RESTART):
            self.steps += 1
            self.end.answer([b"line %d, %d" % (self.steps, half) for half in (1, 2)], self.now)
        return asked


def test_of_two_lines_the_second_answers_the_next_frame_before_it_comes():
    physics = TwoLines()
    asked = [physics.receive(frame(n, 800 + (n > 0))) for n in range(6)]
    assert asked == 3 * [Asked.STEP, Asked.AHEAD] and physics.steps == 3


@pytest.mark.parametrize(("lost", "line"), [(4, b"line 3, 1"), (5, b"line 3, 2")])
def test_a_lost_one_of_two_lines_is_sent_again(lost, line):
    physics = TwoLines()
    for number in range(lost + 1):
        physics.receive(frame(number, 800))
    physics.now += 10.0
    assert physics.receive(frame(lost, 800)) is Asked.REPEAT and physics.end.repeat(physics.now) == line
    rest = [physics.receive(frame(n, 800)) for n in range(lost + 1, 8)]
    assert rest == [Asked.AHEAD, Asked.STEP, Asked.AHEAD][lost == 5 :] and physics.steps == 4


def test_an_autopilot_that_was_started_anew_between_two_lines_finds_physics_at_power_on():
    physics = TwoLines()
    for number in range(5):
        physics.receive(frame(number, 800))
    assert physics.receive(frame(0, 800)) is Asked.RESTART
    physics.now += 1.0
    assert physics.receive(frame(1, 800), THERE) is Asked.STEP  # another one, which was sent nothing yet


def test_two_lines_over_the_end_of_the_count():
    physics = TwoLines()
    asked = [physics.receive(frame(n & 0xFFFFFFFF, 800)) for n in range(0xFFFFFFFF, 0x100000002)]
    assert asked == [Asked.STEP, Asked.AHEAD, Asked.STEP]


def test_bytes_that_are_no_frame_are_counted_and_told_once():
    end = PhysicsEnd()
    first, second = (end.receive(b"junk", HERE, 0.0) for _ in range(2))
    assert "no frame of servos" in first.note and second.note == "" and end.refused == 2
    assert end.receive(frame(0), HERE, 0.0).asked is Asked.STEP


def test_our_end_counts_the_lines_it_takes():
    end = AutopilotEnd()
    pulses = [1000] * 16
    assert decode(end.frame(pulses)).number == 0
    assert end.receive(line(0.0025))[1] == 1 / 400
    assert decode(end.frame(pulses)).number == 1
    assert end.receive(line(0.005))[1] == pytest.approx(0.0025)
    assert end.receive(line(0.005))[1] == 0.0  # one that came twice answers nothing
    assert decode(end.frame(pulses)) == Servos(400, 2, tuple(pulses))


def test_of_lines_that_come_together_the_last_counts():
    end = AutopilotEnd()
    decoded, _ = end.receive(line(0.0025) + line(0.0075))
    assert decoded.time == 0.0075 and end.count == 1


def test_a_line_that_cannot_be_is_told_once_and_not_counted():
    end = AutopilotEnd()
    end.receive(line(1.0))
    for text in (b"", b"\n\n", b"{}", line(2.0).replace(b"-9.8", b"NaN")):
        assert end.receive(text) is None
    assert end.count == 1 and end.refused == 4 and "not believed" in end.note
    end.note = ""
    end.receive(b"{}")
    assert end.note == ""


def test_physics_that_begins_anew_is_a_step_back():
    end = AutopilotEnd()
    end.receive(line(10.0))
    assert end.receive(line(0.0025))[1] < 0.0


def test_an_autopilot_that_begins_anew_counts_from_zero_and_has_no_time():
    end = AutopilotEnd()
    end.receive(line(10.0))
    end.restart()
    assert decode(end.frame([0] * 16)).number == 0
    assert end.receive(line(0.0025))[1] == 1 / 400


def test_the_two_ends_keep_step_over_a_link_that_loses_every_seventh_datagram():
    autopilot, physics, sent = AutopilotEnd(), Physics(), 0
    for _ in range(200):
        datagram = autopilot.frame([1500] * 16)
        while True:
            sent += 1
            answer = physics.receive(datagram) if sent % 7 else None
            sent += 1
            if answer is not None and sent % 7:
                break
            physics.now += 1.0
        assert autopilot.receive(line(0.0025 * physics.steps)) is not None
        assert autopilot.time == 0.0025 * physics.steps
    assert autopilot.count == physics.steps == 200


@pytest.mark.parametrize("first", [b"\0", b"\x81"])
def test_what_is_no_frame_is_not_taken_for_the_one_that_is_answered_already(first):
    physics = TwoLines()
    physics.receive(frame(0, 800))
    assert physics.receive(first + frame(1, 800)[1:]) is Asked.NOTHING
    assert (physics.end.refused, physics.end.count) == (1, 0)
    assert physics.receive(frame(1, 800), THERE) is Asked.NOTHING, "of another autopilot"
    assert (physics.end.refused, physics.end.count) == (2, 0)
    assert physics.receive(frame(1, 800)) is Asked.AHEAD


@pytest.mark.parametrize(
    ("peer", "said"), [(("127.0.0.1", 9003), "127.0.0.1:9003"), ("serial", "serial"), (("::1", 5, 0, 0), "::1:5:0:0")]
)
def test_who_sends_is_named_by_its_address(peer, said):
    assert named(peer) == said
    end = PhysicsEnd()
    assert end.receive(frame(0), peer, 0.0).note == f"autopilot at {said}"
    assert end.receive(frame(1), THERE, 100.0).note == f"autopilot at {named(THERE)}, before at {said}"


@pytest.mark.parametrize(("later", "asked"), [(0.499, Asked.NOTHING), (0.5, Asked.REPEAT)])
def test_a_repeat_has_crossed_our_answer_within_half_a_second(later, asked):
    end = PhysicsEnd()
    end.receive(frame(7), HERE, 100.0)
    end.answer([b"line"], 100.0)
    assert end.receive(frame(7), HERE, 100.0 + later).asked is asked
    if asked is Asked.REPEAT:
        end.repeat(100.75)
        assert end.receive(frame(7), HERE, 101.249).asked is Asked.NOTHING, "it was answered again"
        assert end.receive(frame(7), HERE, 101.25).asked is Asked.REPEAT


@pytest.mark.parametrize(("later", "asked"), [(0.249, Asked.NOTHING), (0.25, Asked.STEP)])
def test_an_autopilot_is_still_there_for_a_quarter_of_a_second(later, asked):
    end = PhysicsEnd()
    end.receive(frame(7), HERE, 100.0)
    end.answer([b"line"], 100.0)
    assert end.receive(frame(8), THERE, 100.0 + later).asked is asked
    assert end.refused == (asked is Asked.NOTHING) and end.peer == (HERE if asked is Asked.NOTHING else THERE)


@pytest.mark.parametrize(("before", "asked"), [((1 << 31) - 1, Asked.RESTART), (1 << 31, Asked.STEP)])
def test_a_count_that_is_lower_by_half_of_all_has_gone_over_its_end(before, asked):
    end = PhysicsEnd()
    end.receive(frame(before), HERE, 0.0)
    end.answer([b"line"], 0.0)
    request = end.receive(frame(0), HERE, 1.0)
    assert request.asked is asked
    assert request.note == ("the autopilot has been started anew" if asked is Asked.RESTART else "")


def test_frames_that_were_answered_elsewhere():
    end = PhysicsEnd()
    end.receive(frame(0), HERE, 0.0)
    end.answer([b"line"], 0.0)
    end.go_on(5, 6, [b"a", b"b", b"c"], 10.0)
    assert (end.count, end.ahead) == (6, 1)
    assert end.receive(frame(6), HERE, 10.4).asked is Asked.NOTHING
    assert end.receive(frame(8), THERE, 10.5).asked is Asked.NOTHING, "the first is still there"
    assert end.receive(frame(6), HERE, 11.0).asked is Asked.REPEAT and end.repeat(11.0) == b"b"
    assert end.receive(frame(7), HERE, 11.0).asked is Asked.AHEAD and end.ahead == 0
    assert end.receive(frame(8), HERE, 11.0).asked is Asked.STEP


def test_a_frame_of_which_no_line_is_known_is_stepped():
    end = PhysicsEnd()
    end.receive(frame(3), HERE, 0.0)
    assert end.ahead == 0
    assert end.receive(frame(3), HERE, 1.0).asked is Asked.STEP, "it was asked for, and not answered"


def test_of_sixteen_kinds_each_is_told_once():
    end = PhysicsEnd()
    end.receive(frame(0), HERE, 0.0)
    for port in range(17):
        notes = [end.receive(frame(0), ("127.0.0.1", port), 0.01).note for _ in range(2)]
        assert ["second autopilot" in note for note in notes] == [True, port == 16]
    assert end.refused == 34
