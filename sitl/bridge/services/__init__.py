# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink's microservices (https://mavlink.io/en/services/)."""

from .calibration import CalibrationService
from .camera import CameraService
from .command_protocol import CommandService
from .compass_calibration import CompassCalibrationService
from .config_error import ConfigErrorService
from .failure_injection import FaultService
from .flight_state import FlightStateService
from .ftp import FtpService
from .gripper import GripperService
from .high_latency import HighLatencyService
from .home import HomeService
from .liveness import HeartbeatService, PingService, TimesyncService
from .log_download import LogDownloadService
from .mission_protocol import MissionService
from .motor_test import MotorTestService
from .mount import MountService
from .old_points import OldPointService
from .outputs import OutputService
from .parachute import ParachuteService
from .parameter_protocol import ParameterService
from .senders import SenderService
from .service import Service
from .setpoint_messages import SetpointService
from .signing import SigningService
from .sprayer import SprayerService
from .statustext import EventService, PreArmService, StatusTextService
from .streams import StreamService
from .terrain_protocol import TerrainService
from .tuning import TuningService
from .winch import WinchService

ALL_SERVICES: tuple[type[Service], ...] = (
    StatusTextService,
    HeartbeatService,
    StreamService,
    HighLatencyService,
    CommandService,
    ParameterService,
    MissionService,
    OldPointService,
    SetpointService,
    HomeService,
    TimesyncService,
    PingService,
    EventService,
    PreArmService,
    ConfigErrorService,
    FtpService,
    LogDownloadService,
    OutputService,
    CameraService,
    GripperService,
    WinchService,
    SprayerService,
    ParachuteService,
    MountService,
    MotorTestService,
    CalibrationService,
    CompassCalibrationService,
    SigningService,
    SenderService,
    FaultService,
    TerrainService,
    FlightStateService,
    TuningService,
)
"""In the order in which they act when several are due at the same time."""
_registered: list[type[Service]] = []


def register_service(service: type[Service]) -> None:
    """Make a service of another package known in this process: every bridge that is made later has it.

    Raises:
        TypeError: it is no subclass of ``Service``.
    """
    if not (isinstance(service, type) and issubclass(service, Service)):
        raise TypeError(f"{service!r} is no subclass of sitl.bridge.services.service.Service")
    if service not in _registered:
        _registered.append(service)


def all_services() -> tuple[type[Service], ...]:
    """Our services, then those of other packages."""
    return (*ALL_SERVICES, *_registered)
