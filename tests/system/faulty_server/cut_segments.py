"""Segments: lost, repeated, truncated, in any order, of any length, of several messages at once."""
import random

from recording import *


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
    # So late that the segments are reassembled again: the E2E counter detects the repetition.
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
    # The first of conflicting bytes are kept: here the right ones …
    r.cycle(lambda m: segments(m)[:2] + [segment(m, 1392, b"\xAA" * 1392 + m[16 + 2784:16 + 4176], True)] +
            segments(m)[3:])
    # … and here the wrong ones, which the E2E CRC finds.
    r.bad_cycle(lambda m: [segment(m, 1392, b"\xAA" * 1392, True)] + segments(m), CRC, wrong=1)
    r.cycle()
    r.statistics(lost=1)


@scenario
def scapy_cuts(r):
    """scapy's own fragment(), which ends a payload that is a multiple of the size by an empty segment."""
    def as_tp(message):
        return SOMEIP(message[:14] + b"\x22" + message[15:16] + bytes(4) + message[16:])
    for size in (1392, 16, 928):
        r.cycle(lambda m: [bytes(part) for part in as_tp(m).fragment(size)], count=60)


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
    # Only one segment exists; the last message is incomplete as well.
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
    # The right segment after the wrong one completes the message.
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
    # A message without an end: up to the limit, and beyond.
    r.bad_cycle(lambda m: [segment(m, offset, b"\xAA" * 1392, True) for offset in range(0, 140_000, 1392)], OVERSIZE,
                INCOMPLETE, lost=1)
    r.cycle()
    # From the first segment on: no segment is kept, and the following ones are only incomplete.
    r.bad_cycle(lambda m: [segment(m, 200_000, b"\xAA" * 64, False)] + segments(m)[:2], OVERSIZE, INCOMPLETE, lost=1)
    r.cycle()


@scenario
def contradictory_ends(r):
    r.cycle()
    r.cycle(lambda m: segments(m)[:4] + [segment(m, 2784, b"\xAA" * 16, False)] + segments(m)[4:])
    r.fault(CONTRADICTION)
    r.cycle(lambda m: segments(m)[6:] + [segment(m, 9664, b"\xAA" * 160, True)] + segments(m)[:6])
    r.fault(CONTRADICTION)
    # An end that arrives first is accepted, and its message lost.
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
    """Forty unknown senders begin a message between any two segments of the server."""
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
    """Radar 1 begins messages with changing client ids; only its own messages are affected."""
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
    r.send(segments(old)[4:])  # too late to be used
    r.send(segments(new)[3:])
    r.delivered.append(what)
    r.fault(INCOMPLETE)
    r.statistics(lost=1)
    r.rest()
    r.cycle()


@scenario
def damaged_session(r):
    """One segment belongs to a later session: its message is lost, the following ones are not."""
    r.cycle()
    for ahead in (1, 3, 16, 17, 0x4000, 0x8000, 0xFFFF):
        def damage(message):
            parts = segments(message)
            session = int.from_bytes(parts[2][10:12], "big") + ahead & 0xFFFF
            parts[2] = parts[2][:10] + (session or 0x7777).to_bytes(2, "big") + parts[2][12:]
            return parts
        # Behind by one: late, and only the gap remains. Ahead: the old message is dropped for the new one, which remains
        # incomplete; if it is far ahead, the rest starts the old one again.
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
    # Session 0 distinguishes no messages: segments are rejected; an unsegmented message needs none.
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
    with_middle(lambda m: b"\x12\x34" + m[2:], lost=1)  # another service: ignored
    with_middle(lambda m: m[:3] + b"\3" + m[4:], STRANGERS, lost=1)  # an event that the service does not have
    with_middle(lambda m: m[:4] + b"\0\0\0\7" + m[8:], TOO_SMALL, lost=2, rest_is_lost=True)
    with_middle(lambda m: m[:4] + b"\x7F\xFF\xFF\xFF" + m[8:], BEYOND, lost=2, rest_is_lost=True)
    with_middle(lambda m: m + b"\0" * 5, BEYOND, lost=1, rest_is_lost=True)
    r.delivered.insert(-1, (1, r.one.cycle - 2, 7, PLAIN))
