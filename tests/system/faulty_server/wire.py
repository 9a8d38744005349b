"""Messages of the Boresight service (interfaces/wire/boresight_service.md) as scapy builds them, right or wrong.

Detections are derived from radar, cycle and position by known_values(), so that whoever knows the rule sees from the
values alone whether anything was changed on the way; expected.hpp repeats the rule for C++.
"""
import struct

from scapy.contrib.automotive.someip import (SD, SOMEIP, SDEntry_EventGroup, SDEntry_Service, SDOption_IP4_EndPoint,
                                             SDOption_IP4_Multicast)
from scapy.packet import Raw

SERVICE = 0x4253
LISTS, EGO = 1, 2  # eventgroups, and the low byte of the events
SEGMENT_BYTES = 1392
SD_GROUP, SD_PORT = "224.244.224.245", 30490
RATE_MIN, RATE_MAX = -50.0, 50.0
NAN, INF = float("nan"), float("inf")
# Variants of a list; known.hpp has their effect.
PLAIN, NOT_NUMBERS, NO_INTERVAL = 0, 1, 2


def crc64_table():
    for value in range(256):
        for _ in range(8):
            value = value >> 1 ^ (0xC96C5795D7870F42 if value & 1 else 0)
        yield value


CRC64_TABLE = list(crc64_table())


def crc64_xz(data):
    crc = 0xFFFFFFFFFFFFFFFF
    for byte in data:
        crc = CRC64_TABLE[(crc ^ byte) & 0xFF] ^ crc >> 8
    return crc ^ 0xFFFFFFFFFFFFFFFF


assert crc64_xz(b"123456789") == 0x995DC9BBDF1939FA  # the check value of the catalogue of CRCs


def known_values(radar, cycle, i):
    """The eleven floats of a record, each exact as f32, and its flags."""
    h = (cycle * 2654435761 + radar * 40503 + i * 7919) & 0xFFFFFFFF
    return [(h & 0xFFFF) / 64, ((h >> 4 & 0xFFF) - 2048) / 2048, ((h >> 8 & 0x3FF) - 512) / 2048,
            ((h >> 12 & 0xFFF) - 2048) / 32, (h >> 1 & 0xFF) / 64, (h >> 3 & 0xFF) / 8192, (h >> 5 & 0xFF) / 8192,
            (h >> 7 & 0xFF) / 64, ((h >> 9 & 0xFFF) - 2048) / 32, (h >> 11 & 0xFFF) / 32, (h >> 2 & 0xFF) / 256,
            h >> 16 & 1]


# (record, field, value): the entries that NOT_NUMBERS puts into a list.
BAD_NUMBERS = ((0, 0, NAN), (1, 1, INF), (2, 3, -INF), (3, 2, NAN), (4, 8, NAN), (5, 9, INF), (6, 10, NAN), (7, 10, 1.5),
               (8, 0, -1.0), (9, 1, 3.5), (10, 4, NAN), (11, 5, -INF), (12, 6, -1.0), (13, 7, INF))


def list_body(radar, cycle, count, time_ns, variant=PLAIN, *, layout=1, header_bytes=36, record_bytes=48,
              stated_count=None, nanoseconds=None, sync=1, extra=b""):
    """A detection list. `extra` bytes follow the last record, or are missing from it if it is a negative number."""
    records = [known_values(radar, cycle, i) for i in range(count)]
    if variant == NOT_NUMBERS:
        for i, field, value in BAD_NUMBERS:
            records[i][field] = value
    interval = (NAN, RATE_MAX) if variant == NO_INTERVAL else (RATE_MIN, RATE_MAX)
    header = struct.pack(">HHIIBBHIIffHH", layout, header_bytes, time_ns // 10**9,
                         time_ns % 10**9 if nanoseconds is None else nanoseconds, sync, 0, 0, cycle, 0x3F, *interval,
                         count if stated_count is None else stated_count, record_bytes)
    body = header.ljust(header_bytes, b"\xEE")
    body += b"".join(struct.pack(">11fHH", *record, 0).ljust(record_bytes, b"\xEE") for record in records)
    return body[:extra] if isinstance(extra, int) else body + extra


def ego_body(speed, time_ns, *, layout=1, stated_bytes=32):
    return struct.pack(">HHIIBBBBIfff", layout, stated_bytes, time_ns // 10**9, time_ns % 10**9, 1, 0, 0, 0, 0xF, speed,
                       0.125, -0.5)


def protected(instance, event, session, counter, body, *, kind=0x02, protocol=1, interface=1, code=0, client=0,
              service=SERVICE, crc_error=0, length_error=0, data_id=None, counter_sent=None):
    """A message with E2E profile 7 and its header by scapy."""
    length = 8 + 20 + len(body) + length_error
    counter = counter if counter_sent is None else counter_sent
    data_id = SERVICE << 16 | instance << 8 | event if data_id is None else data_id
    header = bytes(SOMEIP(srv_id=service, sub_id=1, event_id=event, len=8 + 20 + len(body), client_id=client,
                          session_id=session, proto_ver=protocol, iface_ver=interface, msg_type=kind, retcode=code))[:16]
    covered = struct.pack(">III", length, counter, data_id) + body
    crc = crc64_xz(header[8:16] + covered) ^ crc_error
    return header + struct.pack(">Q", crc) + covered


def segment(message, offset, data, more, *, reserved=0):
    """One TP segment of the message, with any offset and data."""
    header = bytes(SOMEIP(msg_type=message[14] | 0x20, offset=offset // 16, res=reserved, more_seg=int(more)))[16:20]
    length = (12 + len(data)).to_bytes(4, "big")
    return message[:4] + length + message[8:14] + bytes([message[14] | 0x20, message[15]]) + header + data


def segments(message, size=SEGMENT_BYTES, step=None):
    """The message in segments of `size` bytes, a new one each `step` bytes: below `size`, they overlap."""
    payload, step = message[16:], step or size
    cut, offset = [], 0
    while True:
        more = offset + size < len(payload)
        cut.append(segment(message, offset, payload[offset:offset + size], more))
        if not more:
            return cut
        offset += step


def datagrams(message):
    """The datagrams that the document specifies."""
    return segments(message) if len(message) - 16 > SEGMENT_BYTES else [message]


# --- service discovery -----------------------------------------------------------------------------------------------
def sd(entries, options=(), *, session, flags=0xC0, header=None):
    """An SD message; `header` changes fields of its SOME/IP header."""
    payload = SD(flags=flags, entry_array=list(entries), option_array=list(options))
    fields = dict(srv_id=0xFFFF, sub_id=1, event_id=0x100, session_id=session, proto_ver=1, iface_ver=1, msg_type=0x02)
    return bytes(SOMEIP(**(fields | (header or {}))) / Raw(bytes(payload)))


def offer_entry(instance, option=0, *, ttl=3, options=1, service=SERVICE, major=1, kind=1):
    return SDEntry_Service(type=kind, srv_id=service, inst_id=instance, major_ver=major, ttl=ttl, minor_ver=0,
                           index_1=option, n_opt_1=options)


def ack_entry(instance, eventgroup, *, ttl=3, counter=0, options=0, kind=7, major=1):
    return SDEntry_EventGroup(type=kind, srv_id=SERVICE, inst_id=instance, major_ver=major, ttl=ttl, cnt=counter,
                              eventgroup_id=eventgroup, n_opt_1=options)


def endpoint(address, port, protocol=0x11):
    return SDOption_IP4_EndPoint(addr=address, l4_proto=protocol, port=port)


def group(address, port):
    return SDOption_IP4_Multicast(addr=address, l4_proto=0x11, port=port)


class Instance:
    """A server's instance: its counters and its endpoint."""

    def __init__(self, number, address, port):
        self.number, self.address, self.port = number, address, port
        self.restart(1000 * number)

    def restart(self, cycle):
        self.session, self.cycle, self.counters = 1, cycle, {LISTS: 0, EGO: 0}

    def event(self, event, body, **changes):
        """The next message with `changes`; the counters advance."""
        session = changes.pop("session", self.session)
        message = protected(self.number, event, session, self.counters[event], body, **changes)
        self.session = self.session % 0xFFFF + 1
        self.counters[event] = self.counters[event] + 1 & 0xFFFFFFFF
        return message

    def list(self, count, time_ns, variant=PLAIN, body=None, **changes):
        """(message, expected delivery)"""
        self.cycle += 1
        made = list_body(self.number, self.cycle, count, time_ns, variant, **(body or {}))
        return self.event(LISTS, made, **changes), (self.number, self.cycle, count, variant)

    def ego(self, speed, time_ns, body=None, **changes):
        return self.event(EGO, ego_body(speed, time_ns, **(body or {})), **changes)
