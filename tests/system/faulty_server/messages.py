"""Unsegmented messages: headers, end-to-end protection, bodies, random changes."""
import random

from recording import *


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
    r.cycle(lambda m: [m + b"\0\0\0"], count=20)  # bytes after a message do not invalidate it
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
    # The same in segments: reassembled, then rejected as one.
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
    r.cycle(count=20)  # follows the stray counter: accepted
    # One stray message does not make the next good one wrong.
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
            ("length is not", "wrong length", dict(stated_count=19)),
            ("length is not", "wrong length", dict(stated_count=21)),
            ("over 1024", "wrong value", dict(stated_count=1025)),
            ("over 1024", "wrong value", dict(stated_count=0xFFFF)),
            ("length is not", "wrong length", dict(extra=b"\0")), ("length is not", "wrong length", dict(extra=-1)),
            ("shorter than its 36-byte header", "wrong length", dict(extra=-20 * 48 - 1)),
            ("shorter than its 36-byte header", "wrong length", dict(extra=-20 * 48 - 36))):
        r.bad_cycle(whole, (kind, words), count=20, body=body)
    r.bad_cycle(segments, ("wrong value", "over 1024"), count=1025)
    r.cycle(count=20)
    r.good(r.two)
    r.delivered.append(_grown(r))


def _grown(r):
    """A later minor version: additional bytes of header and records are skipped."""
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




# --- anything --------------------------------------------------------------------------------------------------------
@scenario
def random_damage(r):
    """Flips single bits of segments and of unsegmented messages; delivered scans are bitwise right."""
    dice = random.Random(4253)
    r.at_least = True
    r.e2e = None
    r.next_offer_ns = r.now_ns
    for n in range(120):
        count = dice.choice((20, 60, 200))
        message, what = r.list(count)
        parts = datagrams(message)
        at = dice.randrange(len(parts))
        # Headers are a small share of the bytes, but cause most faults.
        position = dice.randrange(20) if dice.random() < 0.7 else dice.randrange(len(parts[at]))
        damaged = bytearray(parts[at])
        damaged[position] ^= 1 << dice.randrange(8)
        parts[at] = bytes(damaged)
        r.send(parts)
        r.optional.append(what)
        r.rest()
        r.cycle(count=dice.choice((20, 200)))
    r.faults = {"any|0|": 100}
