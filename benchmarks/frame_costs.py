# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.frame_costs``: what each kind of frame of a client costs the vehicle, in CPU time and bytes.

One frame that costs much lets a client of few bytes a second take a core from a vehicle in real time. The time is that
of hearing a frame of a burst, of all that it starts within a simulated second, and of sending that, less a second
without it.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Iterator
from typing import Any

from sitl.bridge.dialect import MessageType, message, message_by_id
from sitl.bridge.frame import encode_v2
from sitl.bridge.links.inprocess import InProcessLink
from sitl.bridge.services import served_files
from sitl.bridge.services.ftp import CRC, HEADER, LIST, OPEN_READ, READ
from sitl.simulation import Simulation, load_core
from sitl.vehicle.kinds import KINDS

BURST = 40
"""Frames that come at once: what is paced (lists of parameters) goes out once for all of them."""
TARGET = {"target_system": 1, "target_component": 1, "target": 1}
COMMANDS = {
    "REQUEST_MESSAGE AUTOPILOT_VERSION": (512, 148.0),
    "REQUEST_MESSAGE COMPONENT_METADATA": (512, 397.0),
    "REQUEST_MESSAGE HOME_POSITION": (512, 242.0),
    "SET_MESSAGE_INTERVAL": (511, 30.0),
    "PREFLIGHT_CALIBRATION": (241, 0.0),
    "RUN_PREARM_CHECKS": (401, 0.0),
    "an unknown command": (60000, 0.0),
}


def fields(kind: MessageType, **values: Any) -> bytes:
    """A payload for the vehicle."""
    own = {name: value for name, value in TARGET.items() if name in kind.fields}
    return kind.payload(**{**own, **values})


def ftp(opcode: int, path: str, sequence: int) -> bytes:
    """A request of MAVLink FTP."""
    data = path.encode()
    body = HEADER.pack(sequence & 0xFFFF, 0, opcode, len(data), 0, 0, 0, 0) + data
    return fields(message("FILE_TRANSFER_PROTOCOL"), payload=tuple(body.ljust(251, b"\0")))


def kinds(simulation: Simulation) -> Iterator[tuple[str, MessageType, list[bytes]]]:
    """(Title, message, payloads that are sent in turn)."""
    for number in sorted(simulation.bridge._handlers):
        kind = message_by_id(number)
        name = kind.name
        if name == "FILE_TRANSFER_PROTOCOL":
            paths = [
                served_files.PARAMETERS,
                served_files.PARAMETERS + "?withdefaults=1",
                *served_files.MISSIONS,
                "@SYS/uarts.txt",
            ]
            paths += ["@META/general.json", "@META/parameters.json", "no/such/file"]
            for title, opcode in (("open", OPEN_READ), ("checksum", CRC)):
                for path in paths:
                    yield f"FTP {title} {path}", kind, [ftp(opcode, path, k) for k in range(0, 100, 2)]
            yield "FTP read", kind, [ftp(READ, "", k) for k in range(0, 100, 2)]
            yield "FTP list /", kind, [ftp(LIST, "/", k) for k in range(0, 100, 2)]
        elif name == "COMMAND_LONG":
            for title, (number, value) in COMMANDS.items():
                yield f"COMMAND_LONG {title}", kind, [fields(kind, command=number, param1=value)]
        elif name in ("MISSION_COUNT", "LOG_REQUEST_DATA"):
            most = {"count": 65535} if name == "MISSION_COUNT" else {"id": 1, "count": 0xFFFFFFFF}
            yield f"{name}, the most", kind, [fields(kind, **most)]
        else:
            yield name, kind, [fields(kind)]


def cost(simulation: Simulation, kind: MessageType, payloads: list[bytes], count: int) -> tuple[float, float]:
    """(CPU time [ms], bytes that are sent back) of a frame, when ``BURST`` come at once; the median of several."""
    link = InProcessLink()
    simulation.bridge.add_link(link)
    times, sent = [], []
    for k in range(count):
        chosen = [payloads[(BURST * k + j) % len(payloads)] for j in range(BURST)]
        frames = b"".join(encode_v2(kind, payload, j, 255, 190) for j, payload in enumerate(chosen))
        begin = time.process_time()
        link.send(frames)
        simulation.advance(1.0)
        answer = len(link.receive())
        with_it = time.process_time() - begin
        begin = time.process_time()
        simulation.advance(1.0)
        without = len(link.receive())
        times.append(1e3 / BURST * (with_it - (time.process_time() - begin)))
        sent.append((answer - without) / BURST)
    simulation.bridge.remove_link(link)
    return statistics.median(times), statistics.median(sent)


def main() -> None:
    """Print the table, the most costly first."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.frame_costs", description=__doc__)
    parser.add_argument("kind", nargs="?", choices=sorted(KINDS), default="copter")
    parser.add_argument("--count", type=int, default=5, help="bursts of each kind (default 5)")
    parser.add_argument("--only", default="", metavar="TEXT", help="kinds whose title has this text")
    options = parser.parse_args()
    core = load_core(KINDS[options.kind])
    rows = []
    for title, kind, payloads in kinds(Simulation(KINDS[options.kind].default_frame, core=core)):
        if options.only not in title:
            continue
        simulation = Simulation(KINDS[options.kind].default_frame, core=core)
        simulation.advance(20.0)
        ms, answer = cost(simulation, kind, payloads, options.count)
        rows.append((ms, len(encode_v2(kind, payloads[0], 0, 255, 190)), answer, title))
        simulation.close()
    print(f"{'ms a frame':>10} {'bytes':>6} {'answer':>8} {'8 kB/s take':>12}  kind")
    for ms, size, answer, title in sorted(rows, reverse=True):
        print(f"{ms:10.3f} {size:6d} {answer:8.0f} {100.0 * ms * 1e-3 * 8000 / size:11.1f}%  {title}")


if __name__ == "__main__":
    main()
