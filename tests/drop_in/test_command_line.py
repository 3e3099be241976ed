# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot SITL's command line, as its launch scripts write it."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.bridge.links import LinkFaults
from sitl.cli import parser
from sitl.drop_in.command_line import parse
from sitl.errors import OptionError

HOME = (-35.363261, 149.165230, 584.0, 353.0)


def test_sim_vehicles_command_line() -> None:
    words = "-S --model + --speedup 1 --slave 0 --defaults a/copter.parm,b.parm --sim-address=127.0.0.1 -I1"
    line = parse([*words.split(), "--home", "-35.363261,149.165230,584,353"])
    assert (line.model, line.speedup, line.home) == ("+", 1.0, HOME)
    assert line.defaults == (Path("a/copter.parm"), Path("b.parm"))
    assert (line.base_port, line.sticks_port) == (5770, 5511)
    assert not line.wipe and line.without_effect == ("--slave",)


def test_dronekit_sitls_command_line() -> None:
    line = parse(["-I0", "-S", "--model", "quad", "--home=-35.363261,149.16523,584,353", "--rate", "400"])
    assert (line.model, line.home, line.base_port, line.speedup) == ("quad", HOME, 5760, None)
    assert line.without_effect == ("--rate",)


def test_short_and_shortened_options() -> None:
    line = parse(["-w", "-M", "rover", "-O-35.363261,149.16523,584,353", "-s5", "-I", "2", "--uartA", "tcp:7", "-u"])
    assert (line.wipe, line.model, line.home, line.speedup, line.base_port) == (True, "rover", HOME, 5.0, 5780)
    assert line.devices[0] == "tcp:7" and line.without_effect == ()
    assert parse(["--instance", "1", "--base-port", "6000", "--rc-in-port", "7000"]).base_port == 6000
    assert parse(["--base-port", "6000", "--instance", "1"]).base_port == 6000
    assert parse(["--instance", "1", "--base-port", "5760"]).base_port == 5760
    assert (
        parse(["--base-port", "5760", "--instance", "1"]).base_port == 5770
    )  # as the real one: it has its usual number
    assert parse(["--instance", "1", "--rc-in-port", "7000"]).sticks_port == 7000
    assert parse(["--inst", "3"]).base_port == 5790


def test_serial_ports() -> None:
    line = parse(["--serial1=tcp:2", "--serial5=udpclient:127.0.0.1:14550", "--uartC", "tcp:9"])
    assert line.devices == {0: "tcp:0:wait", 1: "tcp:9", 2: "tcp:3", 5: "udpclient:127.0.0.1:14550"}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--warp", "9"], "option --warp not recognized"),
        (["--home", "CMAC"], "--home 'CMAC' is not LAT,LON,ALT,HEADING"),
        (["--home", "95,0,0,0"], "latitude is within"),
        (["--home", "0,0,45000,0"], "altitude is within"),
        (["--speedup", "fast"], "--speedup 'fast' is not a number"),
        (["-I", "-1"], "--instance '-1' is not a whole number from 0"),
        (["--sysid", "256"], "--sysid '256' is not a whole number from 0 to 255"),
        (["stray"], "'stray' belongs to no option"),
        (["--model"], "option --model requires argument"),
    ],
)
def test_what_cannot_be_taken_is_named(words: list[str], says: str) -> None:
    with pytest.raises(OptionError) as error:
        parse(words)
    assert says in str(error.value)


def test_help() -> None:
    assert parse(["-S", "--help"]).help and not parse(["-S"]).help


def test_sitl_run_takes_a_home_that_begins_with_a_minus() -> None:
    options = parser().parse_args(["run", "copter", "--home", "-35.363261,149.165230,584,353", "--seed", "3"])
    assert (options.home, options.seed) == (HOME, 3)
    options = parser().parse_args(["run", "copter", "--start", "-.5,1.5,0,90"])
    assert options.start == (-0.5, 1.5, 0.0, 90.0)


def test_subcommands_leave_every_option_to_the_executable() -> None:
    words = ["-w", "--model", "rover", "-I0", "--home", "-35,149,584,0", "--help"]
    options = parser().parse_args(["ardurover", *words])
    assert (options.command, options.words) == ("ardurover", words)


def test_faults_of_links() -> None:
    line = parse(["--model", "+", "--link-loss", "0.2", "--link-delay=0.2..0.4", "--link-cut", "1..2"])
    assert line.link_faults == LinkFaults(loss=0.2, delay=(0.2, 0.4), cuts=((1.0, 2.0),))
    assert parse([]).link_faults is None
    with pytest.raises(OptionError, match=r"loss 3\.0 is not a share"):
        parse(["--link-loss", "3"])
