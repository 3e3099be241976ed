# SPDX-License-Identifier: BSD-3-Clause
"""The record of parameters that every firmware has."""

from __future__ import annotations

from typing import Any, ClassVar

from ...core.border import RC_INPUTS
from ...core.record_reader import locate
from ...core.records import Records
from .avoidance import Avoid, PathPlanning, Proximity, ProximitySensor
from .estimator import Ekf3
from .fence_parameters import Fence, Rally
from .follow_parameters import Follow
from .parameter import INT8, INT16, ParameterGroup, numbered, param, rows
from .precision_landing import PrecisionLanding
from .radio import RcChannel, RcMap
from .simulation import Simulated
from .system import Ahrs, Arming, Battery, Compass, Failsafes, Inertial, Log, Mavlink, Mission, Statistics, StreamRates
from .without_gps import Flow, RangeFinder, VisualOdometry

_BYTES = 8
"""Of a parameter."""


class Parameters(ParameterGroup):
    """The parameters that every firmware has. A firmware's own record names all of its own in the order of the wire.

    In plain Python a parameter is also there under its full name, as an item and as an attribute:
    ``params["ATC_RAT_RLL_P"]``, ``params.ATC_RAT_RLL_P``. Laws use the path: ``params.ATC.RAT_RLL.P``.
    """

    AHRS: Ahrs
    ARMING: Arming
    AVOID: Avoid
    BARO_PRIMARY: float = param(0, -128, 127, "", "Barometer that counts while it is healthy: 0 or 1", INT8)
    BATT: Battery
    COMPASS: Compass
    EK3: Ekf3
    FENCE: Fence
    FLOW: Flow
    FOLL: Follow
    FS: Failsafes
    GPS1_TYPE: float = param(1, -128, 127, "", "0: there is no GPS receiver, and arming needs none", INT8)
    GPS1_DELAY_MS: float = param(0, 0, 350, "ms", "age of a fix when it arrives; 0: the usual 120 ms", INT16)
    GPS2_TYPE: float = param(0, -128, 127, "", "0: there is no second GPS receiver", INT8)
    GPS2_DELAY_MS: float = param(0, 0, 350, "ms", "age of a fix of the second receiver; 0: the usual 120 ms", INT16)
    GPS_AUTO_SWITCH: float = param(
        1, 0, 4, "", "Of two receivers: 0 GPS_PRIMARY, 1 the better one, 4 GPS_PRIMARY while it has a 3D fix; no other",
        INT8,
    )  # fmt: skip
    GPS_PRIMARY: float = param(0, 0, 1, "", "Receiver of GPS_AUTO_SWITCH 0 and 4: 0 the first, 1 the second", INT8)
    INITIAL_MODE: float = param(0, 0, 127, "", "Mode after boot, until the mode channel says another", INT8)
    INS: Inertial
    LOG: Log
    MAV: Mavlink
    MAV1: StreamRates
    MIS: Mission
    OA: PathPlanning
    PLND: PrecisionLanding
    PRX: Proximity
    PRX1: ProximitySensor
    RALLY: Rally
    RC: Records[RcChannel] = numbered(RcChannel, RC_INPUTS, DZ=(20, 20, 30, 20) + 12 * (0,))
    RC_OVERRIDE_TIME: float = param(
        3.0, -1.0, 120.0, "s", "Overrides from the ground station are good for so long; -1 for ever, 0 never"
    )
    RCMAP: RcMap
    RNGFND1: RangeFinder
    SCHED_LOOP_RATE: float = param(
        400.0, 0, 400.0, "Hz", "Rate of the main loop; this firmware runs at 400 Hz only", INT16
    )
    SIM: Simulated
    STAT: Statistics
    VISO: VisualOdometry

    indices: ClassVar[dict[str, int]]
    """Name -> index among ``numbers``."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls.indices = {row.name: locate(cls.dtype, row.path)[0] // _BYTES for row in rows(cls)}
        for name, k in cls.indices.items():
            if name not in cls.fields:
                setattr(cls, name, _by_full_name(k))

    @property
    def numbers(self) -> Any:
        """All values, float64."""
        return self._f8


def _by_full_name(k: int) -> property:
    def write(self: Any, value: float) -> None:
        self._f8[k] = value

    return property(lambda self: self._f8[k], write)
