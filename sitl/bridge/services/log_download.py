# SPDX-License-Identifier: BSD-3-Clause
"""Log download (LOG_*): this firmware keeps no logs on board, and says so, so that clients need not wait in vain.

Source: https://mavlink.io/en/messages/common.html#LOG_REQUEST_LIST (a list without logs is one entry with num_logs 0).
"""

from __future__ import annotations

from typing import Any

from ..channel import Channel
from ..dialect import message
from .service import Handler, Sender, Service

ENTRY, DATA = message("LOG_ENTRY"), message("LOG_DATA")


class LogDownloadService(Service):
    """Answers lists with "no logs" and requests for data with an empty piece, which is the end of a log."""

    def handlers(self) -> dict[str, Handler]:
        return {"LOG_REQUEST_LIST": self._list, "LOG_REQUEST_DATA": self._data}

    def _list(self, channel: Channel, m: Any, sender: Sender) -> None:
        channel.send(ENTRY, ENTRY.payload())

    def _data(self, channel: Channel, m: Any, sender: Sender) -> None:
        channel.send(DATA, DATA.payload(id=m.id, ofs=m.ofs, count=0))
