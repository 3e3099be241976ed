# SPDX-License-Identifier: BSD-3-Clause
"""A signal that comes as soon as a command has said something ends it as later: cleanly, with a whole log."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from sitl.cli import main
from sitl.drop_in import server
from sitl.logs.tlog import read_tlog
from sitl.run import runner
from sitl.run.stop_signals import StopSignals
from tests.drop_in.executable import free_base
from tests.ports import free_port

QUIET = ("--out", "none", "--tcp", "0", "--quiet")


@pytest.fixture
def at_once(monkeypatch):
    """``at_once(module, name, number)``: the signal comes inside of that function."""

    def arrange(module: object, name: str, number: int) -> None:
        original = getattr(module, name)

        def patched(*args, **kwargs):
            done = original(*args, **kwargs)
            signal.raise_signal(number)
            return done

        monkeypatch.setattr(module, name, patched)

    return arrange


@pytest.fixture(autouse=True)
def handlers():
    """Those of the process: a command puts back what it found."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = [signal.signal(number, signal.default_int_handler) for number in numbers]
    yield
    left = [signal.signal(number, was) for number, was in zip(numbers, before, strict=True)]
    assert left == [signal.default_int_handler] * 3


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("more", [(), ("--count", "2"), ("--lockstep",)], ids=["one", "swarm", "lockstep"])
def test_while_a_run_opens_its_log(core, tmp_path: Path, at_once, more, number: int) -> None:
    at_once(runner, "open_log", number)
    assert main(["run", "copter", *QUIET, "--log-dir", str(tmp_path), *more]) == 0
    logs = sorted(tmp_path.glob("*.tlog"))
    assert len(logs) == (2 if "--count" in more else 1)
    for log in logs:
        list(read_tlog(log))


def test_while_physics_says_what_it_is(core, capsys, monkeypatch) -> None:
    def told(*words: object, **_: object) -> None:
        signal.raise_signal(signal.SIGTERM)

    monkeypatch.setattr("builtins.print", told)
    assert main(["physics", "copter", "--listen", "tcp:0"]) == 0


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_while_an_executable_opens_its_logs(core, tmp_path: Path, monkeypatch, at_once, number: int) -> None:
    monkeypatch.chdir(tmp_path)
    at_once(server, "attach", number)
    ports = ("--base-port", str(free_base()), "--rc-in-port", str(free_port()))
    assert server.run("arducopter", [*ports, "--speedup", "1"]) == 0
    assert (tmp_path / "arducopter-storage.json").is_file()


def test_while_a_script_is_to_be_started(core, tmp_path: Path, at_once) -> None:
    at_once(runner, "open_log", signal.SIGTERM)
    with pytest.raises(SystemExit) as ended:
        main(["exec", "--speedup", "1", *QUIET, "--log-dir", str(tmp_path), "--", "sleep", "60"])
    assert ended.value.code == 128 + signal.SIGTERM


def test_before_it_catches_signals_they_do_what_they_did() -> None:
    with StopSignals() as signals:
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        signals.catch()
        signals.catch()
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGTERM)
        assert signals.received == ["SIGINT", "SIGTERM"] and not signals.go_on()
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


def test_it_tells_somebody_and_leaves_out_signals_that_a_system_lacks() -> None:
    told: list[str] = []
    with StopSignals("SIGTERM", "SIGNONESUCH", then=lambda: told.append("now")) as signals:
        signals.catch()
        assert signals.go_on()
        signal.raise_signal(signal.SIGTERM)
    assert (signals.received, told) == (["SIGTERM"], ["now"])
