# SPDX-License-Identifier: BSD-3-Clause
"""A JSBSim executive with an aircraft in it, silent."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ...core.extras import MissingExtra
from ..engine import EngineError

NAME = "vehicle"


def library() -> Any:
    """The jsbsim module, told to say nothing but errors.

    Raises:
        MissingExtra: it is not installed.
    """
    try:
        import jsbsim
    except ImportError as missing:
        raise MissingExtra("physics 'jsbsim' needs JSBSim: pip install 'gym-sitl[jsbsim]'") from missing
    if hasattr(jsbsim, "set_logger"):  # not in old ones, which speak
        jsbsim.set_logger(jsbsim.DefaultLogger(jsbsim.LogLevel.ERROR))
    return jsbsim


def load(text: str, dt: float) -> Any:
    """An FGFDMExec with the aircraft of a document, stepping by dt [s].

    JSBSim reads aircraft from files alone: one is written to a temporary folder and is gone again afterwards.

    Raises:
        EngineError: JSBSim does not take it.
    """
    jsbsim = library()
    with TemporaryDirectory(prefix="gym-sitl-jsbsim-") as folder:
        place = Path(folder) / "aircraft" / NAME
        place.mkdir(parents=True)
        (place / f"{NAME}.xml").write_text(text, encoding="utf-8")
        executive = jsbsim.FGFDMExec(folder)
        executive.set_debug_level(0)
        executive.disable_output()
        try:
            loaded = executive.load_model(NAME)
        except jsbsim.BaseError as error:
            raise EngineError(f"JSBSim does not take the aircraft: {error}") from error
    if not loaded:
        raise EngineError("JSBSim does not take the aircraft")
    executive.set_dt(dt)
    return executive
