# SPDX-License-Identifier: BSD-3-Clause
"""An ordinary pymavlink script: python pymavlink_script.py PORT. Heartbeats from a thread, a question
without answer.
"""

import json
import sys
import threading
import time

from pymavlink import mavutil

master = mavutil.mavlink_connection(f"tcp:127.0.0.1:{sys.argv[1]}", source_system=255)
master.wait_heartbeat(timeout=5)
stop = threading.Event()


def beat() -> None:
    """Send a heartbeat a second, as ground stations do."""
    while not stop.wait(1.0):
        master.mav.heartbeat_send(6, 8, 0, 0, 0)


beats = threading.Thread(target=beat)
beats.start()
measured = {}
start = time.time()
master.mav.command_long_send(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)
measured["armed"] = master.recv_match(type="COMMAND_ACK", blocking=True, timeout=3) is not None
measured["ack_s"] = time.time() - start
start = time.time()
measured["answer"] = master.recv_match(type="PARAM_VALUE", blocking=True, timeout=3) is not None
measured["timeout_s"] = time.time() - start
for _ in range(100):
    master.mav.rc_channels_override_send(1, 1, *[1500] * 8)
    time.sleep(0.1)
stop.set()
beats.join()
print(json.dumps(measured))
