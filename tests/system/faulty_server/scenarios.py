"""scenarios.py FOLDER: recordings of a faulty server, one file a scenario, and expected.toml: what becomes of each.

Two radars (instances 1 and 2; 1 also sends ego motion) are offered and send a list each 50 ms. In between comes what the
scenario is about. Everything is fixed: times, seeds, values. Exit code 77: no scapy.
"""
import struct
import sys
from pathlib import Path

try:
    import scapy.contrib.automotive.someip
except ImportError as problem:
    print(f"skipped: python3-scapy is not installed ({problem})")
    sys.exit(77)

from recording import SCENARIOS, Recording

for module in ("cut_segments", "messages", "offers"):  # which fill SCENARIOS
    __import__(module)


def toml(recordings):
    def flat(rows):
        return [number for row in rows for number in row]
    for name, r in recordings:
        faults = ", ".join(f'"{count}|{key}"' for key, count in r.faults.items())
        yield f"""[[scenario]]
name = "{name}"
delivered = {flat(r.delivered)}
optional = {flat(r.optional)}
egos = {r.egos}
at_least = {str(r.at_least).lower()}
e2e = {[] if r.e2e is None else r.e2e[1] + r.e2e[2]}
faults = [{faults}]

"""


def pcap(packets):
    """An Ethernet capture with stamps in nanoseconds."""
    records = (struct.pack("<IIII", time_ns // 10**9, time_ns % 10**9, len(packet), len(packet)) + packet
               for time_ns, packet in packets)
    return struct.pack("<IHHiIII", 0xA1B23C4D, 2, 4, 0, 0, 65535, 1) + b"".join(records)


def main(folder):
    recordings = []
    for name, body in SCENARIOS:
        r = Recording()
        r.offer()
        r.rest()
        body(r)
        recordings.append((name, r))
        (folder / f"{name}.pcap").write_bytes(pcap(r.packets))
    (folder / "expected.toml").write_text("".join(toml(recordings)))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
