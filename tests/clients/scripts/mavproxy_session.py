# SPDX-License-Identifier: BSD-3-Clause
"""A MAVProxy session, typed into its console by a pipe."""

import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

MISSION = """QGC WPL 110
0\t1\t0\t16\t0\t0\t0\t0\t-35.363262\t149.165237\t584.0\t1
1\t0\t3\t22\t0\t0\t0\t0\t0\t0\t10.0\t1
2\t0\t3\t16\t0\t0\t0\t0\t-35.363100\t149.165237\t10.0\t1
3\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1
"""
TROUBLE = re.compile(r"unable|timed out|timeout|traceback|error|breach|unknown|failed|denied", re.IGNORECASE)

folder = Path(tempfile.mkdtemp())
(folder / "mission.txt").write_text(MISSION)
command = [
    sys.executable, str(Path(sys.executable).parent / "mavproxy.py"), f"--master={sys.argv[1]}", "--streamrate=5",
    f"--state-basedir={folder}", "--default-modules=log,wp,rally,fence,ftp,param,arm,mode,rc,cmdlong,misc,output,link",
]  # fmt: skip
console = subprocess.Popen(
    command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1,
    start_new_session=True, cwd=folder,
)  # fmt: skip
said: list[str] = []


def listen() -> None:
    for line in console.stdout:
        said.append(line)
        print(line, end="", flush=True)


def check(what: str, ok: object) -> None:
    if not ok:
        print("FAILED:", what, flush=True)
        os.killpg(console.pid, signal.SIGKILL)  # at the end of its input MAVProxy waits for a child of its own
        sys.exit(1)


def expect(text: str, seconds: float = 30.0) -> None:
    end = time.monotonic() + seconds
    while not any(text in line for line in said) and time.monotonic() < end:
        time.sleep(0.1)
    check(text, any(text in line for line in said))


def say(line: str, text: str = "", seconds: float = 30.0) -> None:
    """Type a line and wait for what it makes MAVProxy say; some lines it takes without a word."""
    said.clear()
    print(">", line, flush=True)
    console.stdin.write(line + "\n")
    console.stdin.flush()
    if text:
        expect(text, seconds)
    else:
        time.sleep(2.0)
    check(f"no trouble after {line!r}", not any(TROUBLE.search(line) for line in said))


threading.Thread(target=listen, daemon=True).start()
expect("parameters (ftp)", 60.0)
check("a quiet start", not any(TROUBLE.search(line) for line in said))
expect("is using GPS", 90.0)
say("param show RTL_ALT", "RTL_ALT")
say("param set FS_GCS_ENABLE 0")
say("param fetch", "parameters (ftp)")
say(f"wp load {folder / 'mission.txt'}", "ACCEPTED")
say("wp list", "Saved 4 waypoints")
say("mode guided", "DO_SET_MODE: ACCEPTED")
time.sleep(2.0)
say("arm throttle", "ARMED")
say("takeoff 10", "NAV_TAKEOFF: ACCEPTED")
time.sleep(12.0)
say("rc 3 1500")
say("mode loiter", "DO_SET_MODE: ACCEPTED")
say("rc 3 1700", "height 25")
say("rc all 0")
say("mode auto", "Mission: 1 Takeoff")
say("mode rtl", "DO_SET_MODE: ACCEPTED")
expect("DISARMED", 90.0)
os.killpg(console.pid, signal.SIGKILL)
