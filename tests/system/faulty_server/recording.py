"""Builds a recording of a faulty server and its expected results."""
from scapy.layers.inet import IP, UDP
from scapy.layers.l2 import Ether
from scapy.utils import checksum

from wire import *

SERVER = "10.66.85.1"
CLIENT, CLIENT_PORT = "10.66.85.2", 30600
STRANGER = "10.66.85.9"
EPOCH_NS = 1_767_225_600 * 10**9
MILLISECOND = 1_000_000
SCENARIOS = []  # (name, function), as the modules below fill it

# Kinds of faults and parts of their texts.
CUT = "wrong length", "fewer than the 16 bytes"
TOO_SMALL = "wrong length", "length field below 8"
BEYOND = "wrong length", "beyond the datagram"
PROTOCOL = "wrong value", "protocol version is not 1"
TYPE = "wrong value", "unknown message type"
HEADER = "wrong value", "interface version, message type or return code"
STRANGERS = "unknown message", "Boresight service from an unknown sender"
INCOMPLETE = "wrong length", "segments are missing"
NO_SESSION = "wrong value", "session id 0"
TP_SHORT = "wrong length", "without a TP header or without data"
NOT_MULTIPLE = "wrong length", "not a multiple of 16"
CONTRADICTION = "wrong value", "contradicts the length"
OVERSIZE = "wrong length", "longer than configured"
CRC, LENGTH, DATA_ID = (("wrong value", f"wrong {what}") for what in ("CRC", "length", "Data ID"))
REPEATED, SEQUENCE = ("wrong value", "repeated"), ("wrong value", "wrong sequence")
ENDPOINT = "wrong value", "address or port of an endpoint option"
NO_ENDPOINT = "wrong value", "states no UDP endpoint"


class Recording:
    def __init__(self):
        self.now_ns = EPOCH_NS
        self.packets, self.headers, self.faults = [], {}, {}
        self.delivered, self.optional, self.egos = [], [], []
        self.e2e = {1: [0, 0, 0], 2: [0, 0, 0]}  # lost, repeated, wrong
        self.at_least = False  # expected numbers of faults are minimums
        self.one, self.two = Instance(1, SERVER, 30601), Instance(2, SERVER, 30602)
        self.sd_session = 0
        self.next_offer_ns = None  # while offers are not sent by themselves

    # --- what happens ------------------------------------------------------------------------------------------------
    def wait(self, milliseconds):
        self.now_ns += int(milliseconds * MILLISECOND)

    def packet(self, payload, source, destination):
        way = source + destination
        if way not in self.headers:
            self.headers[way] = bytes(Ether(src="02:00:00:00:00:01", dst="02:00:00:00:00:02") /
                                      IP(src=source[0], dst=destination[0], len=0, chksum=0) /
                                      UDP(sport=source[1], dport=destination[1], len=0, chksum=0))
        header = bytearray(self.headers[way])
        header[16:18] = (28 + len(payload)).to_bytes(2, "big")
        header[24:26] = checksum(bytes(header[14:34])).to_bytes(2, "big")
        header[38:40] = (8 + len(payload)).to_bytes(2, "big")
        self.packets.append((self.now_ns, bytes(header) + payload))
        self.now_ns += 20_000

    def send(self, payloads, source=None, to=(CLIENT, CLIENT_PORT)):
        source = source or self.one
        for payload in payloads if isinstance(payloads, list) else [payloads]:
            self.packet(payload, (source.address, source.port), to)

    def sd(self, entries, options=(), *, by_multicast=True, raw=None, **how):
        self.sd_session += 1
        message = sd(entries, options, **({"session": self.sd_session} | how))
        self.packet(raw(message) if raw else message, (SERVER, SD_PORT),
                    (SD_GROUP if by_multicast else CLIENT, SD_PORT))

    def offer(self, **how):
        self.sd([offer_entry(1, 0, **how), offer_entry(2, 1, **how)],
                [endpoint(SERVER, self.one.port), endpoint(SERVER, self.two.port)])

    def list(self, count=200, instance=None, variant=PLAIN, **changes):
        return (instance or self.one).list(count, self.now_ns - 10 * MILLISECOND, variant, **changes)

    def good(self, instance=None, count=200):
        """A valid list, which is delivered."""
        instance = instance or self.one
        message, what = self.list(count, instance)
        self.send(datagrams(message), instance)
        self.delivered.append(what)

    def cycle(self, how=None, count=200):
        """One cycle of both radars; `how(message)` gives the faulty datagrams of radar 1."""
        self.good(self.two, count)
        if how is None:
            self.good(self.one, count)
        else:
            message, what = self.list(count)
            self.send(how(message))
            self.delivered.append(what)
        self.rest()

    def bad_cycle(self, how, *faults, count=200, lost=0, wrong=0, repeated=0, **changes):
        """One cycle in which radar 1's list must not be delivered."""
        self.good(self.two, min(count, 1024))
        message, _ = self.list(count, **changes)
        self.send(how(message))
        self.fault(*faults)
        self.statistics(lost, repeated, wrong)
        self.rest()

    def rest(self):
        self.now_ns = -(-(self.now_ns - EPOCH_NS) // (50 * MILLISECOND)) * 50 * MILLISECOND + EPOCH_NS
        if self.next_offer_ns is not None and self.now_ns >= self.next_offer_ns:
            self.offer()
            self.next_offer_ns = self.now_ns + 1000 * MILLISECOND

    # --- what is expected --------------------------------------------------------------------------------------------
    def fault(self, *faults, radar=1):
        for kind, words in faults:
            of = 0 if (kind, words) in (INCOMPLETE, STRANGERS) else radar
            key = f"{kind}|{of}|{words}"
            self.faults[key] = self.faults.get(key, 0) + 1

    def statistics(self, lost=0, repeated=0, wrong=0, radar=1):
        self.e2e[radar] = [a + b for a, b in zip(self.e2e[radar], (lost, repeated, wrong))]


def scenario(body):
    SCENARIOS.append((body.__name__, body))
    return body


def whole(message):
    return [message]
