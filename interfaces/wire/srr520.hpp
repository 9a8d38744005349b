// Continental SRR520 (short-range radar): its lists on CAN FD. Big endian. A list is a header frame, a fixed number of
// record frames (padded with empty records) and a closing frame with a CRC over all of them. Each cycle has two
// detection lists, near and high range resolution (HRR), with separate measurement times, and one object list.
// References: the structures of the public driver nebula (which calls the ids 900, 901 … in decimal) and a recorded
// cycle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "interfaces/wire/can_signal.hpp"

namespace boresight::wire::srr520 {

inline constexpr std::uint32_t kStatusId = 700;   ///< state of the sensor, with its own CRC
inline constexpr std::uint32_t kClosingId = 800;  ///< closes a list of any kind
inline constexpr std::uint32_t kNearHeaderId = 900;
inline constexpr std::uint32_t kNearRecordId = 901;
inline constexpr std::uint32_t kHrrHeaderId = 1100;
inline constexpr std::uint32_t kHrrRecordId = 1101;
inline constexpr std::uint32_t kObjectHeaderId = 1200;
inline constexpr std::uint32_t kObjectRecordId = 1201;

inline constexpr std::size_t kHeaderBytes = 32;
inline constexpr std::size_t kRecordFrameBytes = 64;
inline constexpr std::size_t kClosingBytes = 4;
inline constexpr std::size_t kStatusBytes = 64;

/// One kind of list. Its index in kLists is the list id in the closing frame.
struct ListLayout {
  std::string_view name;
  std::uint32_t header_id;
  std::uint32_t record_id;
  std::size_t number_of_frames;  ///< record frames; always all are sent
  std::size_t entries_per_frame;
  std::size_t count_offset;  ///< of the number of entries in the header
  std::size_t count_bytes;
};
inline constexpr std::array<ListLayout, 3> kLists{{
    {"near", kNearHeaderId, kNearRecordId, 50, 10, 23, 2},
    {"HRR", kHrrHeaderId, kHrrRecordId, 20, 10, 23, 2},
    {"object", kObjectHeaderId, kObjectRecordId, 20, 2, 24, 1},
}};
inline constexpr std::size_t kNearList = 0;
inline constexpr std::size_t kHrrList = 1;
inline constexpr std::size_t kObjectList = 2;
inline constexpr std::size_t kMaxRecordFrames = 50;

/// Offsets in the header of all lists.
namespace header {
inline constexpr std::size_t kSensorClock_us = 0;    // u32, since power-up, wraps
inline constexpr std::size_t kSeconds = 4;           // u32
inline constexpr std::size_t kNanoseconds = 8;       // u32
inline constexpr std::size_t kSyncStatus = 12;       // u8
inline constexpr std::size_t kSignalStatus = 13;     // u8
inline constexpr std::size_t kSequenceCounter = 14;  // u8, repeated in each record frame
/// u32. Near and HRR share one counter (a recorded cycle: 909, 910), objects have their own.
inline constexpr std::size_t kCycleCounter = 15;
// Detections:
inline constexpr std::size_t kAmbiguousVelocity = 19;  // u16
inline constexpr std::size_t kMaxRange = 21;           // u16, 0.1 m; 0 on the near list
// Objects:
inline constexpr std::size_t kEgoSpeed = 19;    // u16
inline constexpr std::size_t kEgoYawRate = 21;  // u16
}  // namespace header

inline constexpr std::uint8_t kSyncOk = 1;
inline constexpr std::uint8_t kSyncMax = 3;  ///< 2: never synchronised, 3: lost

/// u16 codes run to 65534; 65535 is "not available".
inline constexpr std::uint16_t kCodeMax = 65534;
inline constexpr double kSpeedFactor_mps = 200.0 / 65534.0;  ///< ego speed and ambiguous velocity
inline constexpr double kSpeedOffset_mps = -100.0;
inline constexpr double kYawRateFactor_radps = 2.0 * std::numbers::pi / 65534.0;
inline constexpr double kYawRateOffset_radps = -std::numbers::pi;

/// Offsets in a record frame: ten detections of 6 bytes or two objects of 31 bytes first.
inline constexpr std::size_t kFrameNumber = 62;    // u8, from 0 within the list
inline constexpr std::size_t kFrameSequence = 63;  // u8, the header's sequence counter
inline constexpr std::size_t kDetectionBytes = 6;

/// Within a detection. The highest code of azimuth, range rate and RCS is "not available".
inline constexpr CanSignal kRange_m{"range", 7, 12, ByteOrder::kMotorola, false, 100.0 / 4095.0, 0.0};
inline constexpr CanSignal kAzimuth_rad{
    "azimuth", 11, 9, ByteOrder::kMotorola, false, std::numbers::pi / 510.0, -std::numbers::pi / 2.0};
inline constexpr CanSignal kRangeRate_mps{"range rate", 18, 11, ByteOrder::kMotorola, false, 30.0 / 2046.0, -15.0};
inline constexpr CanSignal kRcs_dbsm{"RCS", 39, 7, ByteOrder::kMotorola, false, 60.0 / 126.0, -40.0};
/// Five bits "pdh" 0 … 4 without a public description; not used.
inline constexpr std::array<CanSignal, 5> kHypotheses{{{"pdh00", 32, 1, ByteOrder::kMotorola, false, 1.0, 0.0},
                                                       {"pdh01", 47, 1, ByteOrder::kMotorola, false, 1.0, 0.0},
                                                       {"pdh02", 46, 1, ByteOrder::kMotorola, false, 1.0, 0.0},
                                                       {"pdh03", 45, 1, ByteOrder::kMotorola, false, 1.0, 0.0},
                                                       {"pdh04", 44, 1, ByteOrder::kMotorola, false, 1.0, 0.0}}};
inline constexpr CanSignal kSnr_db{"SNR", 43, 4, ByteOrder::kMotorola, false, 1.7, 11.0};
inline constexpr std::int64_t kAzimuthUnavailable = 511;
inline constexpr std::int64_t kRangeRateUnavailable = 2047;
inline constexpr std::int64_t kRcsUnavailable = 127;

/// Status frame. In each pair of error bits, the lower one is "now", the upper one "since power-up".
namespace status {
inline constexpr std::size_t kSyncStatus = 12;
inline constexpr std::size_t kDefective = 32;        // pairs: near scan, HRR scan, RF hardware, hardware
inline constexpr std::size_t kSupplyVoltage = 33;    // pairs: over, under
inline constexpr std::size_t kTemperature = 34;      // pairs: over, under
inline constexpr std::size_t kDynamicsInvalid = 35;  // pairs: speed, long. and lateral acceleration, direction
inline constexpr std::size_t kYawRateInvalid = 36;   // one pair
inline constexpr std::size_t kCrc = 61;              // u16, CRC-16/CCITT-FALSE over the preceding bytes
inline constexpr std::uint8_t kNow = 0b01010101;
inline constexpr std::uint8_t kNowOfTwo = 0b00000101;
inline constexpr std::uint8_t kNowOfOne = 0b00000001;
/// The dynamics that the radar cannot operate without: speed and direction.
inline constexpr std::uint8_t kNowSpeedOrDirection = 0b01000001;
}  // namespace status

/// Closing frame: list id u8, CRC u16 (CRC-16/CCITT-FALSE over header and record frames), 0.
namespace closing {
inline constexpr std::size_t kListId = 0;
inline constexpr std::size_t kCrc = 1;
}  // namespace closing

}  // namespace boresight::wire::srr520
