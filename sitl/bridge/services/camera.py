# SPDX-License-Identifier: BSD-3-Clause
"""The camera (CAM1_*): a servo output or a relay triggers it, or commands to other components of the vehicle.

Whether there is one, CAM1_TYPE says at boot. No image is made: a picture is counted, and CAMERA_FEEDBACK reports it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from sitl.core.constants import NEVER
from sitl.core.elementary import hypot
from sitl.core.mavlink import MavCmd, MavResult

from ...autopilot import camera, relays
from ...autopilot.mission.item import MissionItem
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from ..telemetry.motion import global_position
from .liveness import HeartbeatService
from .service import Handler, StatefulService

FEEDBACK, COMMAND_LONG = message("CAMERA_FEEDBACK"), message("COMMAND_LONG")
EVERY_US = 20_000
"""ArduPilot looks 50 times a second."""
FOR_EVER = -1
MOST = 32767.0
"""Pictures that one command can ask for."""
LONGEST = 1e6
"""Longest time [s]."""


class State(NamedTuple):
    """What a camera has done and has still to do. Times since boot [us]."""

    feedback: bytes
    """CAMERA_FEEDBACK of the last picture."""
    pictures: int = 0
    taken_us: int | None = None
    """When the last one was taken."""
    position: tuple[float, float] | None = None
    """Where, from the estimator's origin [m]; without a picture: where counting the distance began."""
    off_us: int = 0
    """When the output goes back."""
    every_us: int = 0
    left: int = 0
    """Pictures still to take, one each ``every_us``."""
    is_waiting: bool = False
    """One was asked for too soon after another (CAM1_INTRVAL_MIN)."""


class CameraService(StatefulService):
    """The camera."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._values = bridge.vehicle.parameters
        self.kind = int(self._values["CAM1_TYPE"]) if "CAM1_TYPE" in self._values.table else camera.NO_CAMERA
        if self.kind not in (camera.BY_SERVO, camera.BY_RELAY, camera.BY_MAVLINK):
            self.kind = camera.NO_CAMERA
        self._state = State(FEEDBACK.payload())
        self.due_us = NEVER if self.kind == camera.NO_CAMERA else 0

    def handlers(self) -> dict[str, Handler]:
        return {"DIGICAM_CONTROL": self._digicam_control, "DIGICAM_CONFIGURE": self._digicam_configure}

    def messages(self) -> dict[str, Callable[[], bytes]]:
        return {} if self.kind == camera.NO_CAMERA else {FEEDBACK.name: self.feedback}

    def feedback(self) -> bytes:
        """CAMERA_FEEDBACK: location, attitude [deg] and time of the last picture; with CAM1_TYPE at boot."""
        return self._state.feedback

    # ------------------------------------------------------------------ what it is asked

    def _digicam_control(self, channel: Channel, m: Any, sender: Sender) -> None:
        self.control((m.session, m.zoom_pos, m.zoom_step, m.focus_lock, m.shot, m.command_id))

    def _digicam_configure(self, channel: Channel, m: Any, sender: Sender) -> None:
        exposure = (m.mode, m.shutter_speed, m.aperture, m.iso, m.exposure_type, m.command_id, m.engine_cut_off)
        self.configure(exposure)

    def carry_out(self, item: MissionItem) -> None:
        """A camera command of a mission."""
        if item.command == MavCmd.DO_DIGICAM_CONFIGURE:
            self.configure((item.p1, item.p2, item.p3, item.p4, item.x, item.y, item.z))
        elif item.command == MavCmd.DO_DIGICAM_CONTROL:
            self.control((item.p1, item.p2, item.p3, item.p4, item.x, item.y))
        elif item.command == MavCmd.DO_SET_CAM_TRIGG_DIST:
            self.set_distance(item.p1, item.p3 == 1.0)
        elif item.command == MavCmd.IMAGE_START_CAPTURE:
            self.start(item.p1, item.p2, item.p3)
        else:
            self.stop(item.p1)

    def control(self, params: Sequence[float]) -> None:
        """Session, zoom position, zoom step, focus lock, shot (1: a picture), identification of the command."""
        if self.kind == camera.BY_MAVLINK:
            self._pass_on(MavCmd.DO_DIGICAM_CONTROL, params)
        elif params[4] == 1.0:
            self.take_picture()

    def configure(self, params: Sequence[float]) -> None:
        """DO_DIGICAM_CONFIGURE's parameters: only a component can do something with them."""
        if self.kind == camera.BY_MAVLINK:
            self._pass_on(MavCmd.DO_DIGICAM_CONFIGURE, params)

    def _pass_on(self, number: int, params: Sequence[float]) -> None:
        fields = {f"param{k}": float(value) for k, value in enumerate(params, start=1)}
        self.bridge.get(HeartbeatService).to_components(COMMAND_LONG, COMMAND_LONG.payload(command=number, **fields))

    def set_distance(self, distance: float, at_once: bool) -> None:
        """A picture each ``distance`` [m] (0: no more), and one ``at_once``."""
        if self.kind != camera.NO_CAMERA:
            self._values["CAM1_TRIGG_DIST"] = distance
            if at_once:
                self.take_picture()

    def start(self, number: float, interval: float, count: float) -> int:
        """``count`` pictures (0: for ever), one each ``interval`` [s]; a single one at once. Its MAV_RESULT."""
        if number < 0.0:
            return MavResult.UNSUPPORTED
        if not (0.0 <= interval <= LONGEST and 0.0 <= count <= MOST):
            return MavResult.DENIED
        if not self._is(number):
            return MavResult.FAILED
        if count == 1.0 or (interval == 0.0 and count == 0.0):
            return MavResult.ACCEPTED if self.take_picture() else MavResult.FAILED
        self._state = self._state._replace(every_us=round(interval * 1e6), left=int(count) or FOR_EVER)
        return MavResult.ACCEPTED

    def stop(self, number: float) -> int:
        """No more pictures of ``start``. Its MAV_RESULT."""
        if number != 0.0 and not self._is(number):
            return MavResult.UNSUPPORTED
        self._state = self._state._replace(left=0)
        return MavResult.ACCEPTED

    def _is(self, number: float) -> bool:
        """Whether there is a camera of this number; 0: all."""
        return self.kind != camera.NO_CAMERA and number in (0.0, 1.0)

    # ------------------------------------------------------------------ pictures

    def take_picture(self) -> bool:
        """Take one now; False without a camera, and too soon after another: then it is taken as soon as may be."""
        now, state = self.bridge.now_us, self._state
        if self.kind == camera.NO_CAMERA:
            return False
        if state.taken_us is not None and now - state.taken_us < self._us("CAM1_INTRVAL_MIN"):
            self._state = state._replace(is_waiting=True)
            return False
        off_us = now + self._us("CAM1_DURATION")
        pos, count = self.bridge.vehicle.v.autopilot.estimate.pos, state.pictures + 1
        self._state = state._replace(
            feedback=self._report(count), pictures=count, taken_us=now, position=(float(pos.x), float(pos.y)),
            off_us=off_us, is_waiting=False,
        )  # fmt: skip
        if self.kind == camera.BY_MAVLINK:
            self._pass_on(MavCmd.DO_DIGICAM_CONTROL, (0.0, 0.0, 0.0, 0.0, 1.0, 0.0))
        self._drive(now)
        self.due_us = min(self.due_us, max(off_us, now + 1))
        self.bridge.send_to_all(FEEDBACK.id)
        return True

    def _us(self, name: str) -> int:
        return round(min(max(self._values[name], 0.0), LONGEST) * 1e6)

    def _report(self, count: int) -> bytes:
        v = self.bridge.vehicle.v
        here, euler, home = global_position(v), v.autopilot.estimate.euler, v.autopilot.home
        return FEEDBACK.payload(
            time_usec=self.bridge.epoch_us + self.bridge.elapsed_us,
            lat=int(here.lat),
            lng=int(here.lon),
            alt_msl=float(here.alt),
            alt_rel=float(here.alt - home.alt) if home.is_set else 0.0,
            roll=math.degrees(euler.roll),
            pitch=math.degrees(euler.pitch),
            yaw=math.degrees(euler.yaw) % 360.0,
            img_idx=count & 0xFFFF,
        )

    def _drive(self, now_us: int) -> None:
        """The pulses of its outputs, or its relays, as they have to be now."""
        on = now_us < self._state.off_us
        if self.kind == camera.BY_SERVO:
            pulse = int(self._values["CAM1_SERVO_ON" if on else "CAM1_SERVO_OFF"])
            for number in range(1, camera.OUTPUTS + 1):
                if self._values[f"SERVO{number}_FUNCTION"] == camera.TRIGGER:
                    self.bridge.autopilot.set_servo(number, pulse)
        elif self.kind == camera.BY_RELAY:
            for relay in relays.of_camera(self._values):
                relays.switch(self._values, relay, on == (self._values["CAM1_RELAY_ON"] != 0.0))

    def service(self, now_us: int) -> None:
        state = self._state
        if state.is_waiting:
            self.take_picture()
        elif state.left != 0 and (state.taken_us is None or now_us - state.taken_us >= state.every_us):
            if self.take_picture():
                left = state.left - 1 if state.left > 0 else FOR_EVER
                self._state = self._state._replace(left=left)
        self._look_at_distance()
        self._drive(now_us)
        off_us = self._state.off_us
        self.due_us = min(now_us + EVERY_US, off_us if off_us > now_us else NEVER)

    def _look_at_distance(self) -> None:
        distance, estimate = self._values["CAM1_TRIGG_DIST"], self.bridge.vehicle.v.autopilot.estimate
        position = self._state.position
        if not distance > 0.0:
            if position is not None:
                self._state = self._state._replace(position=None)
        elif estimate.position_ok:
            x, y = float(estimate.pos.x), float(estimate.pos.y)
            if position is None:
                self._state = self._state._replace(position=(x, y))
            elif hypot(x - position[0], y - position[1]) >= distance:
                self.take_picture()
