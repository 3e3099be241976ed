# SPDX-License-Identifier: BSD-3-Clause
"""The copter's parameters."""

from __future__ import annotations

from ..params.table import collect
from . import parameters

TABLE = collect(parameters, {})
