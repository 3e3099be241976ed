# SPDX-License-Identifier: BSD-3-Clause
"""The pytest plugin. Nothing of the simulator is imported before a test asks for a vehicle."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from .factory import VehicleFactory
    from .vehicle import Copter, Rover

FACTORY = pytest.StashKey["VehicleFactory"]()
TAKEN = pytest.StashKey[dict[Path, str]]()
FAULT = "sitl_fault"
"""Name of a report's property: what became of a fault."""
ALLOWED = "a test of a fault that never acts tests nothing; fail(..., may_not_act=True) allows it"
WRITTEN = "sitl_golden"
"""Name of a report's property: a golden that the test has written."""


def pytest_addoption(parser: pytest.Parser, pluginmanager: pytest.PytestPluginManager) -> None:
    """The options, each with its setting in the ini-file."""
    _import_as_always(pluginmanager)
    group = parser.getgroup("sitl", "vehicles in simulated time (gym-sitl)")
    group.addoption("--sitl-update-golden", action="store_true", help="write golden flights instead of comparing")
    for name, metavar, text in (
        ("log-dir", "DIR", "where logs of failing tests are kept (default: in pytest's cache)"),
        ("seed", "N", "seed of sensor noise, unless a test says another (default 0)"),
        ("physics", "NAME", "native, pybullet, jsbsim, ..., unless a test says another (default native)"),
        (
            "autopilot",
            "NAME[:PROGRAM]",
            "native, ardupilot:PROGRAM or betaflight, unless a test says so (default native)",
        ),
        ("params", "FILE", "file of parameters of all vehicles (.parm, .param, .params)"),
    ):
        group.addoption(f"--sitl-{name}", metavar=metavar, help=text)
        parser.addini(f"sitl_{name.replace('-', '_')}", text)


def _import_as_always(manager: pytest.PytestPluginManager) -> None:
    """Let the package be imported as it is.

    Of a distribution with a plugin, pytest reads and compiles each module anew when it is imported, to tell more about
    its assertions: here hundreds of modules without one, which takes longer than to boot a vehicle.
    """
    marked = getattr(manager.rewrite_hook, "_must_rewrite", None)
    if isinstance(marked, set):
        marked.discard("sitl")


def pytest_configure(config: pytest.Config) -> None:
    """Declare the marker."""
    config.addinivalue_line(
        "markers",
        "sitl(frame, home, seed, params, world, start, physics, autopilot, wind, mission, link_faults): "
        "how vehicles are made",
    )


def option(config: pytest.Config, name: str, default: str = "") -> str:
    """From the command line, or the ini-file."""
    given = config.getoption(f"sitl_{name}")
    return str(given if given is not None else config.getini(f"sitl_{name}") or default)


# ---------------------------------------------------------------------- fixtures


@pytest.fixture
def vehicle_factory(request: pytest.FixtureRequest) -> Iterator[VehicleFactory]:
    """Makes vehicles that are ready to arm: ``vehicle_factory("rover", world="maze", seed=3)``."""
    __tracebackhide__ = True
    from . import setup
    from .factory import VehicleFactory

    config, node = request.config, request.node
    if setup.compiling is None:
        setup.compiling = _Compiling(config)
    if not config.pluginmanager.has_plugin("sitl-reporter"):
        config.pluginmanager.register(Reporter(), "sitl-reporter")
    logs = _log_folder(config, node.nodeid)
    factory = VehicleFactory(_defaults(config, node.path.parent), _golden(config, node, logs), logs)
    node.stash[FACTORY] = factory
    yield factory
    factory.close()


@pytest.fixture
def copter(request: pytest.FixtureRequest, vehicle_factory: VehicleFactory) -> Copter:
    """A copter that is ready to arm."""
    __tracebackhide__ = True
    return vehicle_factory("copter", **_marked(request.node))


@pytest.fixture
def rover(request: pytest.FixtureRequest, vehicle_factory: VehicleFactory) -> Rover:
    """A rover that is ready to arm."""
    __tracebackhide__ = True
    return vehicle_factory("rover", **_marked(request.node))


@pytest.fixture
def assert_flies_like(vehicle_factory: VehicleFactory) -> Callable[..., None]:
    """``assert_flies_like(golden, tolerance=None)`` of the vehicle that the test made last."""

    def check(golden: str | Path, tolerance: Any = None) -> None:
        __tracebackhide__ = True
        if not vehicle_factory.vehicles:
            raise pytest.UsageError("assert_flies_like needs a vehicle: copter, rover or one of vehicle_factory")
        vehicle_factory.vehicles[-1].assert_flies_like(golden, tolerance)

    return check


@pytest.fixture
def assert_twin(request: pytest.FixtureRequest) -> Callable[..., Any]:
    """``assert_twin(log, limits, frame=...)`` of ``sitl.missions.testing``, with a log of the test's folder."""

    def check(log: str | Path, limits: Mapping[str, float], **options: Any) -> Any:
        __tracebackhide__ = True
        from .twin import assert_twin

        return assert_twin(request.path.parent / log, limits, **options)

    return check


class _Compiling:
    """Says once that the core is being compiled: the first test takes a minute then."""

    def __init__(self, config: pytest.Config) -> None:
        self._config, self._said = config, False

    def __call__(self, unit: str, done: float, total: float) -> None:
        if self._said:
            return
        self._said = True
        capture = self._config.pluginmanager.getplugin("capturemanager")
        with capture.global_and_fixture_disabled() if capture is not None else nullcontext():
            print("\nsitl: compiling the core, once (later runs load it from the cache)", file=sys.stderr, flush=True)


def _marked(node: pytest.Item) -> dict[str, Any]:
    """What markers say, the nearest one first."""
    options: dict[str, Any] = {}
    for marker in node.iter_markers("sitl"):
        options = {**marker.kwargs, **options}
    return options


def _defaults(config: pytest.Config, folder: Path) -> Any:
    from sitl.autopilot.params import parm_files

    from .setup import Defaults

    seed = option(config, "seed")
    if not re.fullmatch(r"(-?\d+)?", seed):
        raise pytest.UsageError(f"--sitl-seed {seed!r} is not a whole number")
    params = option(config, "params")
    values = parm_files.load(config.rootpath / params) if params else parm_files.FileValues()
    physics, autopilot = option(config, "physics", "native"), option(config, "autopilot", "native")
    return Defaults(
        int(seed) if seed else None, physics, autopilot, values, (folder, config.invocation_params.dir, config.rootpath)
    )


def _golden(config: pytest.Config, node: pytest.Item, logs: Path) -> Any:
    from .golden import GoldenStore

    how = f"pytest {str(node.nodeid)!r} --sitl-update-golden"
    taken = config.stash.setdefault(TAKEN, {})
    update = bool(config.getoption("sitl_update_golden"))
    return GoldenStore(node.path.parent, update, how, logs, taken=taken, test=node.nodeid)


def _log_folder(config: pytest.Config, nodeid: str) -> Path:
    """Of one test."""
    name = re.sub(r"[^\w.=,+-]+", "-", nodeid.replace("::", "-")).strip("-")[:150]
    given = option(config, "log_dir")
    if given:
        return config.rootpath / given / name
    cache = getattr(config, "cache", None)
    return (cache.mkdir("sitl-logs") if cache is not None else config.invocation_params.dir / "sitl-logs") / name


# ---------------------------------------------------------------------- reports


class Reporter:
    """Judges faults and keeps the logs of failing tests; it is there as soon as the first vehicle is."""

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Any:
        """A test whose fault never acted has tested nothing: it fails."""
        __tracebackhide__ = True
        factory = item.stash.get(FACTORY, None)
        try:
            result = yield
        finally:
            if factory is not None:
                faults = [f"{name}: {line}" for name, lines in factory.judge_faults() for line in lines]
                item.user_properties += [(FAULT, line) for line in faults]
                if faults:
                    item.add_report_section("call", "sitl: faults", "\n".join(faults))
        if factory is not None and (idle := factory.idle_faults()):
            pytest.fail("\n".join((*idle, ALLOWED)), pytrace=False)
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> Any:
        """Add logs, and goldens that were written."""
        report = yield
        factory = item.stash.get(FACTORY, None)
        if factory is None:
            return report
        if report.failed:
            error = call.excinfo.value if call.excinfo is not None else None
            for name, lines in factory.keep_logs(error):
                report.sections.append((f"sitl: {name}", "\n".join(lines)))
            del item.stash[FACTORY]
        if report.when == "call":
            report.user_properties += [(WRITTEN, str(path)) for path in factory.golden.written]
        return report


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Say which goldens were written, by whichever worker."""
    if not config.getoption("sitl_update_golden"):
        return
    for reports in terminalreporter.stats.values():
        for report in reports:
            for name, value in getattr(report, "user_properties", ()):
                if name == WRITTEN and report.when == "call":
                    terminalreporter.write_line(f"golden flight written: {value}")
