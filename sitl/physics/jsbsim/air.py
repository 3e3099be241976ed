# SPDX-License-Identifier: BSD-3-Clause
"""The air of a JSBSim: its standard atmosphere, wind, and its turbulence (MIL-F-8785C).

JSBSim's turbulence takes heights above the sea for heights above the ground. So the sea level of this JSBSim is the
floor under the vehicle, and its atmosphere has there the pressure and temperature of the true height.
"""

from __future__ import annotations

from ..native.atmosphere import SEA_LEVEL_TEMPERATURE, pressure, temperature
from .craft import FOOT, PASCALS, RANKINE, Properties

_NONE, _MILSPEC = 0.0, 3.0


class Air:
    """What the vehicle flies in."""

    def __init__(self, properties: Properties) -> None:
        self._warmer = properties.writer("atmosphere/delta-T")
        self._pressure = properties.writer("atmosphere/P-sl-psf")
        self._wind = [properties.writer(f"atmosphere/wind-{axis}-fps") for axis in ("north", "east", "down")]
        self._model = properties.writer("atmosphere/turb-type")
        self._strength = properties.writer("atmosphere/turbulence/milspec/windspeed_at_20ft_AGL-fps")
        self._severity = properties.writer("atmosphere/turbulence/milspec/severity")
        self._seed = properties.writer("simulation/randomseed")
        self.wind: list[float] = []
        """That blows, NED [m/s]."""
        self.turbulence = 0.0
        """Standard deviation of its vertical axis [m/s]."""
        self.has_stirred = False
        """There has been turbulence; its filters cannot be emptied."""

    def settle(self, altitude: float) -> None:
        """Be the air over a floor at this altitude above mean sea level [m]."""
        self._warmer((temperature(altitude) - SEA_LEVEL_TEMPERATURE) / RANKINE)
        self._pressure(pressure(altitude) / PASCALS)

    def seed(self, number: int) -> None:
        """Let the random numbers of turbulence begin anew."""
        self._seed(float(number % 2147483647))

    def blow(self, wind: list[float]) -> None:
        """Blow steadily: NED [m/s]."""
        self.wind = wind
        for write, speed in zip(self._wind, wind, strict=True):
            write(speed / FOOT)

    def stir(self, deviation: float) -> None:
        """Be turbulent, with this standard deviation of the vertical axis [m/s]; 0: not at all.

        Near the ground the standard takes it for a tenth of the wind at 20 ft; along the other axes it is larger, by
        less the higher the vehicle is.
        """
        self.turbulence = deviation
        self.has_stirred |= deviation > 0.0
        self._strength(10.0 * deviation / FOOT)
        self._severity(1.0)
        self._model(_MILSPEC if deviation > 0.0 else _NONE)

    def be_still(self) -> None:
        """No turbulence until the next ``stir``."""
        self._model(_NONE)
