# SPDX-License-Identifier: BSD-3-Clause
"""A companion that tells a vehicle in this process where it is (ODOMETRY), as visual odometry and motion capture do."""

from __future__ import annotations

import numpy as np

from ..core.algebra import rotate_inverse
from ..core.mavlink import MavFrame
from ..core.vectors import Vec3
from .companion import Companion
from .session import Session

UNKNOWN = [float("nan")] * 21
PARAMETERS: dict[str, float] = {
    "EK3_SRC1_POSXY": 6, "EK3_SRC1_VELXY": 6, "EK3_SRC1_POSZ": 6, "EK3_SRC1_VELZ": 6, "VISO_TYPE": 1, "GPS1_TYPE": 0,
}  # fmt: skip
"""With these a vehicle flies by odometry alone, with the compass for its heading."""


class Odometry(Companion):
    """Sends ODOMETRY ten times a second from the simulation's truth, from ``start`` to ``stop``.

    Positions count from where the vehicle was when this was made.

    Args:
        client: of a vehicle in this process, with VISO_TYPE 1.
        position_noise: standard deviation of each axis [m].
        velocity_noise: [m/s].
        drift: what the position wanders north and east with [m/s].
        seed: of the noise.
    """

    def __init__(
        self,
        client: Session,
        *,
        position_noise: float = 0.0,
        velocity_noise: float = 0.0,
        drift: tuple[float, float] = (0.0, 0.0),
        seed: int = 0,
    ) -> None:
        super().__init__(client)
        self._drift = drift
        self._noise = position_noise, velocity_noise
        self._random = np.random.default_rng(seed)
        self._from = Vec3(*client.simulation.v.physics.body.pos)
        self._since = client.now
        self.resets = 0
        """Reset counter: add 1 and move the position, and the estimate follows at once."""
        self.offset = Vec3(0.0, 0.0, 0.0)
        """Added to positions, NED [m]."""

    def send(self) -> None:
        """Send one message."""
        body, (at, speed), time = self.client.simulation.v.physics.body, self._noise, self.client.now - self._since
        draw = self._random.normal
        north, east = (rate * time for rate in self._drift)
        pos = body.pos - self._from + self.offset + Vec3(north, east, 0.0) + at * Vec3(*draw(size=3).tolist())
        vel = rotate_inverse(body.q, body.vel) + speed * Vec3(*draw(size=3).tolist())
        self.client.send(
            "ODOMETRY", frame_id=MavFrame.LOCAL_FRD, child_frame_id=MavFrame.BODY_FRD, x=pos.x, y=pos.y, z=pos.z,
            q=list(body.q),
            vx=vel.x, vy=vel.y, vz=vel.z, pose_covariance=UNKNOWN, velocity_covariance=UNKNOWN,
            reset_counter=self.resets % 256, estimator_type=2, quality=100,
        )  # fmt: skip
