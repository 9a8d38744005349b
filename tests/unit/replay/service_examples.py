#!/usr/bin/env python3
"""The worked examples of interfaces/wire/boresight_service.md, made from the document alone (no product code):
service_examples.py DOCUMENT compares them and exits with 1 if one differs; with --write it puts them in."""
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import worked_examples  # noqa: E402

SERVICE, MAJOR, MINOR, INSTANCE = 0x4253, 1, 0, 3


def crc64_xz(data):
    crc = 0xFFFFFFFFFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xC96C5795D7870F42 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFFFFFFFFFF


def event(event_id, session, counter, body):
    """A whole notification: SOME/IP header, E2E profile 7 header, body."""
    request_id_on = struct.pack(">HHBBBB", 0, session, 1, MAJOR, 2, 0)
    length = len(request_id_on) + 20 + len(body)
    data_id = SERVICE << 16 | INSTANCE << 8 | event_id & 0xFF
    rest = struct.pack(">III", length, counter, data_id) + body
    crc = crc64_xz(request_id_on + rest)
    return struct.pack(">HHI", SERVICE, event_id, length) + request_id_on + struct.pack(">Q", crc) + rest


def detection_list(records, session=7, counter=5, cycle=1234):
    fields = 0b111111
    body = struct.pack(">HHIIBBHIIffHH", 1, 36, 1767225600, 250000000, 1, 0, 0, cycle, fields, -60.0, 20.0,
                       len(records), 48)
    for record in records:
        body += struct.pack(">11fHH", *record[:11], record[11], 0)
    return event(0x8001, session, counter, body)


def ego_motion():
    body = struct.pack(">HHIIBBBBIfff", 1, 32, 1767225600, 260000000, 1, 0, 0, 0, 0b1111, 13.5, 0.125, -0.5)
    return event(0x8002, 8, 0, body)


def segments(message):
    """The datagrams of a message whose payload is longer than 1392 bytes."""
    payload = message[16:]
    for offset in range(0, len(payload), 1392):
        part = payload[offset:offset + 1392]
        more = 1 if offset + 1392 < len(payload) else 0
        yield (message[:4] + struct.pack(">I", 8 + 4 + len(part)) + message[8:14] + b"\x22" + message[15:16] +
               struct.pack(">I", offset | more) + part)


def discovery(flags, session, entries, options):
    sd = struct.pack(">B3xI", flags, len(entries)) + entries + struct.pack(">I", len(options)) + options
    return struct.pack(">HHIHHBBBB", 0xFFFF, 0x8100, 8 + len(sd), 0, session, 1, 1, 2, 0) + sd


def endpoint(kind, address, port):
    return struct.pack(">HBB4BBBH", 9, kind, 0, *address, 0, 17, port)


def entry_of_service(kind, options, ttl):
    return struct.pack(">BBBBHHII", kind, 0, 0, options << 4, SERVICE, INSTANCE, MAJOR << 24 | ttl, MINOR)


def entry_of_eventgroup(kind, options, ttl, eventgroup):
    return struct.pack(">BBBBHHIHH", kind, 0, 0, options << 4, SERVICE, INSTANCE, MAJOR << 24 | ttl, 0, eventgroup)


RECORDS = [
    (25.5, 0.25, 0.0625, -13.25, 0.25, 0.0078125, 0.015625, 0.0625, 12.5, 24.0, 0.75, 0),
    (120.0, -0.5, -0.03125, -61.5, 0.5, 0.0078125, 0.015625, 0.0625, -3.5, 15.0, 1.0, 2),
]
SERVER, CLIENT, GROUP = (192, 168, 10, 13), (192, 168, 10, 2), (239, 66, 83, 1)
LONG = list(segments(detection_list([RECORDS[0]] * 40)))

EXAMPLES = {
    "detection list": detection_list(RECORDS),
    "ego motion": ego_motion(),
    "first segment, first 72 bytes": LONG[0][:72],
    "last segment, first 72 bytes": LONG[1][:72],
    "offer": discovery(0xC0, 1, entry_of_service(1, 1, 3), endpoint(0x04, SERVER, 30603)),
    "subscribe": discovery(0xC0, 1, entry_of_eventgroup(6, 1, 3, 1), endpoint(0x04, CLIENT, 41000)),
    "acknowledge": discovery(0xC0, 1, entry_of_eventgroup(7, 1, 3, 1), endpoint(0x14, GROUP, 30650)),
}
assert len(LONG) == 2 and crc64_xz(b"123456789") == 0x995DC9BBDF1939FA

worked_examples.run(EXAMPLES)
