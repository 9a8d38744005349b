"""story.py RESULT: a faulty server in its network namespace, against a gateway in another; RESULT (TOML) states for each
stage what the gateway must have delivered and counted. Exit code 77: no scapy."""
import os
import random
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
try:
    import scapy.contrib.automotive.someip
except ImportError as problem:
    print(f"skipped: python3-scapy is not installed ({problem})")
    sys.exit(77)

from server import *

LENGTH, VALUE, UNKNOWN, CAPACITY = "wrong length", "wrong value", "unknown message", "over capacity"


class Story:
    def __init__(self):
        self.stages = []

    def begin(self, name, *, fresh=False, exact=True):
        """`fresh`: no client is subscribed when the stage begins, and the good server begins to offer with it."""
        self.stages.append({"name": name, "begin_ns": time.monotonic_ns(), "fresh": fresh, "exact": exact, "sent": [],
                            "faults": {}})
        print(f"{name} …", flush=True)

    def end(self):
        self.stages[-1]["end_ns"] = time.monotonic_ns()

    def sent(self, what):
        self.stages[-1]["sent"] += what

    def fault(self, *kinds):
        faults = self.stages[-1]["faults"]
        for kind in kinds:
            faults[kind] = faults.get(kind, 0) + 1

    def toml(self):
        for s in self.stages:
            faults = ", ".join(f'"{count}|{kind}"' for kind, count in s["faults"].items())
            yield (f'[[stage]]\nname = "{s["name"]}"\nbegin_ns = {s["begin_ns"]}\nend_ns = {s["end_ns"]}\n'
                   f'fresh = {str(s["fresh"]).lower()}\nexact = {str(s["exact"]).lower()}\nsent = {s["sent"]}\n'
                   f"faults = [{faults}]\n\n")


def settle(server):
    """A good server, until the gateway's heartbeat has reported all earlier faults."""
    server.run(0.5)


def wrong_messages(story, server):
    story.begin("wrong messages")
    one = server.one
    mix = random.Random(30601)

    def shuffled(message):
        return mix.sample(parts := segments(message), len(parts))

    def without(at):
        return lambda message: [part for i, part in enumerate(segments(message)) if i != at]

    def too_far(message):
        return segments(message)[:2] + [segment(message, 131072, bytes(64), True)] + segments(message)[2:]

    delivered = [shuffled, lambda m: segments(m)[::-1], lambda m: segments(m) * 2, lambda m: segments(m, 1392, 704),
                 lambda m: [segments(m)[0][:-8], segments(m)[0]] + segments(m)[1:]]
    refused = [((LENGTH,), without(0), {}), ((LENGTH,), without(3), {}), ((LENGTH,), without(6), {}),
               ((LENGTH, LENGTH), too_far, {}), ((VALUE,), datagrams, dict(crc_error=1)),
               ((VALUE,), datagrams, dict(data_id=7)), ((VALUE,), datagrams, dict(length_error=16)),
               ((VALUE,), datagrams, dict(counter_sent=0x70000000)), ((VALUE,), datagrams, dict(interface=2)),
               ((VALUE,) * 7, datagrams, dict(protocol=2)), ((VALUE,), datagrams, dict(body=dict(layout=2))),
               ((VALUE,), datagrams, dict(count=1025)), ((VALUE,), lambda m: [m], dict(count=20, kind=0x42)),
               ((LENGTH,), lambda m: [m[:600]], dict(count=20)), ((LENGTH,), lambda m: [m[:9]], dict(count=20))]
    steps = [step for pair in zip(delivered * 3, refused) for step in pair]

    def each(n):
        step = steps[n]
        if callable(step):
            server.emit(one, step)
            if step is delivered[-1]:
                story.fault(LENGTH)
            return
        faults, how, changes = step
        server.emit(one, how, delivered=False, **changes)
        story.fault(*faults)
    server.run(len(steps) * CYCLE_S - CYCLE_S / 2, each)
    settle(server)
    story.end()


def wrong_discovery(story, server, wire):
    """Faults beside a running server, which is not disturbed."""
    story.begin("wrong discovery")
    right = [endpoint(SERVER, 30601)]

    def ends(n, value):
        return lambda m: m[:n] + value.to_bytes(4, "big") + m[n + 4:]
    second = offer_entry(1)
    second.index_2, second.n_opt_2 = 9, 1
    cases = [(VALUE, [offer_entry(1)], [endpoint(*where)], {}) for where in
             (("0.0.0.0", 30601), ("224.0.0.9", 30601), ("255.255.255.255", 30601), (SERVER, 0), (SERVER, 30601, 6))]
    cases += [(VALUE, [entry], right, {}) for entry in
              (offer_entry(1, option=1), offer_entry(1, option=200), offer_entry(1, options=15), second)]
    cases += [(UNKNOWN, [offer_entry(1, kind=kind)], right, {}) for kind in (2, 9, 0x80, 0xFF)]
    cases += [(UNKNOWN, [offer_entry(1)], right, dict(header=header)) for header in
              (dict(iface_ver=9), dict(retcode=5), dict(msg_type=0x81))]
    cases += [(VALUE, [offer_entry(1)], right, dict(header=dict(proto_ver=7)))]
    cases += [(LENGTH, [offer_entry(1)], right, dict(raw=raw)) for raw in
              (ends(20, 8), ends(20, 0xFFFFFFF0), ends(40, 0xFFFF), ends(40, 0), ends(4, 0xFFFF), ends(4, 3),
               lambda m: m[:30], lambda m: m[:12])]
    cases += [(CAPACITY, [offer_entry(1)] * 80, right, {})]
    # Other servers that offer, withdraw, acknowledge or refuse this server's entries, or unknown ones: no faults.
    others = [[offer_entry(1)], [offer_entry(1, ttl=0)], [offer_entry(2, ttl=0)], [ack_entry(1, LISTS, ttl=0)],
              [ack_entry(2, LISTS, ttl=0)], [ack_entry(1, LISTS, counter=3)], [ack_entry(7, LISTS)], [offer_entry(7)]]

    def each(n):
        server.emit(server.one)
        if n < len(cases):
            kind, entries, options, how = cases[n]
            server.send_sd(entries, options, to=(CLIENT, SD_PORT) if n % 2 else None, **how)
            story.fault(kind)
        wire.send(sd(others[n % len(others)], [endpoint("10.66.86.7", 30601)], session=n + 1), ("10.66.86.7", SD_PORT))
        # Acks of the server itself for subscriptions of others.
        server.send_sd([ack_entry(1, LISTS, counter=7), ack_entry(9, 9)], to=(CLIENT, SD_PORT))
    server.run((len(cases) + 2) * CYCLE_S - CYCLE_S / 2, each)
    settle(server)
    story.end()


def refusals(story, server):
    """It withdraws itself, then refuses every subscription; the next one to start serves."""
    story.begin("refusals")
    server.refuses = True
    server.offer(ttl=0)
    server.run(2.0)
    server.close()
    time.sleep(0.3)
    story.end()


def group_of_its_own(story, server):
    """Events by multicast; discovery reaches the gateway by that very group, and says that it is over."""
    story.begin("multicast events", fresh=True)
    server.group = ("239.66.83.1", 30650)
    server.run(1.2)
    server.send_sd([offer_entry(1, ttl=0, options=0), offer_entry(2, ttl=0, options=0)], to=server.group)
    server.forget_subscribers()
    server.run(1.4)
    # Another group with each Ack, as fast as the gateway subscribes, and also without a Subscribe.
    for n in range(300):
        address = f"239.66.83.{n % 200 + 2}"
        for key in ((1, LISTS), (2, LISTS)):
            server.send_sd([ack_entry(*key, options=1)], [group(address, 30650)],
                           to=(CLIENT, SD_PORT) if n % 3 else server.group)
        time.sleep(0.001)
    server.close()
    time.sleep(0.3)
    story.end()


def reboot_storm(story, server):
    story.begin("reboot storm")
    for n in range(1000):
        server.sessions = {"multicast": 0, "unicast": 0}
        server.offer(ttl=0 if n % 5 == 4 else 0xFFFFFF)
        time.sleep(0.001)
        if n % 50 == 0:
            server.poll()
    server.close()
    time.sleep(0.3)
    story.end()


def storm(seconds, rate, seed):
    """Offers of the gateway's instances from 200 fictitious senders, one in 20 malformed, by a separate process. The
    returned function waits for its end and returns the number of malformed ones."""
    result, report = os.pipe()
    child = os.fork()
    if child:
        os.close(report)

        def end():
            os.waitpid(child, 0)
            return int(os.read(result, 100))
        return end
    wire, dice = Wire(), random.Random(seed)
    frames = []
    for sender in range(200):
        address = f"10.66.86.{sender + 1}"
        message = sd([offer_entry(1, ttl=dice.choice((3, 0xFFFFFF))), offer_entry(2, ttl=3)],
                     [endpoint(address, 30601)], session=1)
        if sender % 20 == 7:
            message = message[:20] + b"\0\0\0\7" + message[24:]
        frames.append(wire.frame(message, (address, SD_PORT), (SD_GROUP, SD_PORT)))
    begin, sent = time.monotonic(), 0
    while (passed := time.monotonic() - begin) < seconds:
        due = int(passed * rate)
        for n in range(sent, min(due, sent + 500)):
            wire.raw.send(frames[n % 200])
        sent = max(sent, min(due, sent + 500))
        time.sleep(0.0005)
    print(f"{sent} offers in {seconds} s", flush=True)
    os.write(report, str(sum(n % 200 % 20 == 7 for n in range(sent))).encode())
    os._exit(0)


def main(result):
    for _ in range(500):
        if LINK in (name for _, name in socket.if_nameindex()):
            break
        time.sleep(0.01)
    for command in ("link set lo up", f"address add {SERVER}/16 dev {LINK}", f"link set {LINK} up"):
        subprocess.run(["ip", *command.split()], check=True)
    time.sleep(0.5)
    story, wire = Story(), Wire()

    story.begin("served", fresh=True)
    server = Server(story, 10_000)
    server.run(1.5)
    story.end()
    wrong_messages(story, server)
    wrong_discovery(story, server, wire)

    story.begin("storm beside a server", exact=False)
    end_of_storm = storm(2.0, 10_000, 1)
    server.run(2.2)
    story.fault(*[LENGTH] * end_of_storm())
    settle(server)
    story.end()

    refusals(story, server)
    group_of_its_own(story, Server(story, 20_000))
    story.begin("after the groups", fresh=True)
    server = Server(story, 30_000)
    server.run(1.5)
    story.end()
    reboot_storm(story, server)

    story.begin("storm without a server", exact=False)
    story.fault(*[LENGTH] * storm(2.0, 10_000, 2)())
    time.sleep(0.25)  # until the next heartbeat
    story.end()
    story.begin("after the storm", fresh=True)
    server = Server(story, 40_000)
    server.run(2.0)
    story.end()
    Path(result).write_text("".join(story.toml()))


if __name__ == "__main__":
    main(sys.argv[1])
