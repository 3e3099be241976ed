# SPDX-License-Identifier: BSD-3-Clause
"""What a run was made of: all that decides what a vehicle does, besides what clients send."""

from __future__ import annotations

import hashlib
import importlib.metadata
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from ..bridge.services.failure_injection import FaultService
from ..core import compile as compiler
from ..core.fingerprint import reached
from ..physics.engines import NATIVE
from ..simulation import Simulation
from ..vehicle.kind import Kind
from ..version import __version__
from ..worlds import World

PACKAGES = ("autopilot", "bridge", "core", "physics", "plants", "vehicle", "vehicles")
"""Packages whose sources decide what a vehicle does and says, besides ``simulation.py``."""
_ROOT = Path(__file__).parents[1]


def _digest(parts: list[bytes]) -> str:
    out = hashlib.sha256()
    for part in parts:
        out.update(len(part).to_bytes(8, "little") + part)
    return out.hexdigest()[:16]


@cache
def sources() -> dict[str, str]:
    """Package of the program -> digest of its source files."""
    found = {}
    for package in PACKAGES:
        files = sorted((_ROOT / package).rglob("*.py"))
        found[package] = _digest([b for f in files for b in (f.relative_to(_ROOT).as_posix().encode(), f.read_bytes())])
    found["simulation"] = _digest([(_ROOT / "simulation.py").read_bytes()])
    return found


@cache
def _compiled(entry: Any, path: str) -> str:
    """Digest of the core's units, as they are written: neither compilers nor processor nor the version of Python belong
    to it, since they do not change a flight."""
    return _digest([compiler.unit_identity(unit, path).encode() for unit in reached(entry)])


def version(kind: Kind, physics: str = NATIVE) -> dict[str, Any]:
    """The version of all code that a vehicle of this kind runs on."""
    found = {
        "gym-sitl": __version__,
        "sources": sources(),
        "compiled core": _compiled(kind.advance, kind.record_path),
    }
    if physics != NATIVE:
        try:
            found[physics] = importlib.metadata.version(physics)
        except importlib.metadata.PackageNotFoundError:
            found[physics] = "of no version"
    return found


def of_world(world: World) -> str:
    """Digest of all that a world's file says, but its words."""
    parts = (world.solids, world.starts, world.floor_z, world.friction)
    return _digest([repr(parts).encode()])


def describe(simulation: Simulation) -> dict[str, Any]:
    """Description of the code and settings of a simulation at power-on, as JSON types."""
    found = simulation.resolved.to_json()
    found["faults"] = simulation.bridge.get(FaultService).texts
    if found["world"] is not None and simulation.world is not None:
        found["world"]["digest"] = of_world(simulation.world)
    kind, physics = simulation.kind, simulation.physics
    return {"version": version(kind, physics), **found, "epoch_us": simulation.bridge.epoch_us}


def differences(then: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """Differences between two runs' descriptions, in words: code first, then settings."""
    return [*code_differences(then["version"], now["version"]), *vehicle_differences(then, now)]


def code_differences(then: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """Differences between two versions of the code, in words."""
    found = []
    packages = [name for name in now["sources"] if then["sources"].get(name) != now["sources"][name]]
    if packages:
        found.append(f"sources of {', '.join(packages)}")
    if then["compiled core"] != now["compiled core"]:
        found.append("another compiled core" + ("" if packages else " (modes or parameters of other packages)"))
    for name in sorted({*then, *now} - {"sources", "compiled core"}):
        if then.get(name) != now.get(name):
            found.append(f"{name} {then.get(name)} then, {now.get(name)} now")
    return found


def vehicle_differences(then: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """Differences between two simulations' settings, in words."""
    found = []
    if then["airframe"]["name"] != now["airframe"]["name"]:
        found.append(f"airframe {then['airframe']['name']} -> {now['airframe']['name']}")
        then = {**then, "airframe": now["airframe"]}
    for group, title in (("properties", "property"), ("parameters", "parameter")):
        old, new = then["airframe"][group], now["airframe"][group]
        for name in sorted({*old, *new}):
            if old.get(name) != new.get(name):
                found.append(f"airframe {then['airframe']['name']}: {title} {name} {old.get(name)} -> {new.get(name)}")
    old, new = then["world"] or {}, now["world"] or {}
    if (old.get("name"), old.get("digest")) != (new.get("name"), new.get("digest")):
        same = old.get("name") == new.get("name")
        found.append(
            f"world {old.get('name')} has been changed" if same else f"world {old.get('name')} -> {new.get('name')}"
        )
    for name in ("vehicle", "home", "seed", "estimator", "physics", "start", "epoch_us"):
        if then[name] != now[name]:
            found.append(f"{name} {then[name]} -> {now[name]}")
    old, new = then["params"], now["params"]
    for name in sorted({*old, *new}):
        if old.get(name) != new.get(name):
            found.append(f"parameter {name} {old.get(name)} -> {new.get(name)}")
    return found
