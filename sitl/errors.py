# SPDX-License-Identifier: BSD-3-Clause
"""Errors that are a user's mistake: the command line prints their text without a traceback."""

from __future__ import annotations

from .autopilot.params.files import ParameterError
from .bridge.links.address import LinkAddressError
from .core.code_cache import BuildError
from .core.extras import MissingExtra
from .foreign.process import AutopilotEndedError
from .logs.tlog import LogError
from .option_error import OptionError, VehicleError
from .physics.engine import EngineError
from .plants.plant import PhysicsLostError
from .recording.error import RecordingError
from .run.pacing import SpeedupError
from .vehicles.airframe import AirframeError
from .warp import CannotBuild
from .worlds import WorldError

USER_ERRORS: tuple[type[Exception], ...] = (
    AirframeError,
    AutopilotEndedError,
    BuildError,
    CannotBuild,
    EngineError,
    LinkAddressError,
    LogError,
    MissingExtra,
    OptionError,
    ParameterError,
    PhysicsLostError,
    RecordingError,
    SpeedupError,
    VehicleError,
    WorldError,
)
