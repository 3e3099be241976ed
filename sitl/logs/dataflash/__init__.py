# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot's on-board log format, DataFlash (.bin): a file that says itself what its messages are.

https://ardupilot.org/dev/docs/code-overview-adding-a-new-log-message.html and
https://ardupilot.org/copter/docs/logmessages.html. What each message carries is data (``common``, ``copter``,
``rover``); ``plan`` turns it into columns of samples and those into bytes; ``log`` looks at a vehicle and keeps a file.
"""
