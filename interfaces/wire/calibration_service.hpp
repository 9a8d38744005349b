// The SOME/IP service with which an end-of-line station calibrates a radar by a tilting plate: identifiers and layouts.
// The definition is calibration_service.md; this header repeats its numbers. All fields are big endian; offsets count
// from the beginning of the payload.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boresight::wire::calibration_service {

inline constexpr std::uint16_t kServiceId = 0x4243;  // "BC"
inline constexpr std::uint8_t kMajorVersion = 1;
inline constexpr std::uint32_t kMinorVersion = 0;
inline constexpr std::uint16_t kDefaultInstance = 1;
inline constexpr std::uint16_t kDefaultPort = 30700;
inline constexpr std::uint16_t kEventgroupState = 0x0001;
inline constexpr std::uint16_t kEventState = 0x8001;

enum class Method : std::uint16_t {
  kStartCalibration = 0x0001,
  kMeasure = 0x0002,
  kNext = 0x0003,
  kRepeatTilt = 0x0004,
  kRepeatRun = 0x0005,
  kAbort = 0x0006,
  kGetState = 0x0007,
  kGetResult = 0x0008,
};

enum class ReturnCode : std::uint8_t {
  kOk = 0x00,
  kUnknownService = 0x02,
  kUnknownMethod = 0x03,
  kNotReady = 0x04,
  kWrongProtocolVersion = 0x07,
  kWrongInterfaceVersion = 0x08,
  kMalformedMessage = 0x09,
  kWrongMessageType = 0x0A,
};

/// Reason for refusing a command. Values below 16 are those of the state machine that carries out the command.
enum class Refusal : std::uint8_t {
  kNone = 0,
  kWrongState = 1,
  kTooFewTilts = 2,
  kTooManyTilts = 3,
  kTiltOutOfRange = 4,
  kTiltsNotMonotonic = 5,
  kScansOutOfRange = 6,
  kWrongTilt = 7,
  kNoRun = 8,
  kBusy = 16,
  kUnknownRadar = 17,
  kWrongTiltIndex = 18,
  kVehicleMoves = 19,
  kLimitOutOfRange = 20,
};

enum class State : std::uint8_t {
  kIdle = 0,
  kPositioning = 1,
  kMeasuring = 2,
  kTiltDone = 3,
  kFinished = 4,
  kFailed = 5,
};

enum class Instruction : std::uint8_t {
  kStart = 0,
  kMovePlate = 1,
  kWait = 2,
  kSendNext = 3,
  kTakeResult = 4,
  kRepeatRun = 5,
};

enum class Failure : std::uint8_t {
  kNone = 0,
  kAborted = 1,
  kPositioningTimeout = 2,
  kNoPlateSeen = 3,
  kMeasuringTimeout = 4,
  kDecisionTimeout = 5,
  kTooFewTilts = 6,
  kTooFewScans = 7,
  kTiltsNotMonotonic = 8,
  kNotFinite = 9,
  kNoMaximum = 10,
  kMaximumOutsideTilts = 11,
  kAmplitudeTooLow = 12,
};

inline constexpr std::uint16_t kLayoutVersionValue = 1;  ///< of every payload that has one
inline constexpr std::size_t kLayoutVersion = 0;         // u16

inline constexpr double kRadiansPerUnitOfTilt = 1.7453292519943296e-4;  ///< i16 in hundredths of a degree
/// Longest time from a command to its repetition; a repetition is answered, but not carried out again.
inline constexpr double kRepetition_s = 5.0;

// --- requests --------------------------------------------------------------------------------------------------------
namespace start {
inline constexpr std::size_t kHeaderBytes = 2;       // u16, where the first tilt is
inline constexpr std::size_t kRadarId = 4;           // u32
inline constexpr std::size_t kNumberOfTilts = 8;     // u16
inline constexpr std::size_t kScansPerTilt = 10;     // u16
inline constexpr std::size_t kFields = 12;           // u8
inline constexpr std::size_t kMethod = 13;           // u8
inline constexpr std::size_t kReserved = 14;         // u16
inline constexpr std::size_t kMinAmplitude_db = 16;  // f32
inline constexpr std::size_t kMinHeaderBytes = 20;
inline constexpr std::size_t kTiltBytes = 2;  // i16
namespace field {
inline constexpr std::uint8_t kMethod = 1u << 0;
inline constexpr std::uint8_t kMinAmplitude = 1u << 1;
}  // namespace field
inline constexpr std::uint8_t kMethodRobust = 0;
inline constexpr std::uint8_t kMethodPublished = 1;
}  // namespace start

namespace measure {
inline constexpr std::size_t kTiltIndex = 2;  // u16
inline constexpr std::size_t kTilt = 4;       // i16
inline constexpr std::size_t kReserved = 6;   // u16
inline constexpr std::size_t kBytes = 8;
inline constexpr std::int16_t kAsAskedFor = -32768;
}  // namespace measure

/// Next and RepeatTilt.
namespace tilt {
inline constexpr std::size_t kTiltIndex = 2;  // u16
inline constexpr std::size_t kBytes = 4;
}  // namespace tilt

/// RepeatRun and Abort.
namespace run {
inline constexpr std::size_t kReserved = 2;  // u16
inline constexpr std::size_t kBytes = 4;
}  // namespace run

// --- answers ---------------------------------------------------------------------------------------------------------
namespace verdict {
inline constexpr std::size_t kAccepted = 0;  // u8
inline constexpr std::size_t kRefusal = 1;   // u8
inline constexpr std::size_t kReserved = 2;  // u16
inline constexpr std::size_t kState = 4;     // state record
}  // namespace verdict

namespace state {
inline constexpr std::size_t kRecordBytes = 2;         // u16
inline constexpr std::size_t kRun = 4;                 // u32
inline constexpr std::size_t kState = 8;               // u8
inline constexpr std::size_t kInstruction = 9;         // u8
inline constexpr std::size_t kFailure = 10;            // u8
inline constexpr std::size_t kReserved = 11;           // u8
inline constexpr std::size_t kRadarId = 12;            // u32
inline constexpr std::size_t kTiltIndex = 16;          // u16
inline constexpr std::size_t kNumberOfTilts = 18;      // u16
inline constexpr std::size_t kTilt = 20;               // i16
inline constexpr std::size_t kScansPerTilt = 22;       // u16
inline constexpr std::size_t kScansCollected = 24;     // u16
inline constexpr std::size_t kScansWithoutPlate = 26;  // u16
inline constexpr std::size_t kTimeLeft_ms = 28;        // u32
inline constexpr std::size_t kClientId = 32;           // u16
inline constexpr std::size_t kReserved2 = 34;          // u16
inline constexpr std::size_t kBytes = 36;
}  // namespace state

namespace result {
inline constexpr std::size_t kHeaderBytes = 2;         // u16
inline constexpr std::size_t kRun = 4;                 // u32
inline constexpr std::size_t kRadarId = 8;             // u32
inline constexpr std::size_t kFailure = 12;            // u8
inline constexpr std::size_t kMethod = 13;             // u8
inline constexpr std::size_t kTakenOver = 14;          // u8
inline constexpr std::size_t kReserved = 15;           // u8
inline constexpr std::size_t kYaw_rad = 16;            // f32
inline constexpr std::size_t kYawStd_rad = 20;         // f32
inline constexpr std::size_t kPitch_rad = 24;          // f32
inline constexpr std::size_t kPitchStd_rad = 28;       // f32
inline constexpr std::size_t kMaximum_db = 32;         // f32
inline constexpr std::size_t kConfidence = 36;         // f32
inline constexpr std::size_t kTriplesMedian_rad = 40;  // f32
inline constexpr std::size_t kTriplesStd_rad = 44;     // f32
inline constexpr std::size_t kAzimuthInliers = 48;     // f32
inline constexpr std::size_t kTiltsUsed = 52;          // u16
inline constexpr std::size_t kNumberOfTilts = 54;      // u16
inline constexpr std::size_t kRecordBytes = 56;        // u16
inline constexpr std::size_t kReserved2 = 58;          // 3 × u16
inline constexpr std::size_t kBytes = 64;              ///< of the header

/// Offsets within a tilt's record.
namespace record {
inline constexpr std::size_t kTilt = 0;              // i16
inline constexpr std::size_t kScans = 2;             // u16
inline constexpr std::size_t kMean_db = 4;           // f32
inline constexpr std::size_t kStd_db = 8;            // f32
inline constexpr std::size_t kMedian_db = 12;        // f32
inline constexpr std::size_t kMeanAzimuth_rad = 16;  // f32
inline constexpr std::size_t kAzimuthStd_rad = 20;   // f32
inline constexpr std::size_t kFitted_db = 24;        // f32
inline constexpr std::size_t kFlags = 28;            // u16
inline constexpr std::size_t kReserved = 30;         // u16
inline constexpr std::size_t kBytes = 32;
}  // namespace record
inline constexpr std::uint16_t kFlagUsed = 1u << 0;
}  // namespace result

}  // namespace boresight::wire::calibration_service
