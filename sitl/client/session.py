# SPDX-License-Identifier: BSD-3-Clause
"""Time, messages and commands of one vehicle: what all of the client is made with."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NoReturn, Protocol

from ..bridge.dialect import message
from ..core.mavlink import MavAutopilot
from ..errors import OptionError, did_you_mean
from . import px4
from .commands import arguments, command_name, command_number, constant, entry_name
from .connection import Connection, InProcess, connect
from .endpoint import AUTOPILOT
from .errors import (
    ClientError,
    CommandRefusedError,
    ImpossibleWaitError,
    InvariantError,
    UnknownNameError,
    WaitTimeoutError,
)
from .telemetry import Attitude, Position, Telemetry, Text

if TYPE_CHECKING:
    from ..bridge.links import LinkFaults
    from ..simulation import Simulation

__tracebackhide__ = True  # pytest shows the line of the test, not ours

RATES_HZ = {"HEARTBEAT": 10, "GLOBAL_POSITION_INT": 10, "ATTITUDE": 10, "SYS_STATUS": 2, "EKF_STATUS_REPORT": 2}
"""What is asked for, and how often."""
STEP_US = 100_000
"""Waits look ten times a second [simulated us]."""
HEARTBEAT_US = 1_000_000
"""Between two heartbeats of the client."""
REPEAT_US = 500_000
"""Between two sendings of what a vehicle forgets soon (velocities, sticks), or has not answered."""
ANSWER_S = 5.0
"""A command is answered within."""
ASK_AGAIN_US = 1_000_000
"""Messages whose rates were not acknowledged are asked for again after this."""
SILENCE_S = 1.0
"""When nothing has come for so long, what is missing is asked for again."""
LIMIT_S = 15.0
"""A piece of something that was missing comes within."""
TEXTS_SHOWN = 8
"""As many status texts stand in an error."""
_OURS, _PX4S = "EKF_STATUS_REPORT", "ESTIMATOR_STATUS"
"""Which of its estimates are good, by ArduPilot and by PX4."""
_HEARTBEAT, _SET_INTERVAL = "heartbeat", command_number("SET_MESSAGE_INTERVAL")
_REQUEST, _MODES = command_number("REQUEST_MESSAGE"), message("AVAILABLE_MODES")
Repeated = tuple[str, dict[str, Any]]
"""A message that is sent again and again: its name, its fields."""


class OnBoard(Protocol):
    """Another program on board of the vehicle (``Companion`` is the base of such): it acts while a client lets time
    pass."""

    def step(self, now_us: int) -> None:
        """A step of the client's time has gone by; now it is ``now_us`` since the start."""
        ...

    def take(self, name: str, fields: Any) -> None:
        """A message of the vehicle has come."""
        ...

    def state(self) -> dict[str, Any]:
        """What it knows besides its client: a copy."""
        ...

    def restored(self, state: dict[str, Any], client: Any) -> OnBoard:
        """This one, or for another client one like it, in that state."""
        ...


class Session:
    """Time, messages and commands of one vehicle.

    Time passes only in calls that wait: they go on in steps to whole tenths of a simulated second. Between two calls
    the vehicle stands still, unless it goes by a clock of its own.

    Args:
        vehicle: a simulation in this process, a form of connection ("udp:127.0.0.1:14550", "tcp:127.0.0.1:5760"), or a
            ``Connection``.
        name: of the vehicle, for errors.
        rates: what telemetry is asked for: rates [Hz] by message; None: ``RATES_HZ``.
        heartbeat: whether the vehicle gets a ground station's HEARTBEAT every second.
        patience: wall time [s] without a message after which a vehicle elsewhere is lost.
        link_faults: of the way to a vehicle in this process (``set_link_faults``).

    Raises:
        OptionError: no such form of connection; link faults, and the vehicle is not in this process.
        LinkLostError: no vehicle there.
    """

    def __init__(
        self,
        vehicle: Simulation | Connection | str,
        *,
        name: str = "vehicle",
        rates: Mapping[str, float] | None = None,
        heartbeat: bool = True,
        patience: float = 10.0,
        link_faults: LinkFaults | None = None,
    ) -> None:
        if link_faults is not None and isinstance(vehicle, str):
            raise OptionError(f"connection {vehicle}: its faults are options of the vehicle (sitl run --link-loss ...)")
        if isinstance(vehicle, str):
            vehicle = connect(vehicle, patience=patience)
        self.connection = vehicle if isinstance(vehicle, Connection) else InProcess(vehicle)
        self.name = name
        self.telemetry = Telemetry()
        self._rates = dict(RATES_HZ if rates is None else rates)
        self._asked_us, self._unanswered, self._awaited = 0, 0, set[str]()
        self._repeated: dict[str, Repeated] = {}
        self.companions: list[OnBoard] = []
        """Other programs on board that send messages (``sitl.client.odometry``)."""
        self._next_us = {_HEARTBEAT: 0} if heartbeat else {}
        self._texts_read = 0
        self._is_silent = False
        self._invariants: list[tuple[Callable[[], Any], str]] = []
        self._collected: list[tuple[str, list[Any]]] = []
        self._boots = self.connection.boots
        if link_faults is not None:
            self.set_link_faults(link_faults)
        self.connection.inbox.on_message = self._take
        if self.connection.simulation is not None:
            self.telemetry.mode_names = self.connection.simulation.firmware.mode_names
        self.ask_for_telemetry()
        if not self.connection.is_exact:
            self.step()  # its clock is known from now on

    def set_link_faults(self, faults: LinkFaults | None) -> None:
        """Let this client's link lose, delay or change frames from now on (docs/faults.md); None: no more.

        Raises:
            OptionError: the vehicle is not in this process.
        """
        self.simulation.set_link_faults(faults, self.connection.link)

    # ------------------------------------------------------------------ what is known

    @property
    def simulation(self) -> Simulation:
        """The vehicle itself.

        Raises:
            OptionError: it is not in this process.
        """
        if self.connection.simulation is None:
            raise UnknownNameError(f"connection {self.connection.name}: the vehicle is not in this process")
        return self.connection.simulation

    @property
    def now(self) -> float:
        """Simulated time since power-on [s]."""
        return self.connection.time_us / 1e6

    @property
    def system(self) -> int:
        """MAVLink id of the vehicle."""
        return self.connection.system

    @property
    def mode(self) -> str:
        """Flight mode by the last HEARTBEAT; "" before the first."""
        return self.telemetry.mode

    @property
    def armed(self) -> bool:
        """Whether it is armed by the last HEARTBEAT."""
        return self.telemetry.armed

    @property
    def position(self) -> Position:
        """North, east, altitude from home [m]."""
        return self.telemetry.position

    @property
    def attitude(self) -> Attitude:
        """Roll, pitch, yaw [rad]."""
        return self.telemetry.attitude

    @property
    def velocity(self) -> tuple[float, float, float]:
        """North, east, down [m/s]."""
        return self.telemetry.velocity

    @property
    def location(self) -> tuple[float, float, float]:
        """Latitude, longitude [deg], altitude above mean sea level [m]."""
        return (self.telemetry.lat * 1e-7, self.telemetry.lon * 1e-7, self.telemetry.alt)

    @property
    def heading(self) -> float:
        """[deg], 0 (north) .. 360"""
        return self.telemetry.heading

    @property
    def altitude(self) -> float:
        """Above home [m]."""
        return self.telemetry.altitude

    @property
    def groundspeed(self) -> float:
        """[m/s]"""
        return self.telemetry.groundspeed

    @property
    def climb_rate(self) -> float:
        """Upward [m/s]."""
        return self.telemetry.climb_rate

    @property
    def texts(self) -> list[Text]:
        """All status texts: (time [s], severity, text)."""
        return self.telemetry.texts

    @property
    def reached(self) -> list[int]:
        """Mission items that were reached, in order."""
        return [seq for _, seq in self.telemetry.reached]

    def describe(self) -> str:
        """Where it is and what it does, in a line."""
        t = self.telemetry
        item = f", item {t.item}" if self.mode in ("AUTO", px4.MISSION) else ""
        state = f"{self.mode or 'no mode yet'}, {'armed' if self.armed else 'disarmed'}"
        return f"{state}{item}, {self.position}, {t.groundspeed:.1f} m/s, heading {self.heading:.0f}"

    def last_texts(self, count: int = TEXTS_SHOWN) -> list[str]:
        """The last status texts with their times."""
        return [f"{text.time:9.1f} s  {text.text}" for text in self.texts[-count:]]

    # ------------------------------------------------------------------ time

    def delay(self, seconds: float) -> None:
        """Let simulated time pass [s]."""
        self.connection.catch_up()
        stop = self.connection.time_us + round(seconds * 1e6)
        while self.connection.time_us < stop:
            self.step(stop)

    def step(self, stop_us: int | None = None) -> None:
        """Go on to the next whole tenth of a second, but not beyond ``stop_us``, and take in what the vehicle sends."""
        connection = self.connection
        now = connection.time_us
        for name, due in self._next_us.items():
            if now >= due:
                self._repeat(name)
                between = px4.REPEAT_US if self.telemetry.is_px4 else REPEAT_US
                self._next_us[name] = now + (HEARTBEAT_US if name == _HEARTBEAT else between)
        for companion in self.companions:
            companion.step(now)
        until = now // STEP_US * STEP_US + STEP_US
        connection.run((until if stop_us is None else min(until, stop_us)) - now)
        if connection.boots != self._boots:
            self._boots = connection.boots
            self.ask_for_telemetry()
        elif self._unanswered and connection.time_us - self._asked_us >= ASK_AGAIN_US:
            self.ask_for_telemetry(self._awaited)
        for invariant in self._invariants:
            holds, what = invariant
            if not holds():
                self._invariants.remove(invariant)
                self.raise_error(InvariantError("at all times:", f"{what}; it is not so now", self.now))

    def _take(self, name: str, fields: Any) -> None:
        """A message of the vehicle."""
        self.telemetry.take(self.now, name, fields)
        if name == "COMMAND_ACK" and fields.command == _SET_INTERVAL:
            self._unanswered = max(self._unanswered - 1, 0)
        elif name == "HEARTBEAT" and not self.telemetry.mode_names:
            if fields.autopilot == MavAutopilot.GENERIC:  # its modes are its own: it is asked for their names
                self.connection.endpoint.command(_REQUEST, _MODES.id, target=self.connection.system)
            else:
                self.telemetry.mode_names = px4.MODE_NAMES if self.telemetry.is_px4 else mode_names(fields.type)
            if self.telemetry.is_px4 and self._rates.pop(_OURS, None) is not None:
                self._rates[_PX4S] = RATES_HZ[_OURS]
                self.set_rate(_PX4S, RATES_HZ[_OURS])
        elif name == _MODES.name and fields.custom_mode not in self.telemetry.mode_names:
            known = self.telemetry.mode_names
            self.telemetry.mode_names = {**known, fields.custom_mode: fields.mode_name.decode("ascii", "replace")}
        self._awaited.discard(name)
        for companion in self.companions:
            companion.take(name, fields)
        for wanted, seen in self._collected:
            if wanted == name:
                seen.append(fields)

    def wait(
        self,
        condition: Callable[[Telemetry], Any],
        timeout: float = 60.0,
        what: str = "the condition",
        last: Callable[[], str] = lambda: "",
        hold: float = 0.0,
        in_vain: Callable[[], str] = lambda: "",
    ) -> None:
        """Wait until a condition holds, and has held for ``hold`` seconds; looked at ten times a second.

        Args:
            condition: of the telemetry.
            timeout: [simulated s].
            what: is awaited; for the error.
            last: tells what was seen last; for the error.
            in_vain: tells why it cannot come to hold, looked at while it does not; "": it can.

        Raises:
            WaitTimeoutError: it did not come to hold in time.
            ImpossibleWaitError: it cannot.
            OptionError: ``hold`` is longer than ``timeout``.
        """
        if not hold <= timeout:
            raise OptionError(f"{what}: hold = {hold:g} s within timeout = {timeout:g} s cannot be")
        self.connection.catch_up()
        begin = self.connection.time_us
        stop, since = begin + round(timeout * 1e6), -1
        while True:
            now = self.connection.time_us
            if condition(self.telemetry):
                since = now if since < 0 else since
                if now - since >= round(hold * 1e6):
                    return
            else:
                since = -1
                why = in_vain()
                if why:
                    self.raise_error(ImpossibleWaitError(what, why, begin / 1e6))
            if now >= stop:
                kept = f", for {hold:g} s" if hold else ""
                self.raise_error(WaitTimeoutError(f"{what}{kept}", timeout, last(), begin / 1e6))
            self.step()

    def passes(self, condition: Callable[[], Any], seconds: float) -> bool:
        """Let up to so many simulated seconds pass; whether the condition came to hold."""
        stop = self.connection.time_us + round(seconds * 1e6)
        while not condition():
            if self.connection.time_us >= stop:
                return False
            self.step()
        return True

    @contextmanager
    def always(self, condition: Callable[[], Any], what: str = "the condition holds") -> Iterator[None]:
        """While the block flies, a condition must hold; looked at ten times a second.

        Raises:
            InvariantError: it did not.
        """
        invariant = (condition, what)
        self._invariants.append(invariant)
        try:
            yield
        finally:
            self._invariants = [other for other in self._invariants if other is not invariant]

    # ------------------------------------------------------------------ messages

    def send(self, name: str, **fields: Any) -> None:
        """Send any message; fields not given are zero, its target is this vehicle.

        A text in the place of a number is the name of a MAVLink constant ("MAV_FRAME_LOCAL_NED").
        """
        known = message(name).fields
        if "target_system" in known:
            fields.setdefault("target_system", self.system)
        if "target_component" in known:
            fields.setdefault("target_component", AUTOPILOT)
        for key, value in fields.items():
            if isinstance(value, str):
                fields[key] = constant(value)
        self.connection.endpoint.send(name, **fields)

    def set_rate(self, name: str, rate_hz: float) -> None:
        """Ask for a message at a rate [Hz]; 0 stops it. Nobody waits for the answer."""
        self.connection.endpoint.set_interval(name, rate_hz, self.system)

    def message(self, name: str, timeout: float = 2.0) -> Any:
        """Ask for one message and wait for it, at most ``timeout`` [simulated s]; gives its fields as a named tuple."""
        begin = self.now
        with self.messages(name) as seen:
            while True:
                self.command("REQUEST_MESSAGE", message(name).id, subject=f"the request for {name}")
                if self.passes(lambda: seen, min(timeout, ASK_AGAIN_US / 1e6)):
                    return seen[-1]
                if self.now - begin >= timeout:
                    self.raise_error(WaitTimeoutError(name, timeout, "", begin))

    @contextmanager
    def messages(self, name: str, rate_hz: float | None = None) -> Iterator[list[Any]]:
        """All messages of a name that come while the block flies, as a list that grows; ``rate_hz``: ask for them."""
        number, collected = message(name).id, (name, list[Any]())
        if rate_hz is not None:
            self.command("SET_MESSAGE_INTERVAL", number, 1e6 / rate_hz, subject=f"{name} at {rate_hz:g} Hz")
        self._collected.append(collected)
        try:
            yield collected[1]
        finally:
            self._collected = [other for other in self._collected if other is not collected]
        if rate_hz is not None:
            self.set_rate(name, float(self._rates.get(name, 0)))

    def collect(
        self,
        name: str,
        missing: Callable[[], list[int] | None],
        ask: Callable[[list[int] | None], int],
        take: Callable[[Any], None],
        what: str,
        limit: float = LIMIT_S,
    ) -> None:
        """Ask for pieces until none is missing; again for those that have not come when none has for ``SILENCE_S``.

        Args:
            name: of the messages that bring them.
            missing: gives the numbers of those that are missing; None: it is not known yet how many there are.
            ask: asks for these, or for some of them; gives how many messages will come.
            take: takes a message in.
            what: they are, for the error.
            limit: a missing one comes within [simulated s].

        Raises:
            WaitTimeoutError: none came for ``limit``.
        """
        begin = progress = self.now
        with self.messages(name) as seen:
            left = missing()
            while left is None or left:
                expected, before = ask(left), left
                while expected > 0 and self.passes(lambda: seen, SILENCE_S):
                    expected -= len(seen)
                    for m in seen:
                        take(m)
                    seen.clear()
                    left = missing()
                    if left is not None and not left:
                        return
                if left != before:
                    progress = self.now
                elif self.now - progress >= limit:
                    last = "" if left is None else f"{len(left)} pieces are missing"
                    self.raise_error(WaitTimeoutError(what, limit, last, begin))

    def heartbeats(self, on: bool) -> None:
        """Whether the vehicle gets this ground station's heartbeats."""
        self._is_silent = not on

    def ask_for_telemetry(self, names: set[str] | None = None) -> None:
        """Ask for the messages that the client lives on, or for some of them; a reboot makes the vehicle forget it."""
        self._awaited = set(self._rates if names is None else names)
        self._asked_us, self._unanswered = self.connection.time_us, len(self._awaited)
        for name, rate in self._rates.items():
            if name in self._awaited:
                self.set_rate(name, rate)

    def _repeat(self, name: str) -> None:
        if name == _HEARTBEAT:
            if not self._is_silent:
                self.connection.endpoint.send("HEARTBEAT", type=6, autopilot=8, mavlink_version=3)
        elif name in self._repeated:
            kind, fields = self._repeated[name]
            self.send(kind, **fields)

    def _keep_sending(self, purpose: str, name: str, fields: dict[str, Any]) -> None:
        """Send a message now, and again and again until ``_stop_sending``."""
        self._repeated[purpose] = (name, fields)
        self.send(name, **fields)
        self._next_us[purpose] = self.connection.time_us + REPEAT_US

    def _stop_sending(self, purpose: str) -> None:
        self._repeated.pop(purpose, None)
        self._next_us.pop(purpose, None)

    # ------------------------------------------------------------------ commands

    def command(self, name: str | int, *params: Any, subject: str = "", **named: Any) -> None:
        """Send a command and wait until it is accepted; it is sent again while it is not answered.

        Args:
            name: as MAVLink has it, with or without ``MAV_CMD_`` ("DO_SET_MODE"), or its number.
            params: its first parameters.
            subject: what it is about, for errors.
            named: parameters by MAVLink's labels in snake case (``custom_mode=4``) or ``param1`` .. ``param7``; a text
                is the name of a MAVLink constant.

        Raises:
            CommandRefusedError: it was not accepted; it has the MAV_RESULT and the status texts since.
            WaitTimeoutError: no answer.
            UnknownNameError: no such command or parameter.
        """
        number = name if isinstance(name, int) else command_number(name)
        subject, since = subject or command_name(number), self.now
        result = self._request(number, subject, arguments(number, params, named))
        if result:
            self.raise_error(CommandRefusedError(subject, result, entry_name("MAV_RESULT", result), since))

    def request(self, name: str | int, *params: Any, **named: Any) -> int:
        """The same, but its MAV_RESULT is given, whatever it is."""
        number = name if isinstance(name, int) else command_number(name)
        return self._request(number, command_name(number), arguments(number, params, named))

    def send_command(self, name: str | int, *params: Any, **named: Any) -> None:
        """Send a command once, and wait for nothing."""
        number = name if isinstance(name, int) else command_number(name)
        self.connection.endpoint.command(number, *arguments(number, params, named), target=self.system)

    def _request(self, number: int, subject: str, params: list[Any]) -> int:
        begin, tries = self.now, round(ANSWER_S * 1e6 / REPEAT_US)
        result = self.connection.request(number, params, lambda done: self.passes(done, REPEAT_US / 1e6), tries)
        if result is None:
            self.raise_error(WaitTimeoutError(f"an answer to {subject}", ANSWER_S, "", begin))
        return result

    def _mode_number(self, name: str) -> int:
        self.passes(lambda: self.telemetry.mode_names, ANSWER_S)  # the vehicle's first HEARTBEAT reports its kind
        numbers = {mode: number for number, mode in self.telemetry.mode_names.items()}
        if name not in numbers:
            close = did_you_mean(name, numbers)
            raise UnknownNameError(f"the {self.kind} has no mode {name!r}; it has {', '.join(numbers)}{close}")
        return numbers[name]

    @property
    def kind(self) -> str:
        """ "copter", "rover" ...; "vehicle" when it is in another process."""
        kind = self.connection.kind
        return kind.name if kind is not None else "vehicle"

    @property
    def flies(self) -> bool:
        """Whether it takes off; a vehicle in another process is taken for one that does."""
        kind = self.connection.kind
        return kind is None or kind.flies

    # ------------------------------------------------------------------ failures

    def raise_error(self, error: ClientError) -> NoReturn:
        """Raise an error, with what the vehicle does at the moment."""
        error.texts = tuple(text.text for text in self.texts if text.time >= error.since)
        lines = [f"  {self.name} at {self.now:.1f} s simulated: {self.describe()}"]
        if self.texts:
            lines += ["  last texts:", *(f"  {text}" for text in self.last_texts())]
        error.state = "\n".join(lines)
        raise error

    def close(self) -> None:
        """Let go of the connection; a simulation in this process is closed."""
        self.connection.close()


def mode_names(vehicle_type: int) -> Mapping[int, str]:
    """Names of ArduPilot's modes by their numbers, of a MAV_TYPE."""
    from pymavlink import mavutil  # here: only vehicles elsewhere need it

    return dict(mavutil.mode_mapping_bynumber(vehicle_type) or {})
