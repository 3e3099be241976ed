# SPDX-License-Identifier: BSD-3-Clause
"""Our autopilot on physics behind the JSON wire: flights, other simulators' steps, and physics that goes or lies."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import threading
import time

import pytest

from sitl.bridge.ardupilot_json.servos import decode
from sitl.client.endpoint import Endpoint
from sitl.core.algebra import ZERO
from sitl.errors import OptionError
from sitl.foreign.json_host import JsonHost
from sitl.physics.engine import EngineError
from sitl.plants import json as json_plant
from sitl.plants.json_link import parse_address
from sitl.plants.local import stand_alone
from sitl.plants.plant import PhysicsLostError
from sitl.scenario import DEFAULT_HOME
from sitl.simulation import Simulation
from tests.bridge import json_lines

ANY = ("127.0.0.1", 0)
REST = (0.0, 0.0, 0.0, 0.0, 0.0, -9.80665, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class Server:
    """A JsonHost in a thread."""

    def __init__(self, frame="erle_copter", address=ANY):
        self.host = JsonHost(stand_alone(frame, home=DEFAULT_HOME), address)
        self._stop = False
        self._thread = threading.Thread(target=self.host.serve, args=(lambda: not self._stop,), daemon=True)
        self._thread.start()
        self.address = self.host.address
        self.physics = f"json:127.0.0.1:{self.address[1]}"

    def close(self):
        self._stop = True
        self._thread.join()
        self.host.close()
        self.host.plant.close()


@pytest.fixture
def server():
    server = Server()
    yield server
    server.close()


class Scripted:
    """In the place of a link: answers frames by a script; a None is an answer that never comes."""

    name = "script"

    def __init__(self, answers):
        self.answers, self.frames, self.waiting = answers, [], None

    def send(self, frame):
        self.frames.append(decode(frame))
        self.waiting = next(self.answers)

    def receive(self, wait_s=0.2):
        answer, self.waiting = self.waiting, None
        return answer

    def close(self):
        pass


def still(*times):
    return iter([json_lines.encode((time, *REST)) for time in times])


def on_script(answers, **options):
    """A simulation whose link is a script and whose wall clock goes 0.6 s at each look."""
    simulation = Simulation("erle_copter", physics="json:127.0.0.1:9", **options)
    simulation.plant.link.close()
    simulation.plant.link = Scripted(answers)
    now = iter(range(1_000_000))
    simulation.plant._wall = lambda: 0.6 * next(now)
    return simulation


def test_a_flight_over_the_wire(server):
    simulation = Simulation("erle_copter", physics=server.physics, seed=3)
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    simulation.advance(50.0)
    client.command(176, 1, 4)
    client.command(400, 1)
    simulation.advance(2.0)
    client.command(22, 0, 0, 0, 0, 0, 0, 5)
    simulation.advance(12.0)
    truth = server.host.plant.vehicle.v.physics.body
    assert -float(truth.pos[2]) == pytest.approx(5.0, abs=0.5)
    assert list(simulation.v.physics.body.pos) == pytest.approx(list(truth.pos), rel=1e-8)  # nine digits
    assert server.host.time_us == simulation.v.time_us == 64_000_000
    simulation.close()


def test_the_imu_feels_what_the_line_says():
    turning = (0.1, -0.2, 0.3, 1.0, 2.0, -9.0, *REST[6:])
    lines = (json_lines.encode((0.0025 * k, *turning)) for k in range(1, 1000))
    simulation = on_script(lines)
    for name in ("acc_noise", "gyro_noise"):
        simulation.v.physics.derived[name] = 0.0
    for name in ("acc_bias", "gyro_bias", "acc_walk", "gyro_walk"):
        simulation.v.physics.sensors[name] = ZERO
    for name in ("acc_scale", "gyro_scale"):
        simulation.v.physics.sensors[name] = (1.0, 1.0, 1.0)
    simulation.advance(0.01)
    assert list(simulation.v.sensors.gyro) == pytest.approx([0.1, -0.2, 0.3], abs=1e-6)
    assert list(simulation.v.sensors.acc) == pytest.approx([1.0, 2.0, -9.0], abs=1e-5)


@pytest.mark.parametrize(("step", "frames"), [(0.0025, 400), (0.001, 1000), (0.0005, 2000), (0.005, 200), (0.02, 50)])
def test_physics_may_have_steps_of_its_own(step, frames):
    simulation = on_script(still(*(step * k for k in range(1, 3000))))
    simulation.advance(1.0)
    assert simulation.v.time_us == 1_000_000
    assert len(simulation.plant.link.frames) == pytest.approx(frames, abs=12)


def test_physics_that_stands_at_any_time_is_joined():
    simulation = on_script(still(*(5000.0 + 0.0025 * k for k in range(1, 3000))))
    simulation.advance(0.1)
    assert simulation.v.time_us == 100_000 and len(simulation.plant.link.frames) == 40


def test_a_clock_that_jumps_takes_nothing_with_it():
    simulation = on_script(still(0.0025, 0.005, 60.0, 60.0025, 60.005))
    simulation.advance(0.0125)
    assert simulation.v.time_us == 12_500


class Doubled(Scripted):
    """Some answers come twice, the second time when the next frame is out already."""

    def send(self, frame):
        super().send(frame)
        again = getattr(self, "last", None)
        self.waiting = [self.waiting] if again is None else [again, self.waiting]
        self.last = self.waiting[-1]

    def receive(self, wait_s=0.2):
        return self.waiting.pop(0) if self.waiting else None


def test_an_answer_that_comes_twice_is_no_tick_and_not_taken_for_the_next():
    simulation = on_script(still())
    simulation.plant.link = Doubled(still(0.0025, 0.005, 0.0075, 0.01))
    simulation.plant._wall = lambda: 0.0
    simulation.advance(0.01)
    assert [frame.number for frame in simulation.plant.link.frames] == [0, 1, 2, 3]  # not one ahead
    assert simulation.v.time_us == 10_000 and simulation.plant.link.waiting == []


def test_physics_whose_time_stands_is_asked_again_and_then_lost():
    simulation = on_script(still(0.0025, *(0.0025,) * 100))
    simulation.advance(0.0025)
    with pytest.raises(PhysicsLostError, match="time stands"):
        simulation.advance(1.0)
    assert simulation.v.time_us == 2500
    assert {frame.number for frame in simulation.plant.link.frames[1:]} == {1}
    simulation.plant.link = Scripted(still(0.005))
    simulation.advance(0.0025)
    assert simulation.v.time_us == 5000


def test_what_was_felt_in_half_a_tick_is_not_lost_with_the_physics():
    part = json_lines.encode((0.0035, 1.0, *REST[1:]))
    simulation = on_script(iter([*still(0.0025), part, *(None,) * 100]))
    with pytest.raises(PhysicsLostError):
        simulation.advance(0.005)
    assert simulation.v.time_us == 2500 and simulation.plant._sums[0][0] == pytest.approx(0.001)
    simulation.plant.link = Scripted(still(0.005))
    simulation.advance(0.0025)
    assert simulation.v.time_us == 5000 and float(simulation.v.physics.body.rates[0]) == pytest.approx(0.4)


def test_a_frame_is_sent_again_and_then_the_physics_is_lost_with_no_time_passed():
    good = json_lines.encode((0.0025, *REST))
    simulation = on_script(iter([good, *(None,) * 100]))
    simulation.advance(0.0025)
    with pytest.raises(PhysicsLostError, match="does not answer"):
        simulation.advance(1.0)
    assert simulation.v.time_us == 2500
    assert [frame.number for frame in simulation.plant.link.frames[1:]] == [1] * (len(simulation.plant.link.frames) - 1)
    assert len(simulation.plant.link.frames) > 2
    simulation.plant.link = Scripted(still(0.005, 0.0075))
    simulation.advance(0.005)  # it is back
    assert simulation.v.time_us == 7500


def test_a_line_that_cannot_be_is_not_believed_and_time_stands():
    bad = json_lines.encode((0.005, math.nan, *REST[1:])).replace(b"nan", b"NaN")
    simulation = on_script(iter([json_lines.encode((0.0025, *REST)), *(bad,) * 100]))
    with pytest.raises(PhysicsLostError, match="NaN"):
        simulation.advance(1.0)
    assert simulation.v.time_us == 2500
    assert list(simulation.v.physics.body.rates) == [0.0, 0.0, 0.0]


def test_physics_that_begins_anew_reboots_the_autopilot_and_no_time_is_lost():
    simulation = on_script(still(0.0025, 0.005, 0.0025, 0.0025, 0.005, 0.0075, 0.01, 0.0125))
    simulation.advance(0.015)
    assert simulation.time_us == 15_000 and simulation.before_boot_us == 5000
    numbers = [frame.number for frame in simulation.plant.link.frames]
    assert numbers == [0, 1, 2, 0, 1, 2, 3]


def test_a_reboot_begins_the_physics_anew(server):
    simulation = Simulation("erle_copter", physics=server.physics)
    simulation.advance(1.0)
    simulation.request_reboot()
    simulation.advance(0.5)
    assert simulation.time_us == 1_500_000
    assert server.host.time_us == 500_000 and server.host.boots == 1


def test_what_a_line_tells_of_battery_and_range_is_sensed():
    line = json_lines.encode((0.0025, *REST), json_lines.extra(1.25, (10.5, 7.5)))
    simulation = on_script(iter([line]))
    simulation.advance(0.0025)
    assert float(simulation.v.sensors.rangefinder_range[0]) == 1.25
    assert (simulation.v.sensors.battery_voltage, simulation.v.sensors.battery_current) == (10.5, 7.5)


def test_a_receiver_of_the_simulators_takes_the_place_of_ours():
    sticks = {f"rc_{k + 1}": pulse for k, pulse in enumerate((1510, 1520, 1130, 1540, 1550, 1560, 1570, 1580))}
    line = json_lines.encode((0.0025, *REST), f',"rc":{json.dumps(sticks)}')
    lines = (line.replace(b"0.0025", b"%.4f" % (0.0025 * k), 1) for k in range(1, 100))
    simulation = on_script(lines)
    simulation.advance(0.1)
    assert list(simulation.v.autopilot.rc.channels[:8]) == list(sticks.values())
    assert simulation.v.autopilot.rc.receiver_ok == 1


def test_the_autopilots_own_options_are_its_own_and_the_physics_are_refused():
    home = (1.0, 2.0, 3.0, 4.0)
    simulation = Simulation("erle_copter", physics="json:127.0.0.1:9", home=home, seed=5, estimator="truth")
    assert (simulation.v.physics.origin.lat, simulation.v.physics.origin.alt) == (10_000_000, 3.0)
    simulation.close()
    with pytest.raises(OptionError, match="world"):
        Simulation("erle_copter", physics="json:127.0.0.1:9", world="maze_erlerover")


def test_there_are_no_snapshots():
    simulation = Simulation("erle_copter", physics="json:127.0.0.1:9")
    with pytest.raises(EngineError, match="snapshots"):
        simulation.snapshot()
    simulation.close()


@pytest.mark.parametrize(
    ("text", "address"),
    [("1.2.3.4:5", ("1.2.3.4", 5)), ("somewhere", ("somewhere", 9002)), ("9012", ("127.0.0.1", 9012))],
)
def test_addresses(text, address):
    assert parse_address(text) == address


@pytest.mark.parametrize("text", ["host:", "host:port", "1.2.3.4:70000", "host:-1"])
def test_what_is_no_address_is_refused(text):
    with pytest.raises(OptionError, match="HOST:PORT"):
        parse_address(text)


def test_a_rover_over_the_wire():
    server = Server("erle_rover")
    simulation = Simulation("erle_rover", physics=server.physics)
    simulation.advance(2.0)
    assert abs(float(simulation.v.sensors.acc[2]) + 9.8) < 0.5
    assert json_plant.OWN == ("home", "seed", "estimator")
    simulation.close()
    server.close()


@pytest.mark.slow
def test_physics_that_is_killed_and_started_again_leaves_nothing_hanging(tmp_path):
    def physics(port):
        process = subprocess.Popen(
            [sys.executable, "-m", "sitl", "physics", "copter", "--listen", f"json:{port}"], stdout=subprocess.PIPE,
            text=True, env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}, cwd=tmp_path,
        )  # fmt: skip
        for line in process.stdout:
            if "JSON on udp" in line:
                return process, int(line.rpartition(":")[2])
        raise AssertionError("the physics did not start")

    process, port = physics(0)
    simulation = Simulation("erle_copter", physics=f"json:127.0.0.1:{port}")
    try:
        simulation.advance(2.0)
        process.kill()
        process.communicate()
        now = iter(range(1_000_000))
        simulation.plant._wall = lambda: 0.6 * next(now)
        with pytest.raises(PhysicsLostError):
            simulation.advance(1.0)
        assert simulation.time_us == 2_000_000
        simulation.plant._wall = time.monotonic
        process, _ = physics(port)
        simulation.advance(1.0)
        assert simulation.time_us == 3_000_000 and simulation.before_boot_us == 2_000_000
    finally:
        simulation.close()
        process.kill()
        process.communicate()
