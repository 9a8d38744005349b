"""Service discovery in recordings."""
from recording import *


@scenario
def wrong_offers(r):
    """Radar 1 is offered again with all kinds of faults; the right offer remains valid."""
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
    for at, value, array in ((20, 17, "entries"), (20, 32, "entries"), (20, 0xFFFFFFF0, "entries"), (40, 11, "options"),
                             (40, 13, "options"), (40, 0xFFFFFFFF, "options"), (20, 0, "options")):
        r.sd([offer_entry(1)], right, raw=lambda m: m[:at] + value.to_bytes(4, "big") + m[at + 4:])
        r.fault(("wrong length", "length of entries array" if array == "entries" else "options array does not end"), radar=0)
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
    # Entries of others, and entries that are not for clients, are no faults.
    r.sd([offer_entry(1, service=0x1234), offer_entry(9), offer_entry(1, kind=0), ack_entry(1, 7), ack_entry(9, 1)], right)
    r.cycle(count=20)
    # An offer from another host does not change the served endpoint.
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
    r.one.restart(1500)  # its counters restart, at another port
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
    """The server ends without StopOffer and restarts: counters from the start, reboot flag, first event accepted."""
    for _ in range(3):
        r.cycle(count=20)
    for restarts in range(3):
        r.one.restart(1200 + 100 * restarts)
        r.two.restart(2200 + 100 * restarts)
        r.sd_session = 0
        r.offer()
        for radar in (1, 2):
            r.fault(("link", "server restarted"), radar=radar)
        r.cycle(count=20)
        r.cycle()


@scenario
def moved_by_reboot_storm(r):
    """A hundred reboots and withdrawals within half a second; then normal operation."""
    r.cycle(count=20)
    r.at_least = True
    r.fault(("link", "server restarted"))
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
