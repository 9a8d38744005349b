#!/usr/bin/env python3
"""story.py REPLAY SOURCE_DIR RECORDINGS NETWORK: plays the part of clients to `boresight-replay --via someip`, which runs
in the network namespace of process NETWORK, and says what is not as interfaces/wire/boresight_service.md has it; exit
code 1 then. Here is the interface client0 with 10.66.83.2 and fd66::2, there server0 with 10.66.83.1 and fd66::1."""
import os
import signal
import subprocess
import sys
import time

from client import Client, decode, decode_list, need

REPLAY, SOURCE, DATA, NETWORK = sys.argv[1:5]
THERE = ["nsenter", f"--net=/proc/{NETWORK}/ns/net"]
SERVER, CLIENT, SD_GROUP = "10.66.83.1", "10.66.83.2", "224.244.224.245"


class Server:
    def __init__(self, address, *arguments):
        command = [REPLAY, "--via", "someip", "--interface", "server0", "--address", address, *arguments]
        self.process = subprocess.Popen(THERE + command, stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        output, _ = self.process.communicate(timeout=5)
        need(self.process.returncode == 0, f"exit code {self.process.returncode}")
        return output


def per_stream(received, instance_of_port):
    """Messages by (instance, event), after the common checks."""
    streams, sessions = {}, {}
    for when, port, message in received:
        instance = instance_of_port[port]
        event, session, counter, body = decode(message, instance)
        streams.setdefault((instance, event), []).append((when, counter, body))
        sessions.setdefault(instance, []).append(session)
    for stream in streams.values():
        counters = [counter for _, counter, _ in stream]
        need(counters == list(range(counters[0], counters[0] + len(counters))), f"E2E counters {counters}")
    for session in sessions.values():
        need(session == list(range(session[0], session[0] + len(session))), f"sessions {session}")
    return streams


def rate(stream):
    return (len(stream) - 1) / (stream[-1][0] - stream[0][0])


def unicast():
    """Two radars with long lists, each event to its subscriber, until the subscriptions end."""
    client = Client(CLIENT, "client0", SD_GROUP)
    with Server(SERVER, "--synthetic", "300", "--radars", "2", "--rate", "20") as server:
        client.wait(lambda: len(client.offers) >= 4, 2, "offers")
        client.offers.sort(key=lambda offer: (offer[5], offer[0]))
        need([offer[:6] for offer in client.offers[:4]] ==
             [(i, 3, (4, SERVER, 30600 + i), True, 0xC0, s) for s in (1, 2) for i in (1, 2)], f"{client.offers}")
        client.offers.clear()
        client.find(2)
        client.wait(lambda: any(not o[3] for o in client.offers), 0.5, "answer to FindService")
        need([o[:3] for o in client.offers if not o[3]] == [(2, 3, (4, SERVER, 30602))], f"{client.offers}")

        need(client.answer(SERVER, 1, 1, 2) == (2, None), "Ack, without a group")
        need(client.answer(SERVER, 1, 2, 2) == (2, None), "Ack of ego motion")
        need(client.answer(SERVER, 2, 1, 0xFFFFFF) == (0xFFFFFF, None), "Ack, for ever")
        need(client.answer(SERVER, 2, 3, 3) == (0, None), "Nack of an unknown eventgroup")
        need(client.answer(SERVER, 2, 1, 3, major=2) == (0, None), "Nack of another major version")
        need(client.answer(SERVER, 5, 1, 3) == (0, None), "Nack of an unknown instance")
        begin = time.time()
        received, shared = client.receive(1.5)
        need(set(shared) == {1}, "no datagram is shared unless asked for")
        streams = per_stream(received, {30601: 1, 30602: 2})
        need(set(streams) == {(1, 0x8001), (1, 0x8002), (2, 0x8001)}, f"streams {set(streams)}")
        for instance in (1, 2):
            stream = streams[instance, 0x8001]
            need(18 < rate(stream) < 22, f"rate {rate(stream)}")
            lists = [decode_list(body) for _, _, body in stream]
            cycles = [one[2] for one in lists]
            need(cycles == list(range(cycles[0], cycles[0] + len(cycles))), f"cycles {cycles}")
            for stamp, sync, _, fields, records in lists:
                need(len(records) == 300 and fields == 0x3F and sync == 1, "content of a list")
                need(begin - 1 < stamp < time.time(), "time of measurement")
                need(all(2 <= r[0] <= 150 and abs(r[1]) <= 1 and r[11] == 0 for r in records), "records")
        need(45 < rate(streams[1, 0x8002]) < 55, "rate of ego motion")

        received, _ = client.receive(1.2)
        last = max(when for when, port, _ in received if port == 30601)
        need(time.monotonic() - last > 0.4, "instance 1 ends with its subscription's time")
        client.subscribe(SERVER, 2, 1, 0)
        client.receive(0.15)
        need(client.receive(0.5)[0] == [], "silence after StopSubscribe")
        client.offers.clear()
        output = server.stop()
        client.wait(lambda: len(client.offers) >= 2, 1, "StopOffer")
        need([o[:2] for o in client.offers] == [(1, 0), (2, 0)] and client.offers[0][3], f"{client.offers}")
        need("0 datagrams rejected" in output and "4 subscriptions acknowledged" not in output, output)
        need("3 subscriptions acknowledged, 3 refused, 2 expired" in output, output)


def multicast():
    """The Ack names a group for all events; short events share datagrams; the longest list is possible."""
    client = Client(CLIENT, "client0", SD_GROUP)
    events = client.joined("239.66.83.1", 30650)
    with Server(SERVER, "--synthetic", "1024", "--group", "239.66.83.1:30650", "--share-datagrams", "60") as server:
        client.wait(lambda: client.offers, 1, "offer")
        need(client.answer(SERVER, 1, 1, 9) == (9, (0x14, "239.66.83.1", 30650)), "Ack with the group")
        need(client.answer(SERVER, 1, 2, 9) == (9, (0x14, "239.66.83.1", 30650)), "Ack with the group")
        received, shared = client.receive(1.0, events)
        streams = per_stream(received, {30601: 1})
        need(all(len(body) == 36 + 48 * 1024 for _, _, body in streams[1, 0x8001]), "1024 detections")
        need(max(shared) > 1, "ego motions share datagrams")
        need(18 < rate(streams[1, 0x8001]) < 22 and len(streams[1, 0x8002]) > 30, "both events come")
        need(client.receive(0.1)[0] == [], "nothing goes to the subscriber's endpoint")
        # A restarted server offers with session 1 and the reboot flag again.
        server.process.kill()
        server.process.wait()
    client.offers.clear()
    with Server(SERVER, "--synthetic", "1") as server:
        client.wait(lambda: client.offers, 1, "offer after a restart")
        need(client.offers[0][4:6] == (0xC0, 1), "reboot flag and session 1")
        server.stop()


def ipv6():
    client = Client("fd66::2", "client0", "ff14::4:c0")
    with Server("fd66::1", "--synthetic", "40", "--group", "[ff14::42]:30650") as server:
        events = client.joined("ff14::42", 30650)
        client.wait(lambda: client.offers, 1, "offer")
        need(client.offers[0][2] == (6, "fd66::1", 30601), f"{client.offers}")
        need(client.answer("fd66::1", 1, 1, 3) == (3, (0x16, "ff14::42", 30650)), "Ack with the group")
        streams = per_stream(client.receive(0.5, events)[0], {30601: 1})
        need(len(streams[1, 0x8001]) > 6, "lists by IPv6")
        server.stop()


def link():
    """Events are lost while the link is down; the server continues."""
    client = Client(CLIENT, "client0", SD_GROUP)
    with Server(SERVER, "--synthetic", "100") as server:
        client.wait(lambda: client.offers, 1, "offer")
        client.answer(SERVER, 1, 1, 9)
        need(len(client.receive(0.3)[0]) > 3, "events before")
        subprocess.run([*THERE, "ip", "link", "set", "server0", "down"], check=True)
        need(len(client.receive(1.2)[0]) < 3, "no events by a link that is down")
        client.offers.clear()
        subprocess.run([*THERE, "ip", "link", "set", "server0", "up"], check=True)
        client.wait(lambda: client.offers, 1.2, "offer within one cycle after the link came up")
        need(len(client.receive(0.5)[0]) > 7, "events after")
        server.stop()


def recording():
    """The recorded drive of a Toyota radar with the vehicle's CAN signals."""
    drive = f"{DATA}/comma2k19_seg40/radar_ego.candump.log"
    if not os.path.exists(drive):
        print("skipped: no shared data")
        return
    client = Client(CLIENT, "client0", SD_GROUP)
    with Server(SERVER, "--config", f"{SOURCE}/config", "--vehicle", "comma2k19", "--duration", "3", drive) as server:
        client.wait(lambda: client.offers, 5, "offer")
        instance, endpoint = client.offers[0][0], client.offers[0][2]
        client.answer(SERVER, instance, 2, 9)
        client.answer(SERVER, instance, 1, 9)
        received, _ = client.receive(3.2)
        streams = per_stream(received, {endpoint[2]: instance})
        lists = [decode_list(body) for _, _, body in streams[instance, 0x8001]]
        need(16 < rate(streams[instance, 0x8001]) < 24 and len(streams[instance, 0x8002]) > 100, "rates of the drive")
        need(max(len(one[4]) for one in lists) > 5, "detections")
        need(all(abs(when - one[0] - (time.monotonic() - time.time())) < 0.5
                 for (when, _, _), one in zip(streams[instance, 0x8001], lists)), "stamps are those of now")
        output, _ = server.process.communicate(timeout=5)
        need(server.process.returncode == 0 and "replayed 3.0 s, 0 malformed" in output, output)


def wrong_command_lines():
    for arguments, problem in ((["--synthetic", "5"], "--interface is missing"),
                               (["--interface", "server0", "--address", "x", "--synthetic", "5"], "is not an IP address"),
                               (["--interface", "server0", "--address", SERVER], "no recording"),
                               (["--interface", "nope", "--address", SERVER, "--synthetic", "5"], "no interface"),
                               (["--interface", "server0", "--address", "192.0.2.1", "--synthetic", "5"], "cannot bind"),
                               (["--interface", "server0", "--address", SERVER, "--synthetic", "5", "--group", "1.2.3.4:5"],
                                "is not a multicast group")):
        done = subprocess.run([*THERE, REPLAY, "--via", "someip", *arguments], capture_output=True, text=True, timeout=10)
        need(done.returncode in (2, 3) and problem in done.stderr, f"{arguments}: {done.returncode} {done.stderr}")


failed = 0
for part in (unicast, multicast, ipv6, link, recording, wrong_command_lines):
    try:
        part()
        print(f"ok      {part.__name__}")
    except (AssertionError, subprocess.TimeoutExpired, OSError) as problem:
        failed = 1
        print(f"FAILED  {part.__name__}: {problem!r}")
sys.exit(failed)
