"""A server of the Boresight service on real sockets, correct unless a test makes it faulty."""
import socket
import struct
import time

from scapy.layers.inet import IP, UDP
from scapy.layers.l2 import Ether

from wire import *

SERVER, CLIENT, CLIENT_PORT = "10.66.85.1", "10.66.85.2", 30600
CLIENT_MAC, GROUP_MAC = "02:00:00:00:00:02", "01:00:5e:74:e0:f5"
LINK = "server0"
CYCLE_S = 0.05
OFFER_CYCLE_S = 1.0


class Wire:
    """Frames with any sender, without the kernel's UDP."""

    def __init__(self):
        self.raw = socket.socket(socket.AF_PACKET, socket.SOCK_RAW)
        self.raw.bind((LINK, 0))

    @staticmethod
    def frame(payload, source, destination):
        mac = GROUP_MAC if destination[0] == SD_GROUP else CLIENT_MAC
        return bytes(Ether(src="02:00:00:00:00:01", dst=mac) / IP(src=source[0], dst=destination[0]) /
                     UDP(sport=source[1], dport=destination[1], chksum=0) / Raw(payload))

    def send(self, payload, source, destination=(SD_GROUP, SD_PORT)):
        self.raw.send(self.frame(payload, source, destination))


class Server:
    def __init__(self, story, cycle):
        """Restarts all counters; its cycles begin after `cycle`."""
        self.story = story
        self.one, self.two = Instance(1, SERVER, 30601), Instance(2, SERVER, 30602)
        for instance in (self.one, self.two):
            instance.restart(cycle)
        self.sd_socket = self.bound(SERVER, SD_PORT)
        self.finds = self.bound(SD_GROUP, SD_PORT)
        index = socket.if_nametoindex(LINK)
        self.finds.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                              struct.pack("4s4si", socket.inet_aton(SD_GROUP), b"", index))
        self.sockets = {i.number: self.bound(SERVER, i.port) for i in (self.one, self.two)}
        self.sessions = {"multicast": 0, "unicast": 0}
        self.subscribers = {}  # (instance, eventgroup) → (address, port)
        self.since = {}        # … → time of its first subscription
        self.refuses, self.group = False, None
        self.born = self.next_cycle = time.monotonic()
        self.next_offer, self.offers = self.born, 0

    def bound(self, address, port):
        made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF,
                        struct.pack("4s4si", b"", b"", socket.if_nametoindex(LINK)))
        made.setblocking(False)
        made.bind((address, port))
        return made

    def close(self):
        """Ends without StopOffer, as at a loss of power."""
        for made in (self.sd_socket, self.finds, *self.sockets.values()):
            made.close()

    # --- discovery ---------------------------------------------------------------------------------------------------
    def send_sd(self, entries, options=(), *, to=None, raw=None, **how):
        way = "unicast" if to else "multicast"
        self.sessions[way] += 1
        message = sd(entries, options, **({"session": self.sessions[way]} | how))
        self.sd_socket.sendto(raw(message) if raw else message, to or (SD_GROUP, SD_PORT))

    def offer(self, ttl=3):
        self.send_sd([offer_entry(1, 0, ttl=ttl), offer_entry(2, 1, ttl=ttl)],
                     [endpoint(SERVER, self.one.port), endpoint(SERVER, self.two.port)])
        if ttl == 0:
            self.forget_subscribers()

    def forget_subscribers(self):
        self.subscribers.clear()
        self.since.clear()

    def answer(self, entry, options, sender):
        key, place = (entry.inst_id, entry.eventgroup_id), options[entry.index_1]
        if entry.ttl == 0:
            self.subscribers.pop(key, None)
            self.since.pop(key, None)
            return
        served = key in ((1, LISTS), (1, EGO), (2, LISTS)) and not self.refuses
        if served:
            self.since.setdefault(key, time.monotonic())
            self.subscribers[key] = (place.addr, place.port)
        options = [group(*self.group)] if served and self.group else []
        ttl = entry.ttl if served else 0
        self.send_sd([ack_entry(*key, ttl=ttl, counter=entry.cnt, options=len(options))], options, to=sender)

    def poll(self):
        for made in (self.sd_socket, self.finds):
            while True:
                try:
                    datagram, sender = made.recvfrom(65536)
                except BlockingIOError:
                    break
                if sender[0] != CLIENT:
                    continue  # own multicast, and that of fictitious servers
                message = SD(datagram[16:])
                for entry in message.entry_array:
                    if entry.type == 6:
                        self.answer(entry, message.option_array, sender)

    # --- events ------------------------------------------------------------------------------------------------------
    def send(self, instance, payloads, to=None):
        to = to or self.group or self.subscribers.get((instance.number, LISTS))
        for payload in payloads:
            self.sockets[instance.number].sendto(payload, to)

    def list(self, instance, count=None, **changes):
        count = count or (200 if instance.number == 1 else 20)
        return instance.list(count, time.time_ns() - 10_000_000, **changes)

    def emit(self, instance, how=datagrams, delivered=True, **changes):
        """One list to all subscribers; `how(message)` gives its datagrams."""
        key = instance.number, LISTS
        if key not in self.subscribers:
            return
        if self.group and time.monotonic() - self.since[key] < 0.2:
            return  # no client joins the group before the Ack
        message, what = self.list(instance, **changes)
        self.send(instance, how(message))
        if delivered:
            self.story.sent(what)

    # --- time --------------------------------------------------------------------------------------------------------
    def run(self, seconds, each_cycle=None):
        """Offers, answers and sends for this time; `each_cycle(n)` replaces the sending of radar 1's lists."""
        end, n = time.monotonic() + seconds, 0
        self.next_cycle = max(self.next_cycle, time.monotonic())
        while (now := time.monotonic()) < end:
            if now >= self.next_offer:
                self.offer()
                self.offers += 1
                pauses = {1: 0.2, 2: 0.4, 3: 0.8}
                self.next_offer = now + pauses.get(self.offers, OFFER_CYCLE_S)
            self.poll()
            if now >= self.next_cycle:
                self.next_cycle += CYCLE_S
                self.emit(self.two)
                if each_cycle:
                    each_cycle(n)
                    n += 1
                else:
                    self.emit(self.one)
            time.sleep(0.002)
