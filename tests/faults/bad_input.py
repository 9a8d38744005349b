"""Recordings whose radar sends useless lists. Pure: the bytes of a capture in, those of another out.

The captures are those of the simulator: classic pcap, Ethernet, IPv4, UDP, ARS548 lists in IP fragments."""
import random
import struct

FILE_HEADER, PACKET_HEADER = 24, 16
ETHERNET, IP, UDP = 14, 20, 8
HEADERS = ETHERNET + IP + UDP
# Of an ARS548 detection list: its length with the SOME/IP header, and places within it.
LIST_BYTES = 35336
NUMBER_OF_DETECTIONS = 35309
STAMP = slice(28, 48)  # counters and time stamps, so that a frozen list is no repeated one


def _packets(capture):
    at = FILE_HEADER
    while at + PACKET_HEADER <= len(capture):
        length = struct.unpack_from("<I", capture, at + 8)[0]
        yield capture[at:at + PACKET_HEADER], capture[at + PACKET_HEADER:at + PACKET_HEADER + length]
        at += PACKET_HEADER + length


def datagrams(capture):
    """(packet header, whole Ethernet packet) in order; fragments are joined."""
    waiting = {}
    for header, packet in _packets(capture):
        identification, flags = struct.unpack_from(">HH", packet, ETHERNET + 4)
        if flags & 0x3FFF == 0:  # neither an offset nor more fragments
            yield header, bytearray(packet)
            continue
        key = (packet[ETHERNET + 12:ETHERNET + 20], identification)
        fragments = waiting.setdefault(key, {})
        end = ETHERNET + struct.unpack_from(">H", packet, ETHERNET + 2)[0]
        fragments[(flags & 0x1FFF) * 8] = packet[ETHERNET + IP:end]
        if flags & 0x2000 == 0:  # the last one, as they are in order
            body = b"".join(fragments[offset] for offset in sorted(fragments))
            del waiting[key]
            yield header, bytearray(packet[:ETHERNET + IP]) + body


def _checksum(header):
    total = sum(struct.unpack(">10H", header))
    total = (total & 0xFFFF) + (total >> 16)
    return ~(total + (total >> 16)) & 0xFFFF


def _as_one_packet(packet):
    struct.pack_into(">H", packet, ETHERNET + 2, len(packet) - ETHERNET)
    struct.pack_into(">H", packet, ETHERNET + 6, 0x4000)  # no fragment
    struct.pack_into(">H", packet, ETHERNET + 10, 0)
    struct.pack_into(">H", packet, ETHERNET + 10, _checksum(packet[ETHERNET:ETHERNET + IP]))
    struct.pack_into(">H", packet, ETHERNET + IP + 6, 0)  # UDP without a checksum
    return packet


def damaged(capture, damage, sender, duration_s):
    """The capture with `damage` (damaged, empty, frozen) in the lists of the radar at the IPv4 address `sender`, its first
    `duration_s` only."""
    rng = random.Random(1)
    address = bytes(int(part) for part in sender.split("."))
    first_list = first_s = None
    made = [capture[:FILE_HEADER]]
    for header, packet in datagrams(capture):
        stamp_s = struct.unpack_from("<I", header)[0]
        first_s = stamp_s if first_s is None else first_s
        if stamp_s > first_s + duration_s:
            break
        is_list = len(packet) - HEADERS == LIST_BYTES and packet[ETHERNET + 12:ETHERNET + 16] == address
        if is_list and damage == "damaged":
            for _ in range(rng.randint(1, 50)):
                packet[HEADERS + rng.randrange(LIST_BYTES)] ^= 1 << rng.randrange(8)
        elif is_list and damage == "empty":
            struct.pack_into(">I", packet, HEADERS + NUMBER_OF_DETECTIONS, 0)
        elif is_list and damage == "frozen":
            first_list = first_list or bytes(packet)
            stamp = bytes(packet[HEADERS:])[STAMP]
            packet = bytearray(first_list)
            packet[HEADERS + STAMP.start:HEADERS + STAMP.stop] = stamp
        packet = _as_one_packet(packet)
        made += [header[:8], struct.pack("<II", len(packet), len(packet)), bytes(packet)]
    return b"".join(made)
