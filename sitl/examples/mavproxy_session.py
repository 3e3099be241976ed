# SPDX-License-Identifier: BSD-3-Clause
"""A session of MAVProxy without a hand at the keyboard: each line is typed when the one before is done.

    sitl exec --speedup 5 -- python examples/mavproxy_session.py       (CONNECTION: udpin:0.0.0.0:14550)

It draws mavproxy_session.png from the log that MAVProxy keeps, and needs MAVProxy and matplotlib.
"""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import matplotlib.pyplot as plt
    import MAVProxy  # noqa: F401 - its program is started below
    from pymavlink import mavutil
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib MAVProxy") from None

SESSION = (
    ("", "online system"),
    ("mode guided", "DO_SET_MODE: ACCEPTED"),
    ("arm throttle", "ARMED"),
    ("takeoff 10", 10.0),
    ("velocity 3 0 0", 5.0),
    ("velocity 0 3 -1", 5.0),
    ("mode rtl", "DISARMED"),
)
"""A line, and what MAVProxy has to say, or how many seconds have to pass, before the next one."""
AGAIN_S, LIMIT_S = 20.0, 300.0
"""A line is typed again after so long, until MAVProxy has said it."""


def type_line(proxy: subprocess.Popen, line: str) -> None:
    """Type a line into the console."""
    if line:
        print(">", line, flush=True)
        proxy.stdin.write(line + "\n")
        proxy.stdin.flush()


def main() -> None:
    """Type the session, and draw the flight."""
    program = shutil.which("mavproxy.py", path=os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"])))
    url = sys.argv[1] if len(sys.argv) > 1 else "udpin:0.0.0.0:14550"
    folder = Path(tempfile.mkdtemp())
    command = [sys.executable, program, f"--master={url}", f"--state-basedir={folder}", "--streamrate=10"]
    command.append("--default-modules=log,param,arm,mode,cmdlong,misc,link")
    said = folder / "said"
    with said.open("w") as out:
        proxy = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=out, stderr=subprocess.STDOUT, text=True, cwd=folder,
            start_new_session=True,
        )  # fmt: skip
    try:
        for line, until in SESSION:
            read, begin = len(said.read_text()), time.monotonic()
            type_line(proxy, line)
            if isinstance(until, float):
                time.sleep(until)
                continue
            typed = begin
            while until not in said.read_text()[read:]:
                if time.monotonic() > begin + LIMIT_S:
                    raise SystemExit(f"MAVProxy did not say {until!r}:\n{said.read_text()[-2000:]}")
                if time.monotonic() > typed + AGAIN_S:
                    typed = time.monotonic()
                    type_line(proxy, line)
                time.sleep(0.2)
        print("landed and disarmed")
    finally:
        os.killpg(proxy.pid, signal.SIGKILL)  # at the end of its input MAVProxy would wait for a child of its own

    (file,) = folder.rglob("*.tlog")
    tlog, times, heights, path = mavutil.mavlink_connection(str(file)), [], [], []
    while (m := tlog.recv_match(type="LOCAL_POSITION_NED")) is not None:
        times.append(m.time_boot_ms * 1e-3)
        heights.append(-m.z)
        path.append((m.y, m.x))
    figure, (plan, climb) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
    plan.plot(*zip(*path))
    plan.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
    climb.plot(times, heights)
    climb.set(xlabel="time since boot [s]", ylabel="height [m]")
    figure.savefig("mavproxy_session.png", dpi=80)


if __name__ == "__main__":
    main()
