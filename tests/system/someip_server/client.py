"""A client of the Boresight SOME/IP service, written from interfaces/wire/boresight_service.md only."""
import socket
import struct
import time

SERVICE = 0x4253
SD_PORT = 30490


def crc64_xz(data):
    crc = 0xFFFFFFFFFFFFFFFF
    for byte in data:
        crc = CRC_TABLE[(crc ^ byte) & 0xFF] ^ crc >> 8
    return crc ^ 0xFFFFFFFFFFFFFFFF


def crc_table():
    for value in range(256):
        for _ in range(8):
            value = value >> 1 ^ (0xC96C5795D7870F42 if value & 1 else 0)
        yield value


CRC_TABLE = list(crc_table())


def need(condition, what):
    if not condition:
        raise AssertionError(what)


def messages_of(datagram):
    """The SOME/IP messages that share a datagram."""
    while datagram:
        length = struct.unpack_from(">I", datagram, 4)[0]
        need(8 <= length <= len(datagram) - 8, f"length {length} in a datagram of {len(datagram)} bytes")
        yield datagram[:8 + length]
        datagram = datagram[8 + length:]


class Client:
    """Service discovery from one address, and one socket for events."""

    def __init__(self, address, interface, group):
        self.family = socket.AF_INET6 if ":" in address else socket.AF_INET
        self.index = socket.if_nametoindex(interface)
        self.address, self.group = address, group
        self.unicast = self.bound(address, SD_PORT)
        self.multicast = self.joined(group, SD_PORT)
        self.events = self.bound(address, 0)
        self.event_port = self.events.getsockname()[1]
        self.session = {}
        self.offers = []   # (instance, ttl, endpoint, by multicast, flags, session, time)
        self.answers = []  # (instance, eventgroup, ttl, group)

    def socket(self):
        made = socket.socket(self.family, socket.SOCK_DGRAM)
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        made.setblocking(False)
        return made

    def where(self, address, port):
        return (address, port) if self.family == socket.AF_INET else (address, port, 0, self.index)

    def bound(self, address, port):
        made = self.socket()
        if self.family == socket.AF_INET:
            made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, struct.pack("4s4si", b"", b"", self.index))
            made.bind((address, port))
        else:
            made.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_MULTICAST_IF, self.index)
            made.bind((address, port, 0, 0))
        return made

    def joined(self, group, port):
        made = self.socket()
        made.bind(self.where(group, port))
        if self.family == socket.AF_INET:
            made.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                            struct.pack("4s4si", socket.inet_aton(group), b"", self.index))
        else:
            made.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_JOIN_GROUP,
                            socket.inet_pton(socket.AF_INET6, group) + struct.pack("@I", self.index))
        return made

    # --- discovery, out ----------------------------------------------------------------------------------------------
    def send_sd(self, to, entries, options=b""):
        session = self.session[to] = self.session.get(to, 0) + 1
        sd = b"\xc0\0\0\0" + struct.pack(">I", len(entries)) + entries + struct.pack(">I", len(options)) + options
        header = struct.pack(">HHIHHBBBB", 0xFFFF, 0x8100, 8 + len(sd), 0, session, 1, 1, 2, 0)
        self.unicast.sendto(header + sd, self.where(to, SD_PORT))

    def find(self, instance):
        self.send_sd(self.group, struct.pack(">BBBBHHII", 0, 0, 0, 0, SERVICE, instance, 0xFF << 24 | 0xFFFFFF,
                                             0xFFFFFFFF))

    def subscribe(self, server, instance, eventgroup, ttl, major=1):
        address = socket.inet_pton(self.family, self.address)
        option = struct.pack(">HBB", len(address) + 5, 4 if len(address) == 4 else 6, 0) + address
        option += struct.pack(">BBH", 0, 17, self.event_port)
        self.send_sd(server, struct.pack(">BBBBHHIHH", 6, 0, 0, 0x10, SERVICE, instance, major << 24 | ttl, 0,
                                         eventgroup), option)

    # --- discovery, in -----------------------------------------------------------------------------------------------
    def poll(self):
        for sock, by_multicast in ((self.unicast, False), (self.multicast, True)):
            while True:
                try:
                    datagram, sender = sock.recvfrom(65536)
                except BlockingIOError:
                    break
                if sender[0] == self.address:
                    continue
                for message in messages_of(datagram):
                    self.take_sd(message, by_multicast)

    def take_sd(self, message, by_multicast):
        ids, _, session, fixed = struct.unpack_from(">IIII", message)
        need(ids == 0xFFFF8100 and fixed == 0x01010200 and 1 <= session <= 0xFFFF, "header of an SD message")
        flags, entries_bytes = message[16], struct.unpack_from(">I", message, 20)[0]
        entries = message[24:24 + entries_bytes]
        options_bytes = struct.unpack_from(">I", message, 24 + entries_bytes)[0]
        rest = message[28 + entries_bytes:]
        need(len(rest) == options_bytes, "SD message with something behind its options")
        options = []
        while rest:
            length, kind = struct.unpack_from(">HB", rest)
            size = 4 if kind in (0x04, 0x14) else 16
            need(kind in (0x04, 0x06, 0x14, 0x16) and length == size + 5, f"option {kind:#x} of {length} bytes")
            protocol, port = struct.unpack_from(">BH", rest, 4 + size + 1)
            need(protocol == 17, "protocol is not UDP")
            options.append((kind, socket.inet_ntop(self.family, rest[4:4 + size]), port))
            rest = rest[3 + length:]
        for at in range(0, len(entries), 16):
            kind, first, _, counts, service, instance, major_ttl, last = struct.unpack_from(">BBBBHHII", entries, at)
            mine = options[first:first + (counts >> 4)]
            need(len(mine) == counts >> 4, "an entry names an option that is not there")
            ttl = major_ttl & 0xFFFFFF
            if kind == 1:
                need(service == SERVICE and major_ttl >> 24 == 1 and last == 0 and len(mine) == 1, "offer")
                self.offers.append((instance, ttl, mine[0], by_multicast, flags, session, time.monotonic()))
            elif kind == 7:
                self.answers.append((instance, last & 0xFFFF, ttl, mine[0] if mine else None))

    def wait(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while not condition():
            need(time.monotonic() < end, f"not within {seconds} s: {what}")
            self.poll()
            time.sleep(0.002)

    def answer(self, server, instance, eventgroup, ttl, major=1):
        """Subscribes and returns (ttl, group) of the answer."""
        self.answers.clear()
        self.subscribe(server, instance, eventgroup, ttl, major)
        self.wait(lambda: self.answers, 0.5, f"answer to a subscription of {instance}, {eventgroup}")
        need(len(self.answers) == 1 and self.answers[0][:2] == (instance, eventgroup), f"answers {self.answers}")
        return self.answers[0][2:]

    # --- events ------------------------------------------------------------------------------------------------------
    def receive(self, seconds, sock=None):
        """(time, sender's port, plain message) for each event; and the datagrams with how many messages they held."""
        sock = sock or self.events
        end = time.monotonic() + seconds
        parts, received, shared = {}, [], []
        # Messages that are incomplete at the end get another second.
        while time.monotonic() < end + (1.0 if parts else 0.0):
            try:
                datagram, sender = sock.recvfrom(65536)
            except BlockingIOError:
                self.poll()
                time.sleep(0.001)
                continue
            held = list(messages_of(datagram))
            shared.append(len(held))
            for message in held:
                whole = self.put_together(parts, sender[1], message)
                if whole:
                    received.append((time.monotonic(), sender[1], whole))
        need(not parts, "a segmented message never ended")
        return received, shared

    @staticmethod
    def put_together(parts, port, message):
        if message[14] == 0x02:
            need(port not in parts, "a message between the segments of another")
            need(len(message) <= 16 + 1392, "an unsegmented message is too long")
            return message
        need(message[14] == 0x22, f"message type {message[14]:#x}")
        tp = struct.unpack_from(">I", message, 16)[0]
        offset, more = tp & ~15, tp & 1
        header, payload = parts.get(port, (message[:4] + message[8:14], b""))
        need(header == message[:4] + message[8:14] and offset == len(payload), "segments are not in order")
        payload += message[20:]
        if more:
            need(len(message) - 20 == 1392, "a segment is not full")
            parts[port] = header, payload
            return None
        parts.pop(port)
        return header[:4] + struct.pack(">I", 8 + len(payload)) + header[4:] + b"\x02\0" + payload


def decode(message, instance):
    """Checks header and E2E; returns (event, session, counter, body)."""
    service, event, length, client, session, protocol, major, kind, code = struct.unpack_from(">HHIHHBBBB", message)
    need((service, client, protocol, major, kind, code) == (SERVICE, 0, 1, 1, 2, 0), "SOME/IP header")
    crc, e2e_length, counter, data_id = struct.unpack_from(">QIII", message, 16)
    need(length == e2e_length == len(message) - 8, "lengths")
    need(data_id == SERVICE << 16 | instance << 8 | event & 0xFF, f"Data ID {data_id:#x}")
    need(crc == crc64_xz(message[8:16] + message[24:]), "CRC")
    return event, session, counter, message[36:]


def decode_list(body):
    """(epoch seconds, sync status, cycle, fields, records) of a detection list."""
    (version, header, seconds, nanoseconds, sync, _, _, cycle, fields, _, _, count,
     size) = struct.unpack_from(">HHIIBBHIIffHH", body)
    need((version, header, size) == (1, 36, 48) and len(body) == 36 + 48 * count, "layout of a detection list")
    need(nanoseconds < 10**9, "nanoseconds")
    return (seconds + nanoseconds * 1e-9, sync, cycle, fields,
            [struct.unpack_from(">11fHH", body, 36 + 48 * i) for i in range(count)])
