# SPDX-License-Identifier: BSD-3-Clause
"""What a link to one client keeps in the core: bytes on their way in and out, sequence numbers, what is sent when.

A port is a record beside the vehicle's. The core reads and writes it while it runs; the shell hands it the client's
bytes, takes away the frames, and acts on messages that the core leaves to it.
"""

from __future__ import annotations

from ...core.constants import NEVER
from ...core.kernels import law
from ...core.records import Ints, Record, array

STREAMS = 96
"""Messages that a client can be sent regularly."""
SENDERS = 32
"""Senders whose sequence numbers are followed."""
OUT_BYTES, OUT_FRAMES = 6144, 160
IN_BYTES = 1024
PAYLOAD_BYTES = 256


class Port(Record):
    """One client's link."""

    # what a snapshot keeps of it (``STATE``)
    sequence: int  # of the next frame
    version: int  # of MAVLink in outgoing frames: 1 or 2
    received_v2: bool  # the client speaks MAVLink 2
    part: int  # of a message that is sent in several parts: the next one, 0 when there is none
    # regular messages, in order of interval, then of request
    stream_count: int
    next_us: int  # when the first of them is due [since boot]
    stream_number: Ints = array(STREAMS, stored="i8")
    stream_us: Ints = array(STREAMS, stored="i8")  # interval
    stream_due_us: Ints = array(STREAMS, stored="i8")  # [since boot]
    stream_by_shell: Ints = array(STREAMS, stored="u1")  # the core cannot build it
    # who we are, and how the client listens
    system: int  # our system id in outgoing frames
    epoch_us: int  # Unix time at boot
    congested: bool  # the client reads too slowly: regular messages are left out
    # counts
    received: int  # frames
    taken: int  # messages that the core acted on
    sent: int
    lost: int  # gaps in sequence numbers
    bad_checksums: int
    # sequence numbers of senders
    sender_count: int
    sender_id: Ints = array(SENDERS, stored="i8")  # system << 8 | component
    sender_next: Ints = array(SENDERS, stored="i8")
    # out: frames, one behind the other
    out_count: int  # frames
    out_size: int  # bytes
    out_end: Ints = array(OUT_FRAMES, stored="i4")  # where each frame ends
    out: Ints = array(OUT_BYTES, stored="u1")
    spool: int  # address of the ``Spool`` to which they go while time passes; 0: they stay here
    # in: what has come and is not acted on yet
    stops_at_frames: bool  # the shell wants to see every frame
    in_at: int
    in_size: int
    frame_start: int  # of the frame that the core stopped at, in ``incoming``
    frame_end: int  # 0: it did not stop at one
    frame_taken: bool  # it has been acted on
    frame_number: int  # of its message
    frame_payload: int  # where its payload starts
    frame_payload_size: int
    frame_sender: int  # system << 8 | component
    frame_sequence: int
    frame_version: int
    payload: Ints = array(PAYLOAD_BYTES, stored="u1")  # of the frame, with the zeros that the sender left out
    incoming: Ints = array(IN_BYTES, stored="u1")


STATE = Port.fields["system"].offset
"""So many bytes at the beginning are what later frames depend on."""
OUT = Port.fields["out"].offset
PAYLOAD = Port.fields["payload"].offset
INCOMING = Port.fields["incoming"].offset
SIZE = Port.dtype.itemsize


@law
def find_next(port: Port) -> None:
    """Note when the first regular message is due."""
    soonest = NEVER
    for k in range(port.stream_count):
        soonest = min(soonest, port.stream_due_us[k])
    port.next_us = soonest


@law
def note_sender(port: Port, sender: int, sequence: int) -> None:
    """Count frames that the client sent and that did not arrive."""
    for k in range(port.sender_count):
        if port.sender_id[k] == sender:
            port.lost += (sequence - port.sender_next[k]) & 0xFF
            port.sender_next[k] = (sequence + 1) & 0xFF
            return
    if port.sender_count < SENDERS:
        port.sender_id[port.sender_count] = sender
        port.sender_next[port.sender_count] = (sequence + 1) & 0xFF
        port.sender_count += 1
