"""stranger_bytes.py FIRST_PORT SEED: until it is killed, sends datagrams to the ports of DDS on this machine: random
bytes, and random bytes behind a header of RTPS."""
import random
import socket
import sys
import time

PORTS = 24  # of twelve participants
RTPS_HEADER = b"RTPS\x02\x03\x01\x0f"

first_port, rng = int(sys.argv[1]), random.Random(int(sys.argv[2]))
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
while True:
    for port in range(first_port, first_port + PORTS):
        data = rng.randbytes(rng.choice((1, 20, 64, 300, 1400, 9000)))
        if rng.random() < 0.7:
            data = RTPS_HEADER + data
        for address in ("127.0.0.1", "239.255.0.1"):
            try:
                out.sendto(data, (address, port))
            except OSError:
                pass  # nobody listens
    time.sleep(0.005)
