# SPDX-License-Identifier: BSD-3-Clause
"""A clock that clients push: grants, their answers, and that nothing moves without them."""

from __future__ import annotations

import pytest

from sitl.bridge.services.command_protocol import GRANT, RESEED
from sitl.client.endpoint import Endpoint
from sitl.run.standstill import SLICE_US, serve_lockstep
from sitl.simulation import Core, Simulation

ACCEPTED, DENIED, UNSUPPORTED = 0, 2, 3


class Script:
    """Says something to the vehicle before each look at the clients, and ends the run after the last."""

    def __init__(self, simulation: Simulation, *says) -> None:
        self.simulation, self.says, self.times = simulation, list(says), []

    def running(self) -> bool:
        self.times.append(self.simulation.time_us)
        if not self.says:
            return False
        self.says.pop(0)()
        return True


@pytest.fixture
def simulation(core: Core) -> Simulation:
    return Simulation("erle_copter", core=core)


@pytest.fixture
def client(simulation: Simulation) -> Endpoint:
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    return client


def grant(client: Endpoint, time_ms: int) -> None:
    client.send("COMMAND_INT", target_system=1, target_component=1, command=GRANT, x=time_ms)


def answers(client: Endpoint) -> list[tuple[int, int, int]]:
    acks = [m.fields for m in client.receive() if m.name == "COMMAND_ACK"]
    return [(ack.command, ack.result, ack.result_param2) for ack in acks]


def test_time_stands_without_a_grant_and_heartbeats_go_out(simulation: Simulation, client: Endpoint) -> None:
    script = Script(simulation, *[lambda: None] * 3)
    serve_lockstep(simulation, running=script.running)
    assert simulation.time_us == 0
    assert [m.name for m in client.receive()].count("HEARTBEAT") == 1


def test_a_grant_is_answered_after_all_that_falls_due_on_the_way(simulation: Simulation, client: Endpoint) -> None:
    client.set_interval("ATTITUDE", 10)
    script = Script(simulation, lambda: grant(client, 1000), *[lambda: None] * 3)
    serve_lockstep(simulation, running=script.running)
    assert simulation.time_us == 1_000_000
    assert max(b - a for a, b in zip(script.times, script.times[1:])) == SLICE_US
    received = client.receive()
    names = [m.name for m in received]
    assert names.count("ATTITUDE") == 10
    end = next(k for k, m in enumerate(received) if m.name == "COMMAND_ACK" and m.fields.command == GRANT)
    assert received[end].fields.result_param2 == 1000
    assert max(k for k, name in enumerate(names) if name == "ATTITUDE") < end


def test_repeated_and_older_grants_only_get_their_answer(simulation: Simulation, client: Endpoint) -> None:
    grants = (100, 100, 40, 0, -1, 101)
    script = Script(simulation, *[lambda t=t: grant(client, t) for t in grants])
    serve_lockstep(simulation, running=script.running)
    assert answers(client) == [
        (GRANT, ACCEPTED, 100), (GRANT, ACCEPTED, 100), (GRANT, ACCEPTED, 100), (GRANT, ACCEPTED, 100),
        (GRANT, DENIED, 0), (GRANT, ACCEPTED, 102),
    ]  # fmt: skip
    assert simulation.time_us == 102_500  # whole ticks


def test_time_goes_on_counting_over_a_reboot(simulation: Simulation, client: Endpoint) -> None:
    def reboot() -> None:
        client.command(246, 1.0)
        grant(client, 300)

    script = Script(simulation, lambda: grant(client, 200), reboot, lambda: None)
    serve_lockstep(simulation, running=script.running)
    assert answers(client) == [(GRANT, ACCEPTED, 200), (246, ACCEPTED, 0), (GRANT, ACCEPTED, 300)]
    assert simulation.bridge.now_us == 100_000


def test_a_run_ends_at_its_duration_whatever_is_granted(simulation: Simulation, client: Endpoint) -> None:
    script = Script(simulation, lambda: grant(client, 60_000), *[lambda: None] * 10)
    serve_lockstep(simulation, until_us=700_000, running=script.running)
    assert simulation.time_us == 700_000


def test_noise_can_be_seeded_anew(core: Core) -> None:
    def gyro(seed: int) -> tuple[float, ...]:
        simulation, client = Simulation("erle_copter", core=core), Endpoint()
        simulation.bridge.add_link(client.link)

        def ask() -> None:
            client.send("COMMAND_INT", target_system=1, target_component=1, command=RESEED, x=seed)
            grant(client, 20)

        serve_lockstep(simulation, running=Script(simulation, ask, lambda: None).running)
        assert answers(client)[0] == (RESEED, ACCEPTED, 0)
        return tuple(float(x) for x in simulation.v.sensors.gyro)

    assert gyro(-7) == gyro(-7) != gyro(8)


def test_other_runs_do_not_know_the_commands(simulation: Simulation, client: Endpoint) -> None:
    grant(client, 100)
    client.command(GRANT, 1.0)
    simulation.advance(0.01)
    assert answers(client) == [(GRANT, UNSUPPORTED, 0)] * 2
