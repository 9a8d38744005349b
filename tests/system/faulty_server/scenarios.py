"""scenarios.py FOLDER: recordings of a faulty server, one file a scenario, and expected.toml: what becomes of each.

Two radars (instances 1 and 2; 1 also sends ego motion) are offered and send a list each 50 ms. In between comes what the
scenario is about. Everything is fixed: times, seeds, values. Exit code 77: no scapy.
"""
import random
import sys
from pathlib import Path

try:
    from wire import *
    from scapy.layers.inet import IP, UDP
    from scapy.layers.l2 import Ether
    from scapy.utils import wrpcap
except ImportError as problem:
    print(f"skipped: python3-scapy is not installed ({problem})")
    sys.exit(77)

SERVER = "10.66.85.1"
CLIENT, CLIENT_PORT = "10.66.85.2", 30600
STRANGER = "10.66.85.9"
EPOCH_NS = 1_767_225_600 * 10**9
MILLISECOND = 1_000_000
SCENARIOS = []

# Kinds of faults and words of their reasons.
CUT = "wrong length", "fewer than the 16 bytes"
TOO_SMALL = "wrong length", "length field below 8"
BEYOND = "wrong length", "beyond the datagram"
PROTOCOL = "wrong value", "protocol version is not 1"
TYPE = "wrong value", "unknown message type"
HEADER = "wrong value", "interface version, message type or return code"
STRANGERS = "unknown message", "sender that nobody waits for"
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
        self.packets, self.faults = [], {}
        self.delivered, self.optional, self.egos = [], [], []
        self.e2e = {1: [0, 0, 0], 2: [0, 0, 0]}  # lost, repeated, wrong
        self.at_least = False  # faults are only counted in sum
        self.one, self.two = Instance(1, SERVER, 30601), Instance(2, SERVER, 30602)
        self.sd_session = 0
        self.next_offer_ns = None  # while offers are not sent by themselves

    # --- what happens ------------------------------------------------------------------------------------------------
    def wait(self, milliseconds):
        self.now_ns += int(milliseconds * MILLISECOND)

    def packet(self, payload, source, destination):
        packet = Ether(src="02:00:00:00:00:01", dst="02:00:00:00:00:02") / IP(src=source[0], dst=destination[0]) / UDP(
            sport=source[1], dport=destination[1]) / Raw(payload)
        packet.time = self.now_ns / 10**9
        packet.now_ns = self.now_ns
        self.packets.append(packet)
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
        """As it should be, and delivered."""
        instance = instance or self.one
        message, what = self.list(count, instance)
        self.send(datagrams(message), instance)
        self.delivered.append(what)

    def cycle(self, how=None, count=200):
        """One cycle of both radars; `how(message)` gives the datagrams of radar 1 if they are not as they should be."""
        self.good(self.two, count)
        if how is None:
            self.good(self.one, count)
        else:
            message, what = self.list(count)
            self.send(how(message))
            self.delivered.append(what)
        self.rest()

    def bad_cycle(self, how, *faults, count=200, lost=0, wrong=0, repeated=0, **changes):
        """One cycle in which radar 1's list is not to be delivered."""
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


# --- segments: nothing is lost ---------------------------------------------------------------------------------------
@scenario
def in_order(r):
    for count in (0, 1, 27, 28, 29, 57, 200, 1023, 1024):
        r.cycle(count=count)


@scenario
def reversed_order(r):
    for _ in range(3):
        r.cycle(lambda m: segments(m)[::-1])


@scenario
def swapped_pairs(r):
    def swap(message):
        parts = segments(message)
        parts[0:-1:2], parts[1::2] = parts[1::2], parts[0:-1:2]
        return parts
    for count in (200, 60, 400):
        r.cycle(swap, count=count)


@scenario
def reordered_by_three_and_more(r):
    r.cycle(lambda m: segments(m)[3:] + segments(m)[:3])
    r.cycle(lambda m: segments(m)[1:4] + segments(m)[:1] + segments(m)[4:])
    shuffle = random.Random(85)
    for _ in range(12):
        r.cycle(lambda m: shuffle.sample(parts := segments(m), len(parts)), count=shuffle.randrange(60, 500))


@scenario
def duplicated(r):
    r.cycle(lambda m: [part for part in segments(m) for _ in range(2)])
    r.cycle(lambda m: segments(m) * 2)
    r.cycle(lambda m: segments(m) + segments(m)[-1:] * 3)
    # So late that the segments are put together again: the E2E counter tells.
    message, what = r.list()
    r.send(segments(message))
    r.delivered.append(what)
    r.wait(30)
    r.send(segments(message))
    r.fault(REPEATED)
    r.statistics(repeated=1)
    r.rest()
    r.cycle()


@scenario
def overlapping(r):
    for size, step in ((1392, 1376), (1392, 16), (64, 48)):
        r.cycle(lambda m: segments(m, size, step), count=40)
    r.cycle(lambda m: segments(m, 1392, 704)[::-1])
    # Of conflicting bytes the first ones win: here the right ones …
    r.cycle(lambda m: segments(m)[:2] + [segment(m, 1392, b"\xAA" * 1392 + m[16 + 2784:16 + 4176], True)] + segments(m)[3:])
    # … and here the wrong ones, which the E2E CRC finds.
    r.bad_cycle(lambda m: [segment(m, 1392, b"\xAA" * 1392, True)] + segments(m), CRC, wrong=1)
    r.cycle()
    r.statistics(lost=1)


@scenario
def scapy_cuts(r):
    """scapy's own fragment(), which ends a payload that is a multiple of the size by an empty segment."""
    for size in (1392, 16, 928):
        r.cycle(lambda m: [bytes(part) for part in SOMEIP(m[:14] + b"\x22" + m[15:16] + b"\0\0\0\0" + m[16:]).fragment(size)],
                count=60)


# --- segments: a message is lost, the next is not --------------------------------------------------------------------
@scenario
def lost_segments(r):
    for lost in (0, 3, -1):
        def without(message):
            parts = segments(message)
            del parts[lost]
            return parts
        r.cycle()
        r.bad_cycle(without, INCOMPLETE, lost=1)
        r.cycle()
    # Only one is there; and the last message of all is incomplete, too.
    r.bad_cycle(lambda m: segments(m)[2:3], INCOMPLETE, lost=1)
    r.cycle()
    r.bad_cycle(lambda m: segments(m)[:-1], INCOMPLETE)


@scenario
def truncated_segments(r):
    def cut(at, size):
        def how(message):
            parts = segments(message)
            parts[at] = segment(message, at * SEGMENT_BYTES, message[16 + at * SEGMENT_BYTES:][:size], at < 6)
            return parts
        return how

    def cut_datagram(message):
        parts = segments(message)
        parts[3] = parts[3][:700]
        return parts
    r.bad_cycle(cut(2, 1376), INCOMPLETE)
    r.cycle()
    r.bad_cycle(cut(6, 1000), LENGTH, lost=0, wrong=1)
    r.cycle()
    r.statistics(lost=1)
    r.bad_cycle(cut_datagram, BEYOND, INCOMPLETE, lost=1)
    r.cycle()
    # The right segment after the wrong one saves the message.
    r.cycle(lambda m: cut_datagram(m) + segments(m)[3:4])
    r.fault(BEYOND)


@scenario
def no_multiple_of_16(r):
    def cut(message):
        parts = segments(message)
        parts[1] = segment(message, 1392, message[16 + 1392:][:1391], True)
        return parts
    r.cycle()
    r.bad_cycle(cut, NOT_MULTIPLE, INCOMPLETE, lost=1)
    r.cycle()
    r.cycle(lambda m: cut(m) + segments(m)[1:2])
    r.fault(NOT_MULTIPLE)


@scenario
def oversize(r):
    r.cycle()
    r.bad_cycle(lambda m: segments(m)[:3] + [segment(m, 131072, b"\xAA" * 1392, True)] + segments(m)[3:], OVERSIZE,
                INCOMPLETE, lost=1)
    r.cycle()
    r.bad_cycle(lambda m: segments(m)[:3] + [segment(m, 0xFFFFFFF0, b"\xAA" * 16, True)] + segments(m)[3:], OVERSIZE,
                INCOMPLETE, lost=1)
    r.cycle()
    # A sender that never ends: up to the limit, and beyond.
    r.bad_cycle(lambda m: [segment(m, offset, b"\xAA" * 1392, True) for offset in range(0, 140_000, 1392)], OVERSIZE,
                INCOMPLETE, lost=1)
    r.cycle()
    # From the first segment on: nothing is kept, and what follows is only incomplete.
    r.bad_cycle(lambda m: [segment(m, 200_000, b"\xAA" * 64, False)] + segments(m)[:2], OVERSIZE, INCOMPLETE, lost=1)
    r.cycle()


@scenario
def contradictory_ends(r):
    r.cycle()
    r.cycle(lambda m: segments(m)[:4] + [segment(m, 2784, b"\xAA" * 16, False)] + segments(m)[4:])
    r.fault(CONTRADICTION)
    r.cycle(lambda m: segments(m)[6:] + [segment(m, 9664, b"\xAA" * 160, True)] + segments(m)[:6])
    r.fault(CONTRADICTION)
    # An end that comes first is believed, and its message lost.
    r.bad_cycle(lambda m: [segment(m, 1392, b"\xAA" * 16, False)] + segments(m), LENGTH, wrong=1)
    r.cycle()
    r.statistics(lost=1)


@scenario
def empty_segments(r):
    def header_only(message):
        return message[:4] + (8 + 2).to_bytes(4, "big") + message[8:14] + b"\x22\0" + b"\0\1"
    r.cycle(lambda m: [header_only(m)] + segments(m) + [header_only(m)])
    r.fault(TP_SHORT, TP_SHORT)
    r.cycle(lambda m: segments(m)[:3] + [segment(m, 4176, b"", True), segment(m, 0, b"", False)] + segments(m)[3:])
    r.fault(TP_SHORT, TP_SHORT)


@scenario
def reserved_bits(r):
    def with_bits(message):
        return [segment(message, offset, message[16 + offset:][:1392], offset + 1392 < len(message) - 16, reserved=5)
                for offset in range(0, len(message) - 16, 1392)]
    r.cycle(with_bits)


# --- several messages at once ----------------------------------------------------------------------------------------
@scenario
def interleaved_senders(r):
    stranger = Instance(1, STRANGER, 30601)
    for _ in range(4):
        first, one = r.list()
        second, two = r.list(instance=r.two)
        for a, b in zip(segments(first), segments(second)):
            r.send(a)
            r.send(b, r.two)
            message, _ = r.list(instance=stranger)
            r.send(segments(message)[:2], stranger)
            r.fault(STRANGERS, STRANGERS)
        r.delivered += [one, two]
        r.rest()


@scenario
def flood_of_strangers(r):
    """Forty senders that nobody asked begin a message between any two segments of ours."""
    strangers = [Instance(1, STRANGER, 40_000 + i) for i in range(40)]
    for _ in range(2):
        message, what = r.list()
        for part in segments(message):
            for stranger in strangers:
                begun, _ = r.list(instance=stranger, count=40)
                r.send(segments(begun)[:1], stranger)
                r.fault(STRANGERS)
            r.send(part)
        r.delivered.append(what)
        r.rest()


@scenario
def flood_of_kinds(r):
    """Radar 1 begins messages of ever other client ids; only its own suffer."""
    r.cycle()
    message, _ = r.list()
    other, what = r.list(instance=r.two)
    for n, part in enumerate(segments(other)):
        for i in range(10):
            begun = bytearray(segments(message)[0])
            begun[8:10] = (100 * n + i + 1).to_bytes(2, "big")
            r.send(bytes(begun))
            r.fault(INCOMPLETE)
        r.send(part, r.two)
    r.delivered.append(what)
    r.statistics(lost=1)
    r.rest()
    r.cycle()


@scenario
def ego_between_segments(r):
    for n in range(3):
        message, what = r.list()
        parts = segments(message)
        r.send(parts[:3])
        r.send(r.one.ego(10 + n / 8, r.now_ns))
        r.egos.append(80 + n)
        r.send(parts[3:])
        r.delivered.append(what)
        r.rest()


@scenario
def new_session_before_the_old_is_whole(r):
    r.cycle()
    old, _ = r.list()
    r.send(segments(old)[:4])
    new, what = r.list()
    r.send(segments(new)[:3])
    r.send(segments(old)[4:])  # late: of no use any more
    r.send(segments(new)[3:])
    r.delivered.append(what)
    r.fault(INCOMPLETE)
    r.statistics(lost=1)
    r.rest()
    r.cycle()


@scenario
def damaged_session(r):
    """One segment belongs to a session to come: its message is lost, those that follow are not."""
    r.cycle()
    for ahead in (1, 3, 16, 17, 0x4000, 0x8000, 0xFFFF):
        def damage(message):
            parts = segments(message)
            session = int.from_bytes(parts[2][10:12], "big") + ahead & 0xFFFF
            parts[2] = parts[2][:10] + (session or 0x7777).to_bytes(2, "big") + parts[2][12:]
            return parts
        # Behind by one: late, and only the hole remains. Ahead: the old is dropped for the new, which then starves; if it
        # is far off, the rest begins it anew.
        incomplete = 1 if ahead == 0xFFFF else 2 if ahead <= 16 else 3
        r.bad_cycle(damage, *[INCOMPLETE] * incomplete, lost=1)
        r.cycle()
        r.cycle()


@scenario
def session_wraps(r):
    r.one.session = 0xFFFD
    for _ in range(5):
        r.cycle()
    r.one.session = 0xFFFF
    r.bad_cycle(lambda m: segments(m)[:-1], INCOMPLETE, lost=1)
    r.cycle()
    # Session 0 tells nothing apart: segments are refused; a whole message needs none.
    r.bad_cycle(segments, *[NO_SESSION] * 7, lost=1, session=0)
    r.cycle()
    r.good(r.two, 20)
    message, what = r.list(20, session=0)
    r.send(message)
    r.delivered.append(what)


@scenario
def several_in_a_datagram(r):
    for _ in range(2):
        packed = b""
        for n in range(3):
            message, what = r.list(7)
            packed += message
            r.delivered.append(what)
        packed += r.one.ego(10, r.now_ns)
        r.egos.append(80)
        r.send(packed)
        r.rest()

    def with_middle(change, *faults, lost=0, wrong=0, rest_is_lost=False, repeated=0):
        first, a = r.list(7)
        middle, b = r.list(7)
        last, c = r.list(7)
        r.send(first + change(middle) + last)
        r.delivered += [a] if rest_is_lost else [a, c]
        r.fault(*faults)
        r.statistics(lost, repeated, wrong)
        r.rest()
        r.good(count=7)
        r.rest()
    with_middle(lambda m: m[:12] + b"\2" + m[13:], PROTOCOL, lost=1)
    with_middle(lambda m: m[:13] + b"\2" + m[14:], HEADER, lost=1)
    with_middle(lambda m: m[:14] + b"\x42" + m[15:], TYPE, lost=1)
    with_middle(lambda m: m[:100] + b"\xAA" + m[101:], CRC, lost=1, wrong=1)
    with_middle(lambda m: b"\x12\x34" + m[2:], lost=1)  # another service's: none of our business
    with_middle(lambda m: m[:3] + b"\3" + m[4:], STRANGERS, lost=1)  # an event that the service does not have
    with_middle(lambda m: m[:4] + b"\0\0\0\7" + m[8:], TOO_SMALL, lost=2, rest_is_lost=True)
    with_middle(lambda m: m[:4] + b"\x7F\xFF\xFF\xFF" + m[8:], BEYOND, lost=2, rest_is_lost=True)
    with_middle(lambda m: m + b"\0" * 5, BEYOND, lost=1, rest_is_lost=True)
    r.delivered.insert(-1, (1, r.one.cycle - 2, 7, PLAIN))


# --- whole messages: headers -----------------------------------------------------------------------------------------
@scenario
def wrong_lengths(r):
    r.cycle(count=20)

    def length(change):
        return lambda m: [m[:4] + (len(m) - 8 + change).to_bytes(4, "big") + m[8:]]
    r.bad_cycle(length(-4), LENGTH, CUT, count=20, wrong=1)
    r.bad_cycle(length(4), BEYOND, count=20)
    r.bad_cycle(length(0x7FFFFF00), BEYOND, count=20)
    r.bad_cycle(lambda m: [m[:4] + b"\xFF\xFF\xFF\xFF" + m[8:]], BEYOND, count=20)
    r.bad_cycle(lambda m: [m[:4] + b"\0\0\0\0" + m[8:]], TOO_SMALL, count=20)
    r.bad_cycle(lambda m: [m[:4] + b"\0\0\0\x08" + m[8:16]], LENGTH, count=20, wrong=1)
    r.bad_cycle(lambda m: [m[:4] + b"\0\0\0\x12" + m[8:26]], LENGTH, count=20, wrong=1)
    r.bad_cycle(lambda m: [m[:15]], CUT, count=20)
    r.bad_cycle(lambda m: [b""], CUT, count=20)
    r.bad_cycle(lambda m: [m[:500]], BEYOND, count=20)
    r.cycle(count=20)
    r.statistics(lost=10)
    r.cycle(lambda m: [m + b"\0\0\0"], count=20)  # what follows a message does not undo it
    r.fault(CUT)


@scenario
def wrong_headers(r):
    r.cycle(count=20)
    for how in (dict(protocol=0), dict(protocol=2), dict(protocol=255)):
        r.bad_cycle(whole, PROTOCOL, count=20, **how)
    for how in (dict(interface=0), dict(interface=2), dict(kind=0x00), dict(kind=0x01), dict(kind=0x80), dict(kind=0x81),
                dict(code=1), dict(code=0x0A)):
        r.bad_cycle(whole, HEADER, count=20, **how)
    for how in (dict(kind=0x03), dict(kind=0x40), dict(kind=0x42), dict(kind=0xFF)):
        r.bad_cycle(whole, TYPE, count=20, **how)
    r.statistics(lost=15)
    r.cycle(count=20)
    # The same in segments: put together, then refused as one.
    r.bad_cycle(segments, HEADER, interface=2)
    r.bad_cycle(segments, HEADER, kind=0x00)
    r.bad_cycle(segments, HEADER, code=1)
    r.bad_cycle(segments, *[PROTOCOL] * 7, protocol=3)
    r.cycle()
    r.statistics(lost=4)


@scenario
def unknown_senders(r):
    r.cycle(count=20)
    stranger = Instance(1, STRANGER, 30601)
    message, _ = stranger.list(20, r.now_ns)
    r.send(message, stranger)
    r.fault(STRANGERS)
    # The right host, but another port; the other radar's port; an event that is not subscribed from there.
    r.send(message, Instance(1, SERVER, 30699))
    r.fault(STRANGERS)
    r.send(r.two.ego(10, r.now_ns), r.two)
    r.fault(STRANGERS)
    message, _ = r.list(20)
    r.send(message, r.two)
    r.fault(DATA_ID, radar=2)
    r.statistics(wrong=1, radar=2)
    r.statistics(lost=1)
    r.rest()
    r.cycle(count=20)


# --- end-to-end protection -------------------------------------------------------------------------------------------
@scenario
def wrong_protection(r):
    for count, cut in ((20, whole), (200, segments)):
        r.cycle(count=count)
        for crc_error in (1, 1 << 63, 0xFFFFFFFFFFFFFFFF):
            r.bad_cycle(cut, CRC, count=count, wrong=1, crc_error=crc_error)
        r.bad_cycle(cut, LENGTH, count=count, wrong=1, length_error=1)
        r.bad_cycle(cut, LENGTH, count=count, wrong=1, length_error=-8)
        r.bad_cycle(cut, DATA_ID, count=count, wrong=1, data_id=0x42530201)
        r.bad_cycle(cut, DATA_ID, count=count, wrong=1, data_id=0)
        r.bad_cycle(lambda m: cut(m[:16] + bytes(20) + m[36:]), LENGTH, count=count, wrong=1)
        r.bad_cycle(lambda m: cut(m[:-1] + bytes([m[-1] ^ 1])), CRC, count=count, wrong=1)
        r.statistics(lost=9)
        r.cycle(count=count)


@scenario
def counters(r):
    def jump(steps):
        r.one.counters[LISTS] = r.one.counters[LISTS] + steps - 1 & 0xFFFFFFFF
    r.cycle(count=20)
    before = r.one.counters[LISTS] - 1
    r.bad_cycle(whole, REPEATED, count=20, repeated=1, counter_sent=before)
    r.statistics(lost=1)
    r.cycle(count=20)
    jump(50)  # the largest step that is accepted
    r.statistics(lost=49)
    r.cycle(count=20)
    jump(51)
    r.bad_cycle(whole, SEQUENCE, count=20, wrong=1, lost=50)
    r.cycle(count=20)  # follows it: believed
    # One stray does not make the next good one wrong.
    here = r.one.counters[LISTS]
    r.bad_cycle(whole, SEQUENCE, count=20, wrong=1, lost=1_000_000 - 1, counter_sent=here - 1 + 1_000_000)
    r.cycle(count=20)
    r.statistics(lost=1)
    # Backwards is no loss.
    r.one.counters[LISTS] = 0xFFFFFFFE
    r.bad_cycle(whole, SEQUENCE, count=20, wrong=1)
    for _ in range(3):
        r.cycle(count=20)


# --- bodies ----------------------------------------------------------------------------------------------------------
@scenario
def wrong_bodies(r):
    r.cycle(count=20)
    for words, kind, body in (
            ("layout version", "wrong value", dict(layout=0)), ("layout version", "wrong value", dict(layout=2)),
            ("header bytes below 36", "wrong value", dict(header_bytes=32)),
            ("header bytes below 36", "wrong value", dict(header_bytes=38)),
            ("record bytes below 48", "wrong value", dict(record_bytes=44)),
            ("record bytes below 48", "wrong value", dict(record_bytes=50)),
            ("nanoseconds", "wrong value", dict(nanoseconds=10**9)),
            ("nanoseconds", "wrong value", dict(nanoseconds=0xFFFFFFFF)),
            ("body is not", "wrong length", dict(stated_count=19)), ("body is not", "wrong length", dict(stated_count=21)),
            ("over 1024", "wrong value", dict(stated_count=1025)), ("over 1024", "wrong value", dict(stated_count=0xFFFF)),
            ("body is not", "wrong length", dict(extra=b"\0")), ("body is not", "wrong length", dict(extra=-1)),
            ("shorter than its 36-byte header", "wrong length", dict(extra=-20 * 48 - 1)),
            ("shorter than its 36-byte header", "wrong length", dict(extra=-20 * 48 - 36))):
        r.bad_cycle(whole, (kind, words), count=20, body=body)
    r.bad_cycle(segments, ("wrong value", "over 1024"), count=1025)
    r.cycle(count=20)
    r.good(r.two)
    r.delivered.append(_grown(r))


def _grown(r):
    """A later minor version: longer header and records are skipped over."""
    message, what = r.list(30, body=dict(header_bytes=44, record_bytes=60))
    r.send(datagrams(message))
    return what


@scenario
def not_numbers(r):
    for count in (20, 200):
        message, what = r.list(count, variant=NOT_NUMBERS)
        r.send(datagrams(message))
        r.delivered.append(what)
        r.rest()
        message, what = r.list(count, variant=NO_INTERVAL)
        r.send(datagrams(message))
        r.delivered.append(what)
        r.rest()
        r.cycle()


@scenario
def wrong_ego(r):
    r.cycle(count=20)
    r.send(r.one.ego(10, r.now_ns))
    r.egos.append(80)
    for n, (kind, words, body) in enumerate((("wrong value", "layout version", dict(layout=2)),
                                            ("wrong length", "body bytes", dict(stated_bytes=36)),
                                            ("wrong length", "body bytes", dict(stated_bytes=28)))):
        r.wait(10)
        r.send(r.one.ego(10, r.now_ns, body=body))
        r.fault((kind, words), radar=0)
    for how, fault in ((dict(crc_error=1), CRC), (dict(data_id=1), DATA_ID), (dict(length_error=4), LENGTH),
                       (dict(kind=0x80), HEADER)):
        r.wait(10)
        r.send(r.one.ego(10, r.now_ns, **how))
        r.fault(fault, radar=0)
    r.wait(10)
    r.send(r.one.ego(NAN, r.now_ns))  # the speed is not stated then: no ego motion
    r.wait(10)
    r.send(r.one.ego(10.125, r.now_ns))
    r.egos.append(81)


# --- service discovery, as far as a recording shows it ---------------------------------------------------------------
@scenario
def wrong_offers(r):
    """Radar 1 is offered anew in every wrong way; the right offer holds."""
    r.cycle(count=20)
    right = [endpoint(SERVER, 30601)]
    for address, port, protocol, fault in (("0.0.0.0", 30601, 17, ENDPOINT), ("224.0.0.9", 30601, 17, ENDPOINT),
                                           ("255.255.255.255", 30601, 17, ENDPOINT), (SERVER, 0, 17, ENDPOINT),
                                           (SERVER, 30601, 6, NO_ENDPOINT), (SERVER, 30601, 0, NO_ENDPOINT)):
        r.sd([offer_entry(1)], [endpoint(address, port, protocol)])
        r.fault(fault, radar=0)
    r.sd([offer_entry(1, options=0)], right)
    r.fault(NO_ENDPOINT, radar=0)
    r.sd([offer_entry(1, options=2)], right + [endpoint(SERVER, 30609)])
    r.fault(("wrong value", "two different UDP endpoints"), radar=0)
    for entry, words in ((offer_entry(1, option=1), "first options"), (offer_entry(1, option=255), "first options"),
                         (offer_entry(1, options=2), "first options")):
        r.sd([entry], right)
        r.fault(("wrong value", words), radar=0)
    second = offer_entry(1)
    second.index_2, second.n_opt_2 = 1, 1
    r.sd([second], right)
    r.fault(("wrong value", "second options"), radar=0)
    for kind in (2, 3, 8, 0x77, 0xFF):
        r.sd([offer_entry(1, kind=kind)], right)
        r.fault(("unknown message", "unknown type of entry"), radar=0)
    for header in (dict(iface_ver=2), dict(retcode=1), dict(msg_type=0x00), dict(msg_type=0x22)):
        r.sd([offer_entry(1)], right, header=header)
        r.fault(("unknown message", "header is not that of a notification"), radar=0)
    r.sd([offer_entry(1)], right, header=dict(proto_ver=2))
    r.fault(PROTOCOL, radar=0)
    r.sd([offer_entry(1)], right, header=dict(msg_type=0x55))
    r.fault(TYPE, radar=0)
    for at, value, words in ((20, 17, "length of entries array"), (20, 32, "length of entries array"), (20, 0xFFFFFFF0, "length of entries array"),
                             (40, 11, "length of options array"), (40, 13, "length of options array"), (40, 0xFFFFFFFF, "length of options array"),
                             (20, 0, "length of options array")):
        r.sd([offer_entry(1)], right, raw=lambda m: m[:at] + value.to_bytes(4, "big") + m[at + 4:])
        r.fault(("wrong length", words), radar=0)
    for length in (0, 10, 0xFFFF):
        r.sd([offer_entry(1)], right, raw=lambda m: m[:44] + length.to_bytes(2, "big") + m[46:])
        r.fault(("wrong length", "length of an option is"), radar=0)
    r.sd([offer_entry(1)], right, raw=lambda m: m[:46] + b"\x99" + m[47:])
    r.fault(("unknown message", "unknown type"), radar=0)
    r.sd([offer_entry(1)], right, raw=lambda m: m[:46] + b"\x06" + m[47:])
    r.fault(("wrong value", "length of an option does not fit"), radar=0)
    r.sd([offer_entry(1)], right, raw=lambda m: m[:-1])
    r.fault(BEYOND, radar=0)
    r.sd([offer_entry(1)], right, raw=lambda m: m[:4] + (8 + 8).to_bytes(4, "big") + m[8:24])
    r.fault(("wrong length", "shorter than flags"), radar=0)
    r.sd([offer_entry(1)] * 65, right)
    r.fault(("over capacity", "more than 64 entries"), radar=0)
    r.sd([offer_entry(1)], right * 65)
    r.fault(("over capacity", "more than 64 options"), radar=0)
    r.rest()
    r.cycle(count=20)
    # Others' entries, and what a client is not asked, are no faults.
    r.sd([offer_entry(1, service=0x1234), offer_entry(9), offer_entry(1, kind=0), ack_entry(1, 7), ack_entry(9, 1)], right)
    r.cycle(count=20)
    # An offer from another host does not move what is served.
    r.packet(sd([offer_entry(1)], [endpoint(STRANGER, 30601)], session=1), (STRANGER, SD_PORT), (SD_GROUP, SD_PORT))
    r.cycle(count=20)


@scenario
def withdrawn_and_offered_again(r):
    r.cycle(count=20)
    r.sd([offer_entry(1, ttl=0), offer_entry(2, 1, ttl=0)], [endpoint(SERVER, 30601), endpoint(SERVER, 30602)])
    for radar in (1, 2):
        r.fault(("link", "withdrew its offer"), radar=radar)
    for instance in (r.one, r.two):
        message, _ = r.list(20, instance)
        r.send(message, instance)
        r.fault(STRANGERS)
    r.rest()
    r.one.restart(1500)  # it counts anew, at another port
    r.one.port = 30611
    r.offer()
    r.cycle(count=20)
    r.cycle(count=20)


@scenario
def expired(r):
    r.offer(ttl=1)
    for _ in range(19):
        r.cycle(count=20)
    r.wait(100)
    for radar in (1, 2):
        r.fault(("link", "offer expired"), radar=radar)
        message, _ = r.list(20, r.one if radar == 1 else r.two)
        r.send(message, r.one if radar == 1 else r.two)
        r.fault(STRANGERS)
    r.offer()
    r.rest()
    r.cycle(count=20)


@scenario
def started_again(r):
    """The server ends without a word and starts again: counters from the beginning, reboot flag, first event taken."""
    for _ in range(3):
        r.cycle(count=20)
    for restarts in range(3):
        r.one.restart(1200 + 100 * restarts)
        r.two.restart(2200 + 100 * restarts)
        r.sd_session = 0
        r.offer()
        for radar in (1, 2):
            r.fault(("link", "started again"), radar=radar)
        r.cycle(count=20)
        r.cycle()


@scenario
def moved_by_reboot_storm(r):
    """A hundred reboots and withdrawals within half a second; then all is as before."""
    r.cycle(count=20)
    r.at_least = True
    r.fault(("link", "started again"))
    for n in range(100):
        r.sd_session = 0
        r.offer(ttl=0 if n % 10 == 9 else 3)
        r.wait(5)
    r.sd_session = 0
    r.offer()
    r.one.restart(1500)
    r.two.restart(2500)
    r.rest()
    r.cycle(count=20)
    r.cycle()


# --- anything --------------------------------------------------------------------------------------------------------
@scenario
def random_damage(r):
    """Single bits of segments and of whole messages are turned over; what is delivered is right to the bit."""
    dice = random.Random(4253)
    r.at_least = True
    r.e2e = None
    r.next_offer_ns = r.now_ns
    for n in range(120):
        count = dice.choice((20, 60, 200))
        message, what = r.list(count)
        parts = datagrams(message)
        at = dice.randrange(len(parts))
        # Headers are few of the bytes, but most of what can go wrong.
        position = dice.randrange(20) if dice.random() < 0.7 else dice.randrange(len(parts[at]))
        damaged = bytearray(parts[at])
        damaged[position] ^= 1 << dice.randrange(8)
        parts[at] = bytes(damaged)
        r.send(parts)
        r.optional.append(what)
        r.rest()
        r.cycle(count=dice.choice((20, 200)))
    r.faults = {"any|0|": 100}


def toml(recordings):
    for name, r in recordings:
        flat = lambda rows: [number for row in rows for number in row]
        yield f'[[scenario]]\nname = "{name}"\ndelivered = {flat(r.delivered)}\noptional = {flat(r.optional)}\negos = {r.egos}\n'
        yield f"at_least = {str(r.at_least).lower()}\n"
        yield f"e2e = {[] if r.e2e is None else r.e2e[1] + r.e2e[2]}\n"
        faults = ", ".join(f'"{count}|{key}"' for key, count in r.faults.items())
        yield f"faults = [{faults}]\n\n"


def main(folder):
    recordings = []
    for name, body in SCENARIOS:
        r = Recording()
        r.offer()
        r.rest()
        body(r)
        recordings.append((name, r))
        wrpcap(str(folder / f"{name}.pcap"), r.packets, nano=True)
    (folder / "expected.toml").write_text("".join(toml(recordings)))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
