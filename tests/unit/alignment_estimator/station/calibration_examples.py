#!/usr/bin/env python3
"""The worked examples of interfaces/wire/calibration_service.md, made from the document alone (no product code):
calibration_examples.py DOCUMENT compares them and exits with 1 if one differs; --write replaces them."""
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
import worked_examples  # noqa: E402

SERVICE, MAJOR, MINOR, INSTANCE = 0x4243, 1, 0, 1
RESPONSE, ERROR, EVENT = 0x80, 0x81, 0x02
TILTS = (-200, -100, 0, 100, 200)


def message(method, client, session, payload, kind=0, code=0):
    return struct.pack(">HHIHHBBBB", SERVICE, method, 8 + len(payload), client, session, 1, MAJOR, kind, code) + payload


def state(state, instruction, tilt_index, tilt, collected, time_left_ms):
    """A state record of run 1 of radar 2, which belongs to client 0x17."""
    return struct.pack(">HHIBBBBIHHhHHHIHH", 1, 36, 1, state, instruction, 0, 0, 2, tilt_index, len(TILTS), tilt, 30,
                       collected, 0, time_left_ms, 0x17, 0)


def verdict(accepted, refusal, record):
    return struct.pack(">BBH", accepted, refusal, 0) + record


def start():
    return struct.pack(">HHIHHBBHf", 1, 20, 2, len(TILTS), 30, 0b10, 0, 0, 12.5) + struct.pack(">5h", *TILTS)


def result():
    header = struct.pack(">HHIIBBBB", 1, 64, 1, 2, 0, 0, 1, 0)
    header += struct.pack(">4f", 0.0078125, 0.000244140625, -0.015625, 0.00048828125)
    header += struct.pack(">5f", 30.5, 0.75, -0.0155029296875, 0.001953125, 0.96875)
    header += struct.pack(">HHH3H", 4, len(TILTS), 32, 0, 0, 0)
    assert len(header) == 64
    for tilt in TILTS:
        used = 0 if tilt == -100 else 1
        header += struct.pack(">hH6fHH", tilt, 30, 30.0, 0.25, 30.25, -0.0078125, 0.001953125, 30.125, used, 0)
    return header


def offer():
    entry = struct.pack(">BBBBHHII", 1, 0, 0, 0x10, SERVICE, INSTANCE, MAJOR << 24 | 3, MINOR)
    option = struct.pack(">HBB4BBBH", 9, 0x04, 0, 192, 168, 20, 2, 0, 17, 30700)
    sd = struct.pack(">B3xI", 0xC0, len(entry)) + entry + struct.pack(">I", len(option)) + option
    return struct.pack(">HHIHHBBBB", 0xFFFF, 0x8100, 8 + len(sd), 0, 1, 1, 1, 2, 0) + sd


POSITIONING = state(1, 1, 0, -200, 0, 60000)
MEASURE = struct.pack(">HHhH", 1, 0, -198, 0)
EXAMPLES = {
    "start": message(1, 0x17, 1, start()),
    "accepted": message(1, 0x17, 1, verdict(1, 0, POSITIONING), RESPONSE),
    "measure": message(2, 0x17, 2, MEASURE),
    "busy": message(2, 0x18, 2, verdict(0, 16, POSITIONING), RESPONSE),
    "event": message(0x8001, 0, 3, state(3, 3, 0, -198, 30, 60000), EVENT),
    "not ready": message(8, 0x17, 9, b"", ERROR, 0x04),
    "result, first 128 bytes": message(8, 0x17, 10, result(), RESPONSE)[:128],
    "offer": offer(),
}

worked_examples.run(EXAMPLES)
