# SPDX-License-Identifier: BSD-3-Clause
"""The commands: about the autopilot itself, and about the vehicle.

Commands about the vehicle that every firmware knows: arming, modes, outputs, locations, the mission.

Results as ArduPilot gives them.
"""

from __future__ import annotations

from ...autopilot.aux_switch import LOW
from ...autopilot.fence.checks import ALL, kinds, switch_by_user
from ...core.mavlink import ARM_FORCED, MavResult, MavSeverity
from ...core.scalars import constrain
from ..autopilot_api import LONGEST_US
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..locations import FRAMES_AMSL, GLOBAL_FRAMES
from ..telemetry.shell import banner
from . import calibration
from .calibration import CalibrationService
from .camera import CameraService
from .command import Command, Entry, answered, is_on_earth, result
from .compass_calibration import CompassCalibrationService
from .failure_injection import FaultService
from .gripper import GripperService
from .high_latency import HighLatencyService
from .home import HomeService
from .mount import MountService
from .other_commands import COMMANDS as OTHERS
from .outputs import OutputService
from .sprayer import SprayerService
from .statustext import StatusTextService
from .streams import StreamService

HOME_POSITION, AUTOPILOT_VERSION = message("HOME_POSITION").id, message("AUTOPILOT_VERSION").id


def set_interval(bridge: Host, channel: Channel, command: Command) -> int:
    """511: p1 message, p2 interval [us]: -1 stops, 0 default. DENIED: unknown, too fast."""
    return int(bridge.get(StreamService).set_interval(channel, command))


def get_interval(bridge: Host, channel: Channel, command: Command) -> int:
    """510: answers MESSAGE_INTERVAL for message p1."""
    return int(bridge.get(StreamService).get_interval(channel, command))


def request_message(bridge: Host, channel: Channel, command: Command) -> int:
    """512: sends message p1 once; FAILED when there is none."""
    return int(bridge.get(StreamService).request_message(channel, command))


def control_high_latency(bridge: Host, channel: Channel, command: Command) -> int:
    """2600: p1 1 sends HIGH_LATENCY2 on links of high latency, 0 does not; else FAILED."""
    if command.p1 not in (0.0, 1.0):
        return MavResult.FAILED
    bridge.get(HighLatencyService).switch(command.p1 != 0.0)
    return MavResult.ACCEPTED


def get_home(bridge: Host, channel: Channel, command: Command) -> int:
    """410 (old): answers HOME_POSITION."""
    if not bridge.vehicle.v.autopilot.home.is_set:
        return MavResult.FAILED
    return bridge.send_after_answer(channel, HOME_POSITION)


def request_version(bridge: Host, channel: Channel, command: Command) -> int:
    """520 (old): p1 must be 1, else FAILED; answers AUTOPILOT_VERSION."""
    if command.p1 != 1.0:
        return MavResult.FAILED
    return bridge.send_after_answer(channel, AUTOPILOT_VERSION)


def prearm_checks(bridge: Host, channel: Channel, command: Command) -> int:
    """401: the checks that fail now, as texts."""
    if bridge.autopilot.armed():
        return MavResult.TEMPORARILY_REJECTED
    bridge.autopilot.run_prearm_checks()
    bridge.say_pending()
    return MavResult.ACCEPTED


FORCE_REBOOT = 20190226.0


def reboot(bridge: Host, channel: Channel, command: Command) -> int:
    """246: p1 1 or 3 reboots the autopilot, when disarmed or when p6 is 20190226."""
    if bridge.autopilot.armed() and command.p6 != FORCE_REBOOT:
        return MavResult.FAILED
    if command.p1 not in (1.0, 3.0):
        return MavResult.UNSUPPORTED
    bridge.vehicle.request_reboot()
    return MavResult.ACCEPTED


POSITIONS_OF_ACCELEROMETER, LEVEL_TRIM, SIMPLE_ACCELEROMETER, SAVE = 1.0, 2.0, 4.0, 76.0
"""p5 of 241; SAVE: p2 or p5, what parameters hold counts as calibrated."""


def calibrate(bridge: Host, channel: Channel, command: Command) -> int:
    """241: p1 1 gyros, p3 1 barometer, p5 1 accelerometers in six positions, 2 level, 4 accelerometers level."""
    say, service = bridge.get(StatusTextService).say, bridge.get(CalibrationService)
    if bridge.autopilot.armed():
        say(MavSeverity.NOTICE, "Disarm to allow calibration")
        return MavResult.FAILED
    if command.p1 == 1.0 or command.p5 in (LEVEL_TRIM, SIMPLE_ACCELEROMETER):
        tasks = {LEVEL_TRIM: calibration.LEVEL, SIMPLE_ACCELEROMETER: calibration.SIMPLE}
        answer = service.start(calibration.GYROS if command.p1 == 1.0 else tasks[command.p5])
        if answer == MavResult.ACCEPTED:
            say(MavSeverity.INFO, "Initialising ArduPilot")
        return answer
    if command.p3 == 1.0:
        say(MavSeverity.INFO, "Updating barometer calibration")
        say(MavSeverity.INFO, "Barometer calibration complete")
        return MavResult.ACCEPTED
    if command.p5 == POSITIONS_OF_ACCELEROMETER:
        return int(service.start_positions())
    return MavResult.ACCEPTED if SAVE in (command.p2, command.p5) else MavResult.UNSUPPORTED


def accelerometer_position(bridge: Host, channel: Channel, command: Command) -> int:
    """42429: the vehicle is in position p1."""
    return int(bridge.get(CalibrationService).is_in_position(command.p1))


def storage(bridge: Host, channel: Channel, command: Command) -> int:
    """245: parameters and missions live as long as the process.

    There is no storage to read, write or reset.
    """
    return MavResult.DENIED


def calibrate_compass(bridge: Host, channel: Channel, command: Command) -> int:
    """42424: p1 bits of compasses (0 all), p2 again after a failure, p3 saves, p4 delay [s], p5 reboots then."""
    p = command
    return int(bridge.get(CompassCalibrationService).start(p.p1, p.p2 != 0.0, p.p3 != 0.0, p.p4, p.p5 != 0.0))


def accept_compass_calibration(bridge: Host, channel: Channel, command: Command) -> int:
    """42425: saves what was found of compasses p1."""
    return int(bridge.get(CompassCalibrationService).accept(command.p1))


def cancel_compass_calibration(bridge: Host, channel: Channel, command: Command) -> int:
    """42426: stops the calibration of compasses p1."""
    return int(bridge.get(CompassCalibrationService).cancel(command.p1))


def calibrate_compass_by_heading(bridge: Host, channel: Channel, command: Command) -> int:
    """42006: p1 heading [deg], p2 bits of compasses (0 all), p3 and p4 location [deg] (0, 0: where the vehicle is)."""
    return int(bridge.get(CompassCalibrationService).use_heading(command.p1, command.p2, command.p3, command.p4))


def send_banner(bridge: Host, channel: Channel, command: Command) -> int:
    """42428: the version as a text."""
    bridge.get(StatusTextService).say(MavSeverity.INFO, banner(bridge.profile))
    return MavResult.ACCEPTED


def reset_battery(bridge: Host, channel: Channel, command: Command) -> int:
    """42651: p1 bits of batteries, p2 charge left [%], within 0 .. 100; FAILED when that battery counts no current.

    Bits of batteries that are not there have no effect.
    """
    if int(command.p1) & 1 == 0:
        return MavResult.ACCEPTED
    return result(bridge.autopilot.set_battery_left(constrain(command.p2, 0.0, 100.0)))


def inject_failure(bridge: Host, channel: Channel, command: Command) -> int:
    """420: p1 FAILURE_UNIT, p2 FAILURE_TYPE (0 repairs), p3 instance (0 all); UNSUPPORTED while SYS_FAILURE_EN is 0."""
    return int(bridge.get(FaultService).command(command.p1, command.p2, command.p3))


FORCE_ARM = 2989.0
CHANGE_MODE = 1
"""MAV_DO_REPOSITION_FLAGS_CHANGE_MODE"""


def arm_disarm(bridge: Host, channel: Channel, command: Command) -> int:
    """400: p1 1 arms, 0 disarms; p2 2989 or 21196 forces arming, 21196 disarming in the air."""
    if command.p1 == 1.0:
        ok = bridge.autopilot.armed() or bridge.autopilot.arm(command.p2 in (FORCE_ARM, ARM_FORCED))
    elif command.p1 == 0.0:
        ok = not bridge.autopilot.armed() or bridge.autopilot.disarm(command.p2 == ARM_FORCED)
    else:
        return MavResult.UNSUPPORTED
    return answered(bridge, ok)


def set_mode(bridge: Host, number: int) -> int:
    """Change to a mode by ArduPilot's number and say why not."""
    return answered(bridge, bridge.autopilot.set_mode(number))


def do_set_mode(bridge: Host, channel: Channel, command: Command) -> int:
    """176: p1 must have MAV_MODE_FLAG_CUSTOM_MODE_ENABLED (else DENIED), p2 is the mode's number (else FAILED)."""
    if not 0.0 <= command.p1 < 256.0 or not int(command.p1) & 1:
        return MavResult.DENIED
    if not 0.0 <= command.p2 < 2.0**32:
        return MavResult.FAILED
    return set_mode(bridge, int(command.p2))


def aux_function(bridge: Host, channel: Channel, command: Command) -> int:
    """218: p1 function of a switch, p2 0 low, 1 middle, 2 high."""
    if command.p2 not in (0.0, 1.0, 2.0) or command.p1 != int(command.p1):
        return MavResult.DENIED
    return answered(bridge, bridge.autopilot.run_aux_function(int(command.p1), LOW + int(command.p2)))


def return_to_launch(bridge: Host, channel: Channel, command: Command) -> int:
    """20: changes to RTL; FAILED when the mode cannot be entered."""
    return set_mode(bridge, bridge.profile.rtl)


def set_servo(bridge: Host, channel: Channel, command: Command) -> int:
    """183: p1 output (those of motors are refused), p2 pulse, 0 .. 3000 us, else DENIED."""
    if not 0.0 <= command.p2 <= LONGEST_US:
        return MavResult.DENIED
    return result(bridge.get(OutputService).set_servo(int(command.p1), int(command.p2)))


def repeat_servo(bridge: Host, channel: Channel, command: Command) -> int:
    """184: p1 output, p2 pulse, 0 .. 3000 us, by turns with SERVOn_TRIM, p3 times (below 0 for ever), each p4 [s]."""
    if not 0.0 <= command.p2 <= LONGEST_US or not abs(command.p3) <= MANY:
        return MavResult.DENIED
    outputs, number = bridge.get(OutputService), int(command.p1)
    return result(outputs.repeat_servo(number, int(command.p2), int(command.p3), command.p4))


def set_relay(bridge: Host, channel: Channel, command: Command) -> int:
    """181: p1 relay, from 0, p2 0 off, 1 on, others the other way; FAILED without RELAYn_FUNCTION 1."""
    return result(bridge.get(OutputService).set_relay(int(command.p1), command.p2))


def repeat_relay(bridge: Host, channel: Channel, command: Command) -> int:
    """182: p1 relay, from 0, the other way and back p2 times (below 0 for ever), each p3 [s]."""
    if not abs(command.p2) <= MANY:
        return MavResult.DENIED
    done = bridge.get(OutputService).repeat_relay(int(command.p1), int(command.p2), command.p3)
    return result(done)


MANY = 32767.0
"""Times that something can be repeated."""


def configure_camera(bridge: Host, channel: Channel, command: Command) -> int:
    """202: with CAM1_TYPE 5 passed on to other components of the vehicle; else no effect."""
    c = command
    bridge.get(CameraService).configure((c.p1, c.p2, c.p3, c.p4, c.p5, c.p6, c.z))
    return MavResult.ACCEPTED


def control_camera(bridge: Host, channel: Channel, command: Command) -> int:
    """203: p5 1 takes a picture; with CAM1_TYPE 5 passed on to other components; no effect without a camera."""
    c = command
    bridge.get(CameraService).control((c.p1, c.p2, c.p3, c.p4, c.p5, c.p6))
    return MavResult.ACCEPTED


def set_camera_distance(bridge: Host, channel: Channel, command: Command) -> int:
    """206: a picture each p1 [m] (0: none), p3 1 one at once; no effect without a camera."""
    bridge.get(CameraService).set_distance(command.p1, command.p3 == 1.0)
    return MavResult.ACCEPTED


def start_pictures(bridge: Host, channel: Channel, command: Command) -> int:
    """2000: p1 camera (0 all, 1), p2 interval [s], p3 pictures (0 for ever; if p2 is 0, one); FAILED without camera."""
    return int(bridge.get(CameraService).start(command.p1, command.p2, command.p3))


def stop_pictures(bridge: Host, channel: Channel, command: Command) -> int:
    """2001: p1 camera (0 all, 1): ends what 2000 began."""
    return int(bridge.get(CameraService).stop(command.p1))


def grip(bridge: Host, channel: Channel, command: Command) -> int:
    """211: p2 0 opens the gripper, 1 closes it; FAILED without GRIP_ENABLE and GRIP_TYPE 1 or 2."""
    return int(bridge.get(GripperService).act(command.p2))


def spray(bridge: Host, channel: Channel, command: Command) -> int:
    """216: p1 1 runs the sprayer, 0 ends it; no effect without SPRAY_ENABLE."""
    bridge.get(SprayerService).act(command.p1)
    return MavResult.ACCEPTED


def configure_mount(bridge: Host, channel: Channel, command: Command) -> int:
    """204 (old): p1 mode of the gimbal, as for 205; FAILED without MNT1_TYPE 1."""
    return int(bridge.get(MountService).configure(command.p1))


def control_mount(bridge: Host, channel: Channel, command: Command) -> int:
    """205: p1 pitch, p2 roll, p3 yaw [deg]; p7 0 folds, 1 neutral, 2 these angles, 3 sticks, 4 last location,
    6 home."""
    return int(bridge.get(MountService).control(command.p1, command.p2, command.p3, command.z))


def pitch_and_yaw(bridge: Host, channel: Channel, command: Command) -> int:
    """1000: p1 pitch, p2 yaw [deg], or NaN and p3, p4 their rates [deg/s]; p5 flags, p7 gimbal (0, 1)."""
    c = command
    return int(bridge.get(MountService).pitch_yaw(c.p1, c.p2, c.p3, c.p4, c.p5, c.z))


def control_gimbal(bridge: Host, channel: Channel, command: Command) -> int:
    """1001: p1 system and p2 component that have primary control of the gimbal; -2: the sender."""
    return int(bridge.get(MountService).give_control(command.p1, command.p2, command.sender))


def follow_system(bridge: Host, channel: Channel, command: Command) -> int:
    """198: taken; the gimbal does not follow other vehicles here."""
    return MavResult.ACCEPTED


def look_at(bridge: Host, channel: Channel, command: Command) -> int:
    """195, 201: the gimbal points at a location; all zero ends it."""
    if command.frame not in GLOBAL_FRAMES:
        return MavResult.DENIED
    if not is_on_earth(command.lat, command.lon):
        return MavResult.FAILED
    mount = bridge.get(MountService)
    if command.lat == 0 and command.lon == 0 and command.z == 0.0:
        mount.look_ahead()
    else:
        alt = bridge.locations.alt(command.lat, command.lon, command.z, command.frame)
        if alt is None:
            return MavResult.FAILED
        mount.look_at(command.lat, command.lon, alt)
    return MavResult.ACCEPTED


def look_ahead(bridge: Host, channel: Channel, command: Command) -> int:
    """197: the gimbal returns to the mode of MNT1_DEFLT_MODE."""
    bridge.get(MountService).look_ahead()
    return MavResult.ACCEPTED


def reposition(bridge: Host, channel: Channel, command: Command) -> int:
    """192: go to a location in GUIDED; p2 bit 1 changes to GUIDED first (else DENIED in another mode).

    The location is refused before the mode is changed. p1 is the speed [m/s] of a rover that drives to a location
    already (FAILED to one that stands or is steered), and nothing to a copter.
    """
    if command.frame not in GLOBAL_FRAMES:
        bridge.get(StatusTextService).say(MavSeverity.WARNING, f"Unknown mavlink coordinate frame {command.frame}")
        return MavResult.DENIED
    if command.lat == 0 and command.lon == 0:
        return MavResult.DENIED
    in_guided = bridge.autopilot.mode() == bridge.profile.guided
    if not in_guided and not (0.0 <= command.p2 < 2.0**31 and int(command.p2) & CHANGE_MODE):
        return MavResult.DENIED
    position = bridge.locations.ned(command.lat, command.lon, command.z, command.frame)
    if position is None:
        return MavResult.FAILED
    if not in_guided and set_mode(bridge, bridge.profile.guided) != MavResult.ACCEPTED:
        return MavResult.FAILED
    if command.p1 > 0.0 and not bridge.autopilot.change_reposition_speed(command.p1):
        return MavResult.FAILED
    return result(bridge.autopilot.guided_position(position))


def set_home(bridge: Host, channel: Channel, command: Command) -> int:
    """179: p1 1 (or latitude and longitude zero): here; else the location given."""
    if command.p1 == 1.0 or (command.lat == 0 and command.lon == 0):
        return _home_result(bridge, bridge.autopilot.set_home_here())
    if command.frame not in GLOBAL_FRAMES and command.p1 == 0.0:
        return MavResult.DENIED
    if command.p1 != 0.0 or not is_on_earth(command.lat, command.lon):
        return MavResult.FAILED
    alt = bridge.locations.alt(command.lat, command.lon, command.z, command.frame)
    if alt is None:
        return MavResult.FAILED
    return _home_result(bridge, bridge.autopilot.set_home(command.lat, command.lon, alt))


def set_origin(bridge: Host, channel: Channel, command: Command) -> int:
    """611: the estimator's origin; FAILED when it has one already."""
    if command.frame not in GLOBAL_FRAMES or not is_on_earth(command.lat, command.lon):
        return MavResult.DENIED
    if bridge.vehicle.v.autopilot.estimate.origin_set:
        return MavResult.FAILED
    if command.frame not in FRAMES_AMSL or (command.lat == 0 and command.lon == 0):
        return MavResult.DENIED  # a height over what is not known yet, or a location that nobody means
    return _home_result(bridge, bridge.autopilot.set_origin(command.lat, command.lon, command.z))


def _home_result(bridge: Host, ok: bool) -> int:
    bridge.say_pending()
    if ok:
        bridge.get(HomeService).report_changes()
    return result(ok)


def enable_fence(bridge: Host, channel: Channel, command: Command) -> int:
    """207: p1 1 switches fences on, 0 off; p2 which (bits as of FENCE_TYPE), 0 all."""
    if not 0.0 <= command.p1 <= 2.0 or not 0.0 <= command.p2 <= ALL:
        return MavResult.FAILED
    which = int(command.p2) if command.p2 > 0.0 else ALL
    v = bridge.vehicle.v
    ap = v.autopilot
    if command.p1 >= 1.0 and command.p2 > 0.0 and which & kinds(ap.fence, ap.params.FENCE) == 0:
        return MavResult.FAILED
    switch_by_user(ap.fence, int(command.p1) == 1, which, ap.params.FENCE, ap.events, v.time_us)
    return MavResult.ACCEPTED


def mission_start(bridge: Host, channel: Channel, command: Command) -> int:
    """300: AUTO from the beginning; p1, p2 (first and last item) must be zero."""
    if command.p1 != 0.0 or command.p2 != 0.0:
        return MavResult.DENIED
    return answered(bridge, bridge.autopilot.start_mission())


def set_mission_current(bridge: Host, channel: Channel, command: Command) -> int:
    """224: p1 number of the item (0: the first); in AUTO p2 1 runs a complete mission again; DENIED without it, FAILED
    where there is no mission."""
    seq, count = int(command.p1), len(bridge.autopilot.mission_items())
    if not 0 <= seq < max(count, 1):
        return MavResult.DENIED
    return answered(bridge, bridge.autopilot.set_current_item(seq, command.p2 == 1.0))


def jump_to_tag(bridge: Host, channel: Channel, command: Command) -> int:
    """601: p1 the tag of a JUMP_TAG of the mission, which goes on there; FAILED without it."""
    if not 0.0 <= command.p1 <= 65535.0:
        return MavResult.DENIED
    return answered(bridge, bridge.autopilot.jump_to_tag(int(command.p1)))


def choose_sources(bridge: Host, channel: Channel, command: Command) -> int:
    """42007: p1 the set of sources of the estimator, 1 .. 3 (EK3_SRC1_* ..)."""
    if command.p1 not in (1.0, 2.0, 3.0):
        return MavResult.DENIED
    bridge.autopilot.choose_sources(int(command.p1) - 1)
    return MavResult.ACCEPTED


COMMANDS: dict[int, Entry] = {
    241: Entry(calibrate),
    245: Entry(storage),
    246: Entry(reboot, required=(1,)),
    401: Entry(prearm_checks),
    601: Entry(jump_to_tag),
    42007: Entry(choose_sources, required=(1,)),
    420: Entry(inject_failure, required=(1, 2)),
    42006: Entry(calibrate_compass_by_heading, required=(1,)),
    42424: Entry(calibrate_compass),
    42425: Entry(accept_compass_calibration),
    42426: Entry(cancel_compass_calibration),
    42428: Entry(send_banner),
    42429: Entry(accelerometer_position, required=(1,)),
    42651: Entry(reset_battery, required=(1, 2)),
    410: Entry(get_home),
    510: Entry(get_interval, required=(1,)),
    511: Entry(set_interval, required=(1, 2)),
    512: Entry(request_message, required=(1,)),
    1000: Entry(pitch_and_yaw, takes_nan=True),
    1001: Entry(control_gimbal),
    2000: Entry(start_pictures),
    2001: Entry(stop_pictures),
    2600: Entry(control_high_latency, required=(1,)),
    520: Entry(request_version, required=(1,)),
    20: Entry(return_to_launch),
    176: Entry(do_set_mode, required=(1, 2)),
    179: Entry(set_home, required=(5, 6, 7), has_location=True, off_earth=True, long_frame=0),
    181: Entry(set_relay, required=(1, 2)),
    182: Entry(repeat_relay, required=(1, 2, 3)),
    183: Entry(set_servo, required=(1, 2)),
    184: Entry(repeat_servo, required=(1, 2, 3, 4)),
    192: Entry(reposition, required=(5, 6, 7), has_location=True, int_only=True),
    202: Entry(configure_camera),
    203: Entry(control_camera),
    206: Entry(set_camera_distance, required=(1,)),
    195: Entry(look_at, has_location=True, off_earth=True),
    197: Entry(look_ahead),
    198: Entry(follow_system),
    201: Entry(look_at, has_location=True, off_earth=True),
    204: Entry(configure_mount),
    205: Entry(control_mount),
    207: Entry(enable_fence, required=(1,)),
    211: Entry(grip),
    216: Entry(spray),
    218: Entry(aux_function, required=(1, 2)),
    224: Entry(set_mission_current, required=(1,)),
    300: Entry(mission_start),
    400: Entry(arm_disarm, required=(1,)),
    611: Entry(set_origin, required=(5, 6, 7), has_location=True, int_only=True),
    **OTHERS,
}
