// Continental ARS548 (4D radar): layout of the detection list and of its other messages. Big endian, one UDP datagram
// per message. Framed like SOME/IP, but without service discovery, transport protocol or checked E2E header.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boresight::wire::ars548 {

inline constexpr std::uint16_t kServiceId = 0;
inline constexpr std::uint16_t kMethodDetectionList = 336;
inline constexpr std::uint16_t kMethodObjectList = 329;
inline constexpr std::uint16_t kMethodStatus = 380;
inline constexpr std::uint16_t kMethodFilterStatus = 396;

/// SOME/IP: service u16, method u16, length u32 (bytes after this field), then 8 more bytes of header.
inline constexpr std::size_t kShortHeaderBytes = 8;

// --- detection list --------------------------------------------------------------------------------------------------
inline constexpr std::size_t kDetectionListBytes = 35336;
inline constexpr std::size_t kSequenceCounter = 28;  // u32, in the E2E header
inline constexpr std::size_t kNanoseconds = 36;      // u32
inline constexpr std::size_t kSeconds = 40;          // u32
inline constexpr std::size_t kSyncStatus = 44;       // u8
inline constexpr std::uint8_t kSyncOk = 1;
inline constexpr std::uint8_t kSyncNever = 2;
inline constexpr std::uint8_t kSyncLost = 3;
inline constexpr std::size_t kOrigin =
    52;  // f32: x, y, z, roll, pitch, yaw of the sensor, each followed by its standard deviation
inline constexpr std::size_t kDetections = 101;
inline constexpr std::size_t kMaxDetectionRecords = 800;
inline constexpr std::size_t kDetectionBytes = 44;
inline constexpr std::size_t kRangeRateMin_mps = 35301;         // f32
inline constexpr std::size_t kRangeRateMax_mps = 35305;         // f32
inline constexpr std::size_t kNumberOfDetections = 35309;       // u32
inline constexpr std::size_t kAzimuthCorrection_rad = 35313;    // f32
inline constexpr std::size_t kElevationCorrection_rad = 35317;  // f32
inline constexpr std::size_t kAlignmentStatus = 35321;          // u8

// --- object list -----------------------------------------------------------------------------------------------------
// The same headers and stamp as the detection list; sequence counter, time and sync status are at its offsets.
inline constexpr std::size_t kObjectListBytes = 9401;
inline constexpr std::size_t kShortListRecords = 50;
/// Newer firmware. It has one byte more than 200 records need. No public source states its place; the last byte is
/// assumed.
inline constexpr std::size_t kLongObjectListBytes = 37452;
inline constexpr std::size_t kLongListRecords = 200;
inline constexpr std::size_t kNumberOfObjects = 50;  // u8
inline constexpr std::size_t kObjects = 51;
inline constexpr std::size_t kObjectBytes = 187;

/// Offsets within an object record. Vehicle's frame: x ahead, y left.
namespace object {
inline constexpr std::size_t kId = 2;                  // u32
inline constexpr std::size_t kAge = 6;                 // u16
inline constexpr std::size_t kMeasurementStatus = 8;   // u8: 0 measured, 1 predicted, 2 new, 255 invalid
inline constexpr std::size_t kMovementStatus = 9;      // u8: 0 moving, 1 stationary, 255 invalid
inline constexpr std::size_t kPositionInvalid = 10;    // u16 bits
inline constexpr std::size_t kPositionReference = 12;  // u8: which point of the box, 0 … 7, 255 invalid
inline constexpr std::size_t kX_m = 13;                // f32, as all fields below without a comment on their type
inline constexpr std::size_t kXStd_m = 17;
inline constexpr std::size_t kY_m = 21;
inline constexpr std::size_t kYStd_m = 25;
inline constexpr std::size_t kZ_m = 29;
inline constexpr std::size_t kZStd_m = 33;
inline constexpr std::size_t kCovarianceXy_m2 = 37;
inline constexpr std::size_t kOrientation_rad = 41;
inline constexpr std::size_t kOrientationStd_rad = 45;
inline constexpr std::size_t kExistenceInvalid = 49;  // u8 bits
inline constexpr std::size_t kExistence_percent = 50;
inline constexpr std::size_t kClasses_percent = 58;       // 8 × u8, in the order of ObjectClass
inline constexpr std::size_t kAbsoluteVelocity_mps = 68;  // u8 invalid bits, x, std of x, y, std of y, covariance
inline constexpr std::size_t kRelativeVelocity_mps = 89;  // likewise
inline constexpr std::size_t kAbsoluteAcceleration_mps2 = 110;
inline constexpr std::size_t kRelativeAcceleration_mps2 = 131;
inline constexpr std::size_t kOrientationRateInvalid = 152;  // u8 bits
inline constexpr std::size_t kOrientationRate_radps = 153;
inline constexpr std::size_t kOrientationRateStd_radps = 157;
inline constexpr std::size_t kLengthInvalid = 165;  // u8 bits
inline constexpr std::size_t kLength_m = 166;
inline constexpr std::size_t kWidthInvalid = 178;  // u8 bits
inline constexpr std::size_t kWidth_m = 179;
}  // namespace object

// --- sensor status; the header is the 8 bytes of service, method and length only ------------------------------------
inline constexpr std::size_t kStatusBytes = 84;
namespace status {
inline constexpr std::size_t kSyncStatus = 16;      // u8, as in the detection list
inline constexpr std::size_t kVelocityStatus = 73;  // u8, 0: input is received
inline constexpr std::size_t kYawRateStatus = 76;   // u8, likewise
inline constexpr std::size_t kRadarState = 80;      // u8: 0 starting, 1 in operation, 2 invalid
inline constexpr std::uint8_t kStateInvalid = 2;
inline constexpr std::size_t kVoltage = 81;      // u8 bits, 0: in range
inline constexpr std::size_t kTemperature = 82;  // u8 bits, 0: in range
inline constexpr std::size_t kBlockage = 83;     // u8: low half 0 blind … 4 none; high half self-test
inline constexpr std::uint8_t kBlockageHigh = 1;
inline constexpr std::uint8_t kBlockageMid = 2;
inline constexpr std::uint8_t kBlockageLow = 3;
inline constexpr std::uint8_t kSelfTestFailed = 0;
}  // namespace status

// --- motion of the vehicle, an input of the sensor: same short header, floats at the given offset -------------------
inline constexpr std::uint16_t kSensorPort = 42101;
/// A message to the sensor: method, size in bytes, offset of its value.
struct MotionInput {
  std::uint16_t method;
  std::size_t bytes;
  std::size_t value;
};
inline constexpr MotionInput kLongitudinalAcceleration_mps2{322, 40, 14};  // f32
inline constexpr MotionInput kSpeed_kmph{323, 36, 11};                     // f32
inline constexpr MotionInput kDrivingDirection{325, 30, 9};                // u8: 0 standing, 1 forward, 2 backward
inline constexpr MotionInput kYawRate_degps{326, 40, 14};                  // f32, ±163.83
inline constexpr MotionInput kSteeringAngle_deg{327, 40, 14};              // f32, front axle, ±90

/// Offsets within a detection record.
namespace record {
inline constexpr std::size_t kAzimuth_rad = 0;                       // f32
inline constexpr std::size_t kAzimuthStd_rad = 4;                    // f32
inline constexpr std::size_t kInvalidFlags = 8;                      // u8
inline constexpr std::size_t kElevation_rad = 9;                     // f32
inline constexpr std::size_t kElevationStd_rad = 13;                 // f32
inline constexpr std::size_t kRange_m = 17;                          // f32
inline constexpr std::size_t kRangeStd_m = 21;                       // f32
inline constexpr std::size_t kRangeRate_mps = 25;                    // f32, + receding
inline constexpr std::size_t kRangeRateStd_mps = 29;                 // f32
inline constexpr std::size_t kRcs_dbsm = 33;                         // i8
inline constexpr std::size_t kMeasurementId = 34;                    // u16
inline constexpr std::size_t kPositivePredictiveValue_percent = 36;  // u8
inline constexpr std::size_t kClassification = 37;                   // u8
inline constexpr std::size_t kMultiTargetProbability_percent = 38;   // u8
inline constexpr std::size_t kObjectId = 39;                         // u16
inline constexpr std::size_t kAmbiguityFlag = 41;                    // u8
inline constexpr std::size_t kSortIndex = 42;                        // u16
}  // namespace record

/// Bits of the invalid flags.
namespace invalid {
inline constexpr std::uint8_t kRange = 1u << 0;
inline constexpr std::uint8_t kRangeStd = 1u << 1;
inline constexpr std::uint8_t kAzimuth = 1u << 2;
inline constexpr std::uint8_t kAzimuthStd = 1u << 3;
inline constexpr std::uint8_t kElevation = 1u << 4;
inline constexpr std::uint8_t kElevationStd = 1u << 5;
inline constexpr std::uint8_t kRangeRate = 1u << 6;
inline constexpr std::uint8_t kRangeRateStd = 1u << 7;
}  // namespace invalid

}  // namespace boresight::wire::ars548
