# SPDX-License-Identifier: BSD-3-Clause
"""Ray: a cluster of machines that is there already, or an instance on this machine for as long as it is needed."""

from __future__ import annotations

import importlib
import importlib.util
import logging
import os
import signal
import socket
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from typing import Any
from urllib.parse import urlsplit

from ..errors import MissingExtra, OptionError

_LOCAL = "local"
"""``ray.init`` takes this for: begin an instance of your own, whatever else there is."""
_KNOCK_S = 5.0
_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_QUIET = {"RAY_USAGE_STATS_ENABLED": "0", "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0"}
"""For an instance of ours: it reports to nobody, and does not report changes to come."""


def require() -> None:
    """Ray is needed.

    Raises:
        MissingExtra: it is not installed.
    """
    if importlib.util.find_spec("ray") is None:
        raise MissingExtra("the backend ray needs Ray: pip install 'gym-sitl[ray]'")


@contextmanager
def cluster(cpus: int | None = None, address: str | None = None) -> Iterator[Any]:
    """The module ``ray``, connected: to what this process is connected to already, else to the cluster at
    ``address`` or ``$RAY_ADDRESS``, else to an instance that listens on 127.0.0.1 only and ends with the block.

    Args:
        cpus: tasks at a time, of an instance that is begun here; None: as many as this machine has cores.
        address: HOST:PORT or ray://HOST:PORT of a cluster, "auto" for the one that this machine is part of.

    Raises:
        MissingExtra: Ray is not installed.
        OptionError: no cluster answers there.
    """
    require()
    ray: Any = importlib.import_module("ray")
    if ray.is_initialized():
        yield ray
        return
    address = address or os.environ.get("RAY_ADDRESS") or _LOCAL
    alone = address == _LOCAL
    if address not in (_LOCAL, "auto"):
        host, port = _host_and_port(address)
        _knock(host, port, address)
        alone = host in _LOOPBACK and not _answers(ray.util.get_node_ip_address(), port)
    with _one_machine() if alone else nullcontext():
        _connect(ray, address, cpus)
    try:
        yield ray
    finally:
        ray.shutdown()


def _host_and_port(address: str) -> tuple[str, int]:
    try:
        parts = urlsplit(address if "://" in address else f"//{address}")
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if not host or not port:
        raise OptionError(f"{address!r} is no address of a Ray cluster: it must be HOST:PORT, ray://HOST:PORT or auto")
    return host, port


def _knock(host: str, port: int, address: str) -> None:
    """Look whether anybody listens there: Ray itself would go on trying for many minutes."""
    try:
        socket.create_connection((host, port), _KNOCK_S).close()
    except OSError as error:
        raise OptionError(f"no Ray cluster answers at {address!r}: {error.strerror or error}") from None


def _answers(host: str, port: int) -> bool:
    try:
        _knock(host, port, "")
    except OptionError:
        return False
    return True


def _connect(ray: Any, address: str, cpus: int | None) -> None:
    common = {"log_to_driver": False, "logging_level": logging.ERROR}
    before = _sigterm()
    try:
        if address == _LOCAL:
            with _environment(_QUIET):
                ray.init(_LOCAL, num_cpus=cpus, include_dashboard=False, **common)
        else:
            ray.init(address, **common)
    except (ConnectionError, TimeoutError, RuntimeError, ValueError, AssertionError) as error:
        ray.shutdown()
        what = "begin on this machine" if address == _LOCAL else f"be reached at {address!r}"
        raise OptionError(f"Ray cannot {what}: {str(error).strip().splitlines()[0]}") from error
    finally:
        with suppress(ValueError):  # another thread's business
            signal.signal(signal.SIGTERM, before)  # Ray has put its own there


def _sigterm() -> Any:
    return signal.getsignal(signal.SIGTERM) or signal.SIG_DFL


@contextmanager
def _one_machine() -> Iterator[None]:
    """Ray takes this machine's address for 127.0.0.1 meanwhile, as it does on Windows and macOS: its servers listen
    there and nowhere else, and it looks there for those of others."""
    constants: Any = importlib.import_module("ray._private.ray_constants")
    before = constants.ENABLE_RAY_CLUSTER
    constants.ENABLE_RAY_CLUSTER = False
    try:
        yield
    finally:
        constants.ENABLE_RAY_CLUSTER = before


@contextmanager
def _environment(settings: dict[str, str]) -> Iterator[None]:
    """Variables that are set for the time of a block, unless they are already."""
    added = [name for name in settings if name not in os.environ]
    os.environ.update({name: settings[name] for name in added})
    try:
        yield
    finally:
        for name in added:
            del os.environ[name]
