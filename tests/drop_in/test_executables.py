# SPDX-License-Identifier: BSD-3-Clause
"""``arducopter`` and ``ardurover`` in processes of their own, with clients on their ports."""

from __future__ import annotations

import socket
import struct
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest

from sitl.client import Client
from sitl.drop_in.storage import Storage
from sitl.simulation import Core
from tests.drop_in.executable import command, environment, free_base, running
from tests.ports import free_port

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore:.*clock cannot be held")]
FAST = ("--speedup", "20")
HOME = ("--home", "-35.363261,149.165230,584,90")


def test_it_waits_for_its_first_client_and_serves_three_ports(core: Core, tmp_path: Path) -> None:
    with (
        running(tmp_path, "-w", "-S", "--model", "quad", *HOME, *FAST) as vehicle,
        closing(Client(vehicle.url())) as first,
        closing(Client(vehicle.url(2))) as second,
        closing(Client(vehicle.url(3))) as third,
    ):
        for client in (first, second, third):
            client.wait_ready()
        assert first.heading == pytest.approx(90.0, abs=4.5)  # as a real one, 20 s after its boot (docs/vehicles.md)
        digits = bytes(first.message("AUTOPILOT_VERSION").flight_custom_version).decode()
        assert len(digits) == 8 and int(digits, 16) > 0


def test_sticks_on_udp(core: Core, tmp_path: Path) -> None:
    with running(tmp_path, *FAST, program="ardurover") as vehicle, closing(Client(vehicle.url())) as client:
        wanted = tuple(range(1101, 1117))
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sticks, client.messages("RC_CHANNELS", 10) as seen:
            sticks.sendto(struct.pack("<16H", *wanted), ("127.0.0.1", vehicle.sticks))
            client.wait(lambda _: seen and seen[-1][1:17] == wanted, 20.0, "all sixteen sticks")


def test_parameters_and_mission_are_kept_until_they_are_wiped(core: Core, tmp_path: Path) -> None:
    defaults = tmp_path / "defaults.parm"
    defaults.write_text("CRUISE_SPEED 1\nWP_SPEED 1.5\nNO_SUCH_NAME 5\n")
    saved = tmp_path / "qgc.params"
    saved.write_text("# Stack: ArduPilot\n1\t1\tCRUISE_SPEED\t3.5\t9\n1\t1\tLOG_BACKEND_TYPE\t2\t2\n")
    start = ("--model", "rover", "--defaults", f"{defaults},{saved}", *FAST)
    with running(tmp_path, *start, program="ardurover") as vehicle, closing(Client(vehicle.url())) as client:
        assert any("NO_SUCH_NAME" in line for line in vehicle.said)
        assert (
            any("LOG_BACKEND_TYPE 2 (1)" in line for line in vehicle.said) and client.params["LOG_BACKEND_TYPE"] == 2.0
        )
        assert (client.params["CRUISE_SPEED"], client.params["STAT_BOOTCNT"]) == (3.5, 1.0)
        client.params["CRUISE_SPEED"] = 4.5
        client.params["SCHED_LOOP_RATE"] = 400  # out of range: taken and kept, as ArduPilot does
        client.wait_ready()
        client.upload([client.item("NAV_WAYPOINT"), client.item("NAV_WAYPOINT", 5.0, 5.0)])
    with running(tmp_path, *start, program="ardurover") as vehicle, closing(Client(vehicle.url())) as client:
        names = ("CRUISE_SPEED", "WP_SPEED", "STAT_BOOTCNT", "MIS_TOTAL", "SCHED_LOOP_RATE")
        assert [client.params[name] for name in names] == [4.5, 1.5, 2.0, 2.0, 400.0]
    with running(tmp_path, "-w", *start, program="ardurover") as vehicle, closing(Client(vehicle.url())) as client:
        kept = [client.params[name] for name in ("CRUISE_SPEED", "STAT_BOOTCNT", "MIS_TOTAL")]
        assert kept[:2] == [3.5, 1.0]
        assert kept[2] <= 1.0, "home alone, as soon as there is one"
    assert not [path for path in tmp_path.iterdir() if path.suffix == ".new"]


def test_a_reboot_keeps_process_and_parameters(core: Core, tmp_path: Path) -> None:
    with running(tmp_path, "-w", *HOME, *FAST) as vehicle:
        with closing(Client(vehicle.url())) as client:
            client.params.update(WPNAV_SPEED=450, LOG_DISARMED=1)
            client.delay(2.0)
            assert (client.params["STAT_BOOTCNT"], client.params["STAT_RESET"]) == (1.0, 1.0)
            client.send_command("PREFLIGHT_REBOOT_SHUTDOWN", 1)
            client.connection.pause(0)  # its clock is about to be set back: nothing can be waited for
        with closing(Client(vehicle.url(2))) as client:  # it asks for telemetry anew
            client.wait(lambda _: client.params["STAT_BOOTCNT"] == 2.0, 10.0, "the second boot")
            assert client.params["WPNAV_SPEED"] == 450.0
            client.delay(2.0)
            client.params["STAT_RESET"] = 0
            client.wait(lambda _: client.params["STAT_BOOTCNT"] == 0.0, 10.0, "statistics without boots")
            assert client.params["STAT_RESET"] > 3e8
        assert vehicle.process.poll() is None
    logs = sorted(path.name for path in (tmp_path / "logs").iterdir())
    assert logs == ["00000001.BIN", "00000002.BIN", "LASTLOG.TXT"]
    assert (tmp_path / "logs" / "LASTLOG.TXT").read_text().strip() == "2"
    assert Storage(tmp_path / "arducopter-storage.json").parameters["WPNAV_SPEED"] == 450.0


def test_the_speed_up_is_a_parameter(core: Core, tmp_path: Path) -> None:
    with running(tmp_path, "--sysid", "7", "--speedup", "5") as vehicle, closing(Client(vehicle.url())) as client:
        assert (client.params["SIM_SPEEDUP"], client.system) == (5.0, 7)
        client.params["SIM_SPEEDUP"] = 0  # as fast as it goes
        client.wait_ready()
        client.take_off(5.0)


def test_a_serial_port_speaks_first_where_it_is_told_to(core: Core, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as station, socket.socket(type=socket.SOCK_DGRAM) as listener:
        listener.bind(("127.0.0.1", 0))
        for server in (station, listener):
            server.settimeout(60)
        devices = [
            f"--serial0=udpclient:127.0.0.1:{listener.getsockname()[1]}",
            f"--serial1=tcpclient:127.0.0.1:{station.getsockname()[1]}",
            "--serial2=none", "--serial5=uart:/dev/ttyS9",
        ]  # fmt: skip
        words = [*command("ardurover"), "--base-port", str(free_base()), "--rc-in-port", str(free_port())]
        with subprocess.Popen(
            [*words, *devices], cwd=tmp_path, env=environment(), stdout=subprocess.PIPE, text=True
        ) as process:
            assert listener.recv(2048)[0] in (0xFD, 0xFE)
            connection, _ = station.accept()
            with connection:
                connection.settimeout(60)
                assert connection.recv(1)[0] in (0xFD, 0xFE)
            process.terminate()
            said, _ = process.communicate(timeout=60)
        assert process.returncode == 0 and "Waiting" not in said


def test_it_ends_when_its_parent_does(core: Core, tmp_path: Path) -> None:
    ports = ["--base-port", str(free_base()), "--rc-in-port", str(free_port())]
    parent = (
        "import subprocess, sys\n"
        f"child = subprocess.Popen({[*command('arducopter'), *ports]!r}, stdout=subprocess.PIPE, text=True)\n"
        "while 'Waiting' not in child.stdout.readline(): pass\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", parent], cwd=tmp_path, env=environment(), stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stderr is not None
        assert process.wait(120) == 0
        process.stderr.read()  # to its end: the child, which has the other end of it, is gone


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--warp", "9"), "arducopter: option --warp not recognized"),
        (("--model", "zeppelin"), "arducopter: --model 'zeppelin' is none of +, quad"),
        (("--defaults", "absent.parm"), "parameter file 'absent.parm' cannot be read"),
        (("--serial1", "tcp:x"), "--serial1 'tcp:x': 'x' is not a port"),
    ],
)
def test_a_bad_option_is_told(core: Core, tmp_path: Path, words: tuple[str, ...], says: str) -> None:
    ports = ("--base-port", str(free_base()), "--rc-in-port", str(free_port()))
    done = subprocess.run(
        [*command("arducopter"), *ports, *words], cwd=tmp_path, env=environment(), capture_output=True, text=True
    )
    assert done.returncode == 2 and says in done.stderr, done.stderr


def test_help_and_the_subcommand(core: Core, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "sitl", "ardurover", "-S", "--help"],
        cwd=tmp_path, env=environment(), capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0 and "--serial0 DEVICE" in done.stdout and done.stderr == ""
