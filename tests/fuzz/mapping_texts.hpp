// A DBC text with every kind of signal, and mappings for it, used by the fuzz targets of mappings and mapped decoders.
#pragma once

#include <array>
#include <string_view>

namespace boresight::fuzz {

inline constexpr std::string_view kDbc = R"(BO_ 256 HEAD: 8 R
 SG_ COUNTER : 0|16@1+ (1,0) [0|0] "" X
 SG_ NEAR : 16|8@1+ (1,0) [0|0] "" X
 SG_ FAR : 24|8@1+ (1,0) [0|0] "" X
BO_ 257 LIST: 16 R
 SG_ NUMBER : 0|8@1+ (1,0) [0|0] "" X
 SG_ PAGE M : 8|2@1+ (1,0) [0|0] "" X
 SG_ STATE : 10|3@1- (1,0) [0|0] "" X
 SG_ RANGE m0 : 16|16@1+ (0.01,0) [0|0] "m" X
 SG_ AZIMUTH m0 : 39|12@0- (0.05,0) [0|0] "deg" X
 SG_ ELEVATION m0 : 43|12@0- (0.05,0) [0|0] "deg" X
 SG_ RATE m0 : 64|32@1- (1,0) [0|0] "m/s" X
 SG_ RCS m1 : 16|64@1- (0.5,0) [0|0] "dBsm" X
 SG_ EXISTENCE m1 : 32|7@1+ (1,0) [0|0] "%" X
BO_ 528 A_0: 8 R
 SG_ COUNTER : 7|8@0+ (1,0) [0|0] "" X
 SG_ LONG : 15|15@0+ (0.01,0) [0|0] "m" X
 SG_ LAT : 31|11@0- (0.04,0) [0|0] "m" X
 SG_ SPEED : 47|12@0- (0.025,0) [0|0] "m/s" X
 SG_ SUM : 63|8@0+ (1,0) [0|0] "" X
BO_ 529 A_1: 8 R
 SG_ COUNTER : 7|8@0+ (1,0) [0|0] "" X
 SG_ LONG : 15|15@0+ (0.01,0) [0|0] "m" X
 SG_ LAT : 31|11@0- (0.04,0) [0|0] "m" X
 SG_ SPEED : 47|12@0- (0.025,0) [0|0] "m/s" X
BO_ 544 B_0: 6 R
 SG_ COUNTER : 7|8@0+ (1,0) [0|0] "" X
 SG_ SCORE : 23|8@0+ (1,0) [0|0] "" X
BO_ 545 B_1: 6 R
 SG_ COUNTER : 7|8@0+ (1,0) [0|0] "" X
 SG_ SCORE : 23|8@0+ (1,0) [0|0] "" X
BO_ 2147483904 PACKED: 64 R
 SG_ INDEX M : 0|8@1+ (1,0) [0|0] "" X
 SG_ SUB m1M : 8|8@1+ (1,0) [0|0] "" X
 SG_ X_0 m0 : 64|64@1- (1,0) [0|0] "m" X
 SG_ Y_0 m0 : 128|64@1- (1e300,0) [0|0] "m" X
 SG_ V_0 m0 : 192|32@1- (1,0) [0|0] "m/s" X
 SG_ X_1 m2 : 64|64@1- (1,0) [0|0] "m" X
 SG_ Y_1 m2 : 128|64@1- (1,0) [0|0] "m" X
 SG_ V_1 m2 : 192|32@1- (1,0) [0|0] "m/s" X
BO_ 513 MOTION: 8 C
 SG_ LEFT : 16|10@1+ (1,0) [0|0] "" X
 SG_ RIGHT : 26|10@1+ (1,0) [0|0] "" X
 SG_ GEAR : 40|3@1+ (1,0) [0|0] "" X
BO_ 514 SPEED: 8 C
 SG_ V : 0|32@1- (1,0) [0|0] "km/h" X
 SG_ YAW : 39|16@0- (0.01,0) [0|0] "deg/s" X
 SG_ WHEEL : 55|16@0- (0.1,0) [0|0] "deg" X
BO_ 515 END: 1 R
SIG_VALTYPE_ 257 RATE : 1;
SIG_VALTYPE_ 257 RCS : 2;
SIG_VALTYPE_ 2147483904 X_0 : 2;
SIG_VALTYPE_ 2147483904 V_0 : 1;
SIG_VALTYPE_ 514 V : 1;
SG_MUL_VAL_ 2147483904 SUB INDEX 1-1;
SG_MUL_VAL_ 2147483904 X_1 SUB 2-3, 9-9;
SG_MUL_VAL_ 2147483904 Y_1 SUB 2-3, 9-9;
SG_MUL_VAL_ 2147483904 V_1 SUB 2-3, 9-9;
)";

inline constexpr std::array<std::string_view, 4> kRadarMappings = {
    R"(kind = "radar"
dbc = "x"
[cycle]
end = "count"
[header]
message = "HEAD"
counts = ["NEAR", "FAR"]
counter = "COUNTER"
[[detections]]
slot_by = "signal"
slots = 64
[[detections.message]]
name = "LIST"
slot_signal = "NUMBER"
slot_first = 1
[detections.signals]
range = { signal = "RANGE" }
azimuth = { signal = "AZIMUTH", factor = -1 }
elevation = { signal = "ELEVATION" }
range_rate = { signal = "RATE" }
rcs = { signal = "RCS" }
existence = { signal = "EXISTENCE" }
[[detections.valid]]
signal = "STATE"
is_not = [0, -1]
)",
    R"(kind = "radar"
dbc = "x"
[cycle]
end = "all_messages"
timeout_ms = 20
[[detections]]
index = [0, 1]
counter = "COUNTER"
[[detections.message]]
name = "A_{}"
checksum = "toyota"
[[detections.message]]
names = ["B_0", "B_1"]
e2e = { profile = "P05", data_ids = [7, 9], offset_bytes = 2 }
[detections.signals]
longitudinal = { signal = "LONG" }
lateral = { signal = "LAT", factor = -1 }
velocity_longitudinal = { signal = "SPEED", message = 1 }
existence = { signal = "SCORE", unit = "%" }
)",
    R"(kind = "radar"
dbc = "x"
id_offset = 16
[cycle]
end = "last_message"
last_message = "END"
[[detections]]
index = [0, 1]
[[detections.message]]
name = "PACKED"
[detections.signals]
longitudinal = { signal = "X_{}" }
lateral = { signal = "Y_{}" }
velocity_longitudinal = { signal = "V_{}" }
velocity_lateral = { signal = "V_{:01}" }
)",
    R"(kind = "radar"
dbc = "x"
[cycle]
end = "timeout"
[[detections]]
slot_by = "arrival"
slots = 3
[[detections.message]]
name = "A_0"
[detections.signals]
longitudinal = { signal = "LONG", factor = 1e9 }
lateral = { signal = "LAT", unit = "km" }
range_rate = { signal = "SPEED", offset = -3 }
)"};

inline constexpr std::array<std::string_view, 2> kEgoMappings = {
    R"(kind = "ego"
dbc = "x"
[pulses]
message = "MOTION"
signals = ["LEFT", "RIGHT"]
metres_per_pulse = 0.02
wrap = 1000
[reverse]
message = "MOTION"
signal = "GEAR"
is = [1]
[steering_angle]
message = "SPEED"
signals = ["WHEEL"]
)",
    R"(kind = "ego"
dbc = "x"
[speed]
message = "SPEED"
signals = ["V"]
signed = true
plausible_mps = [-20, 60]
e2e = { profile = "P11", data_id = 5, offset_bytes = 6 }
[yaw_rate]
message = "SPEED"
signals = ["YAW"]
)"};

}  // namespace boresight::fuzz
