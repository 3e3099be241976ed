# SPDX-License-Identifier: BSD-3-Clause
"""A session of MAVProxy without a hand at the keyboard: lines are typed when it has said what they wait for.

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
    ("is using GPS", "mode guided"),
    ("DO_SET_MODE: ACCEPTED", "arm throttle"),
    ("ARMED", "takeoff 10"),
    (10.0, "velocity 3 0 0"),
    (5.0, "velocity 0 3 -1"),
    (5.0, "mode rtl"),
    ("DISARMED", ""),
)
"""What MAVProxy has to say, or how many seconds have to pass, before a line is typed."""


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
    read = 0
    try:
        for cause, line in SESSION:
            if isinstance(cause, float):
                time.sleep(cause)
            else:
                end = time.monotonic() + 120.0
                while cause not in said.read_text()[read:]:
                    if time.monotonic() > end:
                        raise SystemExit(f"MAVProxy did not say {cause!r}:\n{said.read_text()[-2000:]}")
                    time.sleep(0.2)
            read = len(said.read_text())
            print(f"> {line}" if line else "landed and disarmed", flush=True)
            proxy.stdin.write(line + "\n")
            proxy.stdin.flush()
    finally:
        os.killpg(proxy.pid, signal.SIGKILL)  # at the end of its input MAVProxy would wait for a child of its own

    (file,) = folder.rglob("*.tlog")
    tlog, times, heights, way = mavutil.mavlink_connection(str(file)), [], [], []
    while (m := tlog.recv_match(type="LOCAL_POSITION_NED")) is not None:
        times.append(m.time_boot_ms * 1e-3)
        heights.append(-m.z)
        way.append((m.y, m.x))
    figure, (plan, climb) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
    plan.plot(*zip(*way))
    plan.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
    climb.plot(times, heights)
    climb.set(xlabel="time since boot [s]", ylabel="height [m]")
    figure.savefig("mavproxy_session.png", dpi=80)


if __name__ == "__main__":
    main()
