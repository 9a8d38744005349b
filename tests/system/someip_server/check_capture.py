#!/usr/bin/env python3
"""check_capture.py CAPTURE: decodes every byte that the server sent with scapy, without a remainder."""
import sys

from scapy.contrib.automotive.someip import SD, SOMEIP
from scapy.layers.inet import UDP
from scapy.packet import Raw
from scapy.utils import rdpcap

OFFERED = set(range(30601, 30617)) | {30490}
EVENTS = (0x8001, 0x8002)


def messages_of(datagram):
    while datagram:
        length = 8 + int.from_bytes(datagram[4:8], "big")
        assert 16 <= length <= len(datagram), "length of a message"
        yield datagram[:length]
        datagram = datagram[length:]


def check(message):
    """The kind of the message; asserts that scapy decodes the expected values and builds the same bytes from them."""
    parsed = SOMEIP(message)
    assert parsed.proto_ver == 1 and parsed.iface_ver == 1 and parsed.retcode == 0 and parsed.client_id == 0
    assert parsed.len == len(message) - 8 and parsed.session_id != 0
    parsed.len = None
    assert bytes(parsed) == message, "scapy builds other bytes than it was given"
    if parsed.srv_id == 0xFFFF:
        sd = SD(message[16:])
        assert not sd.haslayer(Raw) and not sd.payload, "SD message with something behind its options"
        assert sd.len_entry_array == 16 * len(sd.entry_array) > 0
        assert all(option.len == len(bytes(option)) - 3 for option in sd.option_array), "length of an option"
        sd.len_entry_array = sd.len_option_array = None
        assert bytes(sd) == message[16:]
        return "discovery"
    assert parsed.srv_id == 0x4253 and parsed.sub_id == 1
    assert parsed.event_id | 0x8000 in EVENTS
    if parsed.msg_type == 0x22:
        assert parsed.res == 0 and (parsed.more_seg == 0 or len(message) - 20 == 1392)
        return "segment"
    assert parsed.msg_type == 0x02
    return "event"


counts = {}
for number, packet in enumerate(rdpcap(sys.argv[1]), 1):
    # In this test only the server sends from these addresses and ports.
    if UDP not in packet or packet[UDP].sport not in OFFERED:
        continue
    source = packet.payload.src
    if source not in ("10.66.83.1", "fd66::1"):
        continue
    try:
        for message in messages_of(bytes(packet[UDP].payload)):
            kind = check(message)
            counts[kind] = counts.get(kind, 0) + 1
    except (AssertionError, ValueError, IndexError) as problem:
        sys.exit(f"frame {number}: {problem}")
assert set(counts) == {"discovery", "segment", "event"}, f"the capture lacks something: {counts}"
print(f"scapy: {counts}")
