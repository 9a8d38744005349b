#!/usr/bin/env python3
"""can_feed.py SECONDS: writes a candump log of a drive straight ahead at 10 m/s to standard output.

vcan0 carries the ego signals of interfaces/wire/toyota.hpp. vcan1 carries the CAN FD lists of a front radar, as
config/mappings/example_radar.dbc defines them. The radar is mounted 2.5° to the left of its nominal direction. It sees
reflectors on both sides of the road and a car that drives 25 m ahead. The same arguments give the same bytes."""
import math
import random
import struct
import sys

SPEED_MPS = 10.0
YAW_ERROR_RAD = math.radians(2.5)
RADAR_X_M, RADAR_HEIGHT_M = 3.9, 0.6
CYCLE_S, EGO_CYCLE_S = 0.2, 0.05
REFLECTORS_SEEN = 5
CAR_M = ((25.0, -0.6), (25.0, 0.0), (25.0, 0.6))  # ahead of the radar and to the left
LIST_HEADER, DETECTION = 0x300, 0x301
YAW_RATE, STEERING, WHEELS = 0x024, 0x025, 0x0AA
random.seed(46)


def line(time_s, bus, identifier, payload, fd):
    separator = "##1" if fd else "#"  # ##1: CAN FD with the fast bit rate
    return f"({time_s:.6f}) {bus} {identifier:03X}{separator}{payload.hex().upper()}\n"


def motorola(payload, first_bit, length, value):
    """Writes bits from `first_bit`, the highest one, down to bit 0 of its byte and on from bit 7 of the next."""
    position = first_bit // 8 * 8 + 7 - first_bit % 8
    for k in range(length):
        if value >> (length - 1 - k) & 1:
            payload[(position + k) // 8] |= 0x80 >> (position + k) % 8


def with_checksum(identifier, payload):
    payload[7] = ((identifier & 0xFF) + (identifier >> 8) + 8 + sum(payload[:7])) & 0xFF
    return payload


def ego(time_s):
    yaw_rate = bytearray(8)
    motorola(yaw_rate, 1, 10, round(125.0 / 0.244))  # 0 °/s
    wheels = struct.pack(">4H", *[round((3.6 * SPEED_MPS + 67.67) / 0.01)] * 4)
    yield line(time_s, "vcan0", YAW_RATE, with_checksum(YAW_RATE, yaw_rate), False)
    yield line(time_s, "vcan0", STEERING, with_checksum(STEERING, bytearray(8)), False)
    yield line(time_s, "vcan0", WHEELS, wheels, False)


def detection_frames(number, x_m, y_m, z_m, velocity_mps, rcs_dbsm):
    """Two frames for a point relative to the radar, with its velocity along the road over ground."""
    range_m = math.sqrt(x_m * x_m + y_m * y_m + z_m * z_m)
    range_rate_mps = (velocity_mps - SPEED_MPS) * x_m / range_m + random.gauss(0.0, 0.05)
    azimuth_deg = math.degrees(math.atan2(y_m, x_m) - YAW_ERROR_RAD) + random.gauss(0.0, 0.3)
    elevation_deg = math.degrees(math.asin(z_m / range_m)) + random.gauss(0.0, 0.6)
    place = bytearray(16)
    place[0], place[1] = number, 1 << 2  # page 0, state 1: measured
    place[2:4] = struct.pack("<H", round((range_m + random.gauss(0.0, 0.1)) / 0.01))
    motorola(place, 39, 12, round(-azimuth_deg / 0.05) & 0xFFF)  # this radar's azimuth is positive to the right
    motorola(place, 43, 12, round(elevation_deg / 0.05) & 0xFFF)
    place[8:12] = struct.pack("<f", range_rate_mps)
    strength = bytearray(16)
    strength[0], strength[1] = number, 1 << 2 | 1
    strength[2:5] = struct.pack("<bBB", round(rcs_dbsm / 0.5), round(20.0 / 0.5), 95)
    return place, strength


def reflectors_along(length_m):
    """Points (x, y, z) relative to the height of the radar, two every five metres."""
    return [(x + random.uniform(0, 5), side * random.uniform(4, 15), random.uniform(-0.5, 2))
            for x in range(0, int(length_m), 5) for side in (-1, 1)]


def radar(time_s, cycle, reflectors):
    here = SPEED_MPS * time_s + RADAR_X_M
    seen = [(x - here, y, z) for x, y, z in reflectors[int(here / 5) * 2:int(here / 5) * 2 + 44] if 5 < x - here < 100]
    seen = [point for point in seen if abs(math.atan2(point[1], point[0])) < 1.0]
    seen = random.sample(seen, min(REFLECTORS_SEEN, len(seen)))
    points = [(x, y, z, 0.0, 0.0) for x, y, z in seen] + [(x, y, 0.1, SPEED_MPS, 15.0) for x, y in CAR_M]
    header = struct.pack("<HBB4x", cycle & 0xFFFF, len(points), 0)
    yield line(time_s, "vcan1", LIST_HEADER, header, True)
    for number, point in enumerate(points):
        for frame in detection_frames(number, *point):
            yield line(time_s, "vcan1", DETECTION, frame, True)


def main():
    duration_s = float(sys.argv[1])
    reflectors = reflectors_along(SPEED_MPS * duration_s + 200)
    for k in range(int(duration_s / EGO_CYCLE_S)):
        time_s = k * EGO_CYCLE_S
        sys.stdout.writelines(ego(time_s))
        if k % round(CYCLE_S / EGO_CYCLE_S) == 0:
            sys.stdout.writelines(radar(time_s, k // round(CYCLE_S / EGO_CYCLE_S), reflectors))


main()
