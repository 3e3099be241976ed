# SPDX-License-Identifier: BSD-3-Clause
"""The mission protocol (https://mavlink.io/en/services/mission.html), vehicle side.

An upload is collected apart and replaces the list (mission, fence, rally points) only when it is complete and valid;
until then the old one stands.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

from ...autopilot.fence.items import FenceError
from ...autopilot.mission.item import FENCE_COMMANDS, STORED, MissionItem
from ...autopilot.mission.storage import stored_home
from ...autopilot.mission.validate import MAX_ITEMS
from ...core.constants import NEVER
from ...core.mavlink import MavCmd, MavMissionResult, MavMissionType, MavSeverity
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from . import fence_and_rally
from .mission_upload import Upload, from_float, from_int, to_float, to_int
from .service import Handler, Service
from .setpoint_messages import SetpointService
from .statustext import StatusTextService

RECEIVED: dict[int, tuple[int, str]] = {
    MavMissionType.MISSION: (MavSeverity.INFO, "Flight plan received"),
    MavMissionType.FENCE: (MavSeverity.DEBUG, "Fence Indexed OK"),
}
ACK, COUNT, REQUEST = message("MISSION_ACK"), message("MISSION_COUNT"), message("MISSION_REQUEST")
MISSION_CURRENT = message("MISSION_CURRENT").id
COPY_US = 2_000_000
"""A link may bring a second copy of a frame so late."""
REPEAT_US = 200_000
"""An item that is there already is answered, when the next one was asked for so long ago."""
GUIDED_TARGET, ALTITUDE_CHANGE = 2, 3
"""Values of ``current``: a target for GUIDED (DroneKit's simple_goto); a change of height, which only planes make."""


class MissionService(Service):
    """Missions, fences, rally points: upload, download, clear, partial write; the mission's current item."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._taken: dict[int, Collection[int]] = {
            MavMissionType.MISSION: STORED,
            MavMissionType.FENCE: FENCE_COMMANDS,
            MavMissionType.RALLY: (MavCmd.NAV_RALLY_POINT,),
        }
        self._lists: dict[int, tuple[MissionItem, ...]] = {MavMissionType.FENCE: (), MavMissionType.RALLY: ()}
        self.upload: Upload | None = None
        self._last: tuple[Channel, Sender, int, range, int] | None = None
        """Who uploaded last, what, the numbers of its items, and when: its acknowledgement may have been lost."""
        self._warned = False
        """Whether a client was sent the text that MISSION_REQUEST is old."""
        self._home = bridge.reader.fields("autopilot.home.lat", "autopilot.home.lon", "autopilot.home.alt")

    def handlers(self) -> dict[str, Handler]:
        return {
            "MISSION_COUNT": self._count,
            "MISSION_WRITE_PARTIAL_LIST": self._write_partial,
            "MISSION_ITEM_INT": self._item_int,
            "MISSION_ITEM": self._item_float,
            "MISSION_REQUEST_LIST": self._request_list,
            "MISSION_REQUEST_INT": self._request_int,
            "MISSION_REQUEST": self._request_float,
            "MISSION_CLEAR_ALL": self._clear_all,
            "MISSION_SET_CURRENT": self._set_current,
            "MISSION_ACK": self._ack_received,
        }

    def channel_removed(self, channel: Channel) -> None:
        if self.upload is not None and self.upload.channel is channel:
            self.upload = None
        if self._last is not None and self._last[0] is channel:
            self._last = None

    def follow(self, before: MissionService) -> None:
        """Fences and rally points outlive a reboot."""
        self.keep(before._lists[MavMissionType.FENCE], before._lists[MavMissionType.RALLY])

    def keep(self, fence: tuple[MissionItem, ...], rally: tuple[MissionItem, ...], *, counted: bool = False) -> None:
        """Take lists that were taken before; FENCE_TOTAL and RALLY_TOTAL count them, or stay as they are."""
        fence_and_rally.load_fence(self.bridge.vehicle, fence, checked=False)
        fence_and_rally.load_rally(self.bridge.vehicle, rally)
        self._lists = {MavMissionType.FENCE: fence, MavMissionType.RALLY: rally}
        if counted:
            self.bridge.vehicle.parameters.update(
                {"FENCE_TOTAL": fence_and_rally.count(fence), "RALLY_TOTAL": len(rally)}
            )

    @property
    def lists(self) -> tuple[tuple[MissionItem, ...], tuple[MissionItem, ...]]:
        """Fences and rally points, for ``keep``."""
        return self._lists[MavMissionType.FENCE], self._lists[MavMissionType.RALLY]

    def _ack(self, channel: Channel, sender: Sender, result: int, kind: int = MavMissionType.MISSION) -> None:
        system, component = sender
        fields = {
            "target_system": system,
            "target_component": component,
            "type": result,
            "mission_type": kind,
        }
        channel.send(ACK, ACK.payload(**fields))

    # ------------------------------------------------------------------ upload

    def items(self, kind: int) -> tuple[MissionItem, ...]:
        """A list as it is now."""
        if kind == MavMissionType.MISSION:
            return self.bridge.autopilot.mission_items()
        total = int(self.bridge.vehicle.parameters["RALLY_TOTAL"])
        return (
            fence_and_rally.counted(self._lists[MavMissionType.RALLY], total)
            if kind == MavMissionType.RALLY
            else self._lists[kind]
        )

    def home_alone(self, kind: int) -> tuple[MissionItem, ...]:
        """Item 0, home, can be read of an empty mission all the same (DroneKit's download waits for it)."""
        return (stored_home(*self._home()),) if kind == MavMissionType.MISSION else ()

    def _replace(self, kind: int, items: tuple[MissionItem, ...]) -> int:
        """Replace a list whole; the MAV_MISSION_RESULT."""
        if kind == MavMissionType.MISSION:
            return int(self.bridge.autopilot.replace_mission(items))
        vehicle = self.bridge.vehicle
        if kind == MavMissionType.RALLY:
            self._lists[MavMissionType.RALLY] = items = tuple(fence_and_rally.as_rally_point(item) for item in items)
            fence_and_rally.load_rally(vehicle, items)
            vehicle.parameters["RALLY_TOTAL"] = len(items)
        elif not self.replace_fence(tuple(fence_and_rally.as_fence(item) for item in items)):
            return MavMissionResult.ERROR
        else:
            vehicle.parameters["FENCE_TOTAL"] = fence_and_rally.count(self._lists[MavMissionType.FENCE])
        return MavMissionResult.ACCEPTED

    def replace_fence(self, items: tuple[MissionItem, ...]) -> bool:
        """Replace the fences; whether they could be."""
        try:
            fence_and_rally.load_fence(self.bridge.vehicle, items)
        except FenceError as error:
            say = self.bridge.get(StatusTextService).say
            say(MavSeverity.WARNING, str(error))
            if items and "storage" not in str(error):
                say(MavSeverity.WARNING, "Fence validation failed")
            return False
        self._lists[MavMissionType.FENCE] = items
        return True

    def _capacity(self, kind: int) -> int:
        """How many items fit into a list."""
        if kind == MavMissionType.MISSION:
            return MAX_ITEMS
        vehicle = self.bridge.vehicle
        return (
            fence_and_rally.most_fence_items(vehicle)
            if kind == MavMissionType.FENCE
            else fence_and_rally.most_rally_points(vehicle)
        )

    def take(self, kind: int, rows: Sequence[Any]) -> bool:
        """Replace a list by fields of MISSION_ITEM_INT; False, and it stays, when one is refused or an upload runs."""
        taken = [from_int(fields, self._taken[kind]) for fields in rows]
        if (
            self.upload is not None
            or len(rows) > self._capacity(kind)
            or any(result != MavMissionResult.ACCEPTED for _, result in taken)
        ):
            return False
        done = self._replace(kind, tuple(item for item, _ in taken)) == MavMissionResult.ACCEPTED
        if done:
            self._say_received(kind)
        self.bridge.say_pending()
        return done

    def _say_received(self, kind: int) -> None:
        if kind in RECEIVED:
            self.bridge.get(StatusTextService).say(*RECEIVED[kind])

    def _is_mine(self, channel: Channel, sender: Sender) -> bool:
        """Whether no upload is under way, or this sender's."""
        return self.upload is None or (self.upload.channel, self.upload.sender) == (channel, sender)

    def _may_start(self, channel: Channel, sender: Sender, kind: int) -> bool:
        """Whether this sender may upload now; answers if not. A sender may begin its own upload anew."""
        if not self._is_mine(channel, sender):
            self._ack(channel, sender, MavMissionResult.DENIED, kind)
            return False
        return True

    def _count(self, channel: Channel, fields: Any, sender: Sender) -> None:
        kind = fields.mission_type
        if kind not in self._taken:
            self._ack(channel, sender, MavMissionResult.UNSUPPORTED, kind)
        elif self._is_copy(channel, sender, kind, range(fields.count)):
            pass
        elif self._may_start(channel, sender, kind):
            self.upload = None
            if fields.count > (capacity := self._capacity(kind)):
                self.bridge.get(StatusTextService).say(MavSeverity.WARNING, f"Only {capacity} items are supported")
                self._ack(channel, sender, MavMissionResult.NO_SPACE, kind)
            elif fields.count == 0:  # taken while the mission runs, too: the command under way goes on
                result = self._replace(kind, ())
                self._ack(channel, sender, result, kind)
                if kind == MavMissionType.MISSION and result == MavMissionResult.ACCEPTED:
                    self._say_received(kind)
                self.bridge.say_pending()
            else:
                self._begin(channel, sender, kind, 0, fields.count, ())

    def _write_partial(self, channel: Channel, fields: Any, sender: Sender) -> None:
        kind = fields.mission_type
        first, last = fields.start_index, fields.end_index
        if kind not in self._taken:
            self._ack(channel, sender, MavMissionResult.UNSUPPORTED, kind)
        elif self._is_copy(channel, sender, kind, range(first, last + 1)):
            pass
        elif self.upload is not None:
            self._ack(channel, sender, MavMissionResult.DENIED, kind)
        elif not 0 <= first <= last <= len(self.items(kind)):  # one more item may be added
            self.bridge.get(StatusTextService).say(MavSeverity.WARNING, "Flight plan update rejected")
            self._ack(channel, sender, MavMissionResult.ERROR, kind)
        else:
            self._begin(channel, sender, kind, first, last + 1, self.items(kind))

    def _is_copy(self, channel: Channel, sender: Sender, kind: int, seqs: range) -> bool:
        """Whether a message that begins an upload is a copy of the one that began it, come late over a bad link."""
        upload = self.upload
        return (
            upload is not None
            and (upload.channel, upload.sender, upload.kind) == (channel, sender, kind)
            and (upload.first, upload.stop) == (seqs.start, seqs.stop)
            and upload.next > upload.first
            and self.bridge.now_us - upload.began_us < COPY_US
        )

    def _begin(
        self, channel: Channel, sender: Sender, kind: int, first: int, stop: int, base: tuple[MissionItem, ...]
    ) -> None:
        self.upload = Upload(channel, sender, kind, first, stop, base, self.bridge.now_us)
        self._last, self._warned = None, False
        self._request_next(self.upload)

    def _request_next(self, upload: Upload) -> None:
        system, component = upload.sender
        upload.asked(self.bridge.now_us)
        fields = {"target_system": system, "target_component": component, "seq": upload.next}
        fields["mission_type"] = upload.kind
        upload.channel.send(REQUEST, REQUEST.payload(**fields))

    def _item_int(self, channel: Channel, fields: Any, sender: Sender) -> None:
        self._item(channel, fields, sender, *from_int(fields, self._taken.get(fields.mission_type, ())))

    def _item_float(self, channel: Channel, fields: Any, sender: Sender) -> None:
        if self.upload is not None and fields.current not in (GUIDED_TARGET, ALTITUDE_CHANGE) and fields.seq == 0:
            say = self.bridge.get(StatusTextService).say
            say(MavSeverity.WARNING, "got MISSION_ITEM; GCS should send MISSION_ITEM_INT")
        self._item(channel, fields, sender, *from_float(fields, self._taken.get(fields.mission_type, ())))

    def _item(self, channel: Channel, fields: Any, sender: Sender, item: MissionItem, result: int) -> None:
        kind = fields.mission_type
        if kind not in self._taken:
            self._ack(channel, sender, MavMissionResult.UNSUPPORTED, kind)
            return
        if kind == MavMissionType.MISSION and fields.current in (GUIDED_TARGET, ALTITUDE_CHANGE):
            if result == MavMissionResult.ACCEPTED and fields.current == GUIDED_TARGET:
                target = self.bridge.get(SetpointService).mission_item_target
                result = MavMissionResult.ACCEPTED if target(item) else MavMissionResult.ERROR
            self._ack(channel, sender, result)
            return
        upload = self.upload
        if upload is None or upload.kind != kind:
            self._ack(
                channel,
                sender,
                MavMissionResult.ACCEPTED
                if self._is_repeated(channel, sender, kind, fields.seq)
                else MavMissionResult.ERROR,
                kind,
            )
        elif not self._is_mine(channel, sender):
            self._ack(channel, sender, MavMissionResult.DENIED, kind)
        elif upload.first <= fields.seq < upload.next:
            if self.bridge.now_us - upload.asked_us >= REPEAT_US:
                self._request_next(upload)  # our request for it was lost; else this is a copy, come late
        elif fields.seq != upload.next:
            self._cancel(MavMissionResult.INVALID_SEQUENCE)
        elif result != MavMissionResult.ACCEPTED:
            if (
                kind == MavMissionType.MISSION and result == MavMissionResult.UNSUPPORTED
            ):  # else the user must guess which of the items it was
                text = f"Mission: item {fields.seq} command {fields.command} not supported"
                self.bridge.get(StatusTextService).say(MavSeverity.WARNING, text)
            self._cancel(result)
        else:
            upload.add(item, self.bridge.now_us)
            if upload.complete:
                self._finish(upload)
            else:
                self._request_next(upload)

    def _is_repeated(self, channel: Channel, sender: Sender, kind: int, seq: int) -> bool:
        """Whether an item is of the upload that was taken: the last one repeated, or a late copy of another."""
        last = self._last
        if last is None or last[:3] != (channel, sender, kind):
            return False
        return seq == last[3].stop - 1 or (seq in last[3] and self.bridge.now_us - last[4] < COPY_US)

    def _finish(self, upload: Upload) -> None:
        self.upload = None
        result = self._replace(upload.kind, upload.merged())
        self._ack(upload.channel, upload.sender, result, upload.kind)
        if result == MavMissionResult.ACCEPTED:
            seqs = range(upload.first, upload.stop)
            self._last = (upload.channel, upload.sender, upload.kind, seqs, self.bridge.now_us)
            self._say_received(upload.kind)
        self.bridge.say_pending()

    def _cancel(self, result: int) -> None:
        if self.upload is not None:
            self._ack(self.upload.channel, self.upload.sender, result, self.upload.kind)
            self.upload = None

    def _ack_received(self, channel: Channel, fields: Any, sender: Sender) -> None:
        """The uploader gives up.

        The end of a download is acknowledged in the same way and needs no action.
        """
        upload = self.upload
        if upload is not None and self._is_mine(channel, sender) and fields.type != MavMissionResult.ACCEPTED:
            self.upload = None

    def snapshot(self) -> Any:
        last = self._last
        return (
            None if self.upload is None else self.upload.snapshot(),
            None if last is None else (last[0].number, *last[1:]),
            (self._lists[MavMissionType.FENCE], self._lists[MavMissionType.RALLY]),
            self._warned,
        )

    def restore(self, state: Any) -> None:
        upload, last, (self._lists[MavMissionType.FENCE], self._lists[MavMissionType.RALLY]), self._warned = state
        by_number = {c.number: c for c in self.bridge.channels} if upload or last else {}
        self.upload = Upload.restored(upload, by_number[upload[0]]) if upload and upload[0] in by_number else None
        self._last = (by_number[last[0]], *last[1:]) if last and last[0] in by_number else None

    @property
    def due_us(self) -> int:  # type: ignore[override]
        """When to ask for an item again or to give the upload up."""
        return NEVER if self.upload is None else self.upload.due_us

    def service(self, now_us: int) -> None:
        if self.upload is not None and now_us >= self.upload.due_us:
            if now_us >= self.upload.deadline_us:
                self._cancel(MavMissionResult.OPERATION_CANCELLED)
                self.bridge.get(StatusTextService).say(MavSeverity.WARNING, "Mission upload timeout")
            else:
                self._request_next(self.upload)

    # ------------------------------------------------------------------ download

    def _request_list(self, channel: Channel, fields: Any, sender: Sender) -> None:
        kind = fields.mission_type
        if kind not in self._taken:
            self._ack(channel, sender, MavMissionResult.UNSUPPORTED, kind)
        elif self._may_start(channel, sender, kind):
            self._report_count(channel, sender, kind)

    def _report_count(self, channel: Channel, sender: Sender, kind: int) -> None:
        target = {"target_system": sender[0], "target_component": sender[1]}
        channel.send(COUNT, COUNT.payload(count=len(self.items(kind)), mission_type=kind, **target))

    def _request_int(self, channel: Channel, fields: Any, sender: Sender) -> None:
        self._send_item(channel, fields, sender, to_int)

    def _request_float(self, channel: Channel, fields: Any, sender: Sender) -> None:
        if not self._warned:
            self._warned = True
            self.bridge.get(StatusTextService).say(MavSeverity.WARNING, "got MISSION_REQUEST; use MISSION_REQUEST_INT!")
        self._send_item(channel, fields, sender, to_float)

    def _send_item(self, channel: Channel, fields: Any, sender: Sender, pack: Any) -> None:
        kind = fields.mission_type
        if kind not in self._taken:
            self._ack(channel, sender, MavMissionResult.UNSUPPORTED, kind)
            return
        items = self.items(kind) or self.home_alone(kind)
        if fields.seq >= len(items):
            if pack is to_int:
                self._report_count(channel, sender, kind)  # what a client may ask for
            self._ack(channel, sender, MavMissionResult.INVALID_SEQUENCE, kind)
        else:
            item = items[fields.seq]
            # ArduPilot compares the command, where the number of the item is meant: 1 is seldom sent
            is_current = kind == MavMissionType.MISSION and item.command == self.bridge.autopilot.current_item()
            channel.send(*pack(item, fields.seq, is_current, sender, kind))

    # ------------------------------------------------------------------ the rest

    def _clear_all(self, channel: Channel, fields: Any, sender: Sender) -> None:
        kind = fields.mission_type
        if kind not in (*self._taken, MavMissionType.ALL):
            self._ack(channel, sender, MavMissionResult.UNSUPPORTED, kind)
        elif self._may_start(channel, sender, kind):
            self.upload = None
            cleared = kind not in (MavMissionType.MISSION, MavMissionType.ALL) or self.bridge.autopilot.clear_mission()
            for other in (MavMissionType.FENCE, MavMissionType.RALLY):
                if cleared and kind in (other, MavMissionType.ALL):
                    self._replace(other, ())
            self._ack(channel, sender, MavMissionResult.ACCEPTED if cleared else MavMissionResult.ERROR, kind)

    def _set_current(self, channel: Channel, fields: Any, sender: Sender) -> None:
        if self.bridge.autopilot.set_current_item(fields.seq):
            self.bridge.send_now(channel, MISSION_CURRENT)
        self.bridge.say_pending()
