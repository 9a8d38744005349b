// Boresight's own SOME/IP service for radars that need not keep a protocol of their own: identifiers and layouts. The
// definition is boresight_service.md; this header repeats its numbers. All fields are big endian.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boresight::wire::boresight_service {

inline constexpr std::uint16_t kServiceId = 0x4253;  // "BS"
inline constexpr std::uint8_t kMajorVersion = 1;
inline constexpr std::uint32_t kMinorVersion = 0;
/// Instance ids of radars; the instance id is the radar's number.
inline constexpr std::uint16_t kFirstInstance = 1;
inline constexpr std::uint16_t kLastInstance = 16;

inline constexpr std::uint16_t kEventDetectionList = 0x8001;
inline constexpr std::uint16_t kEventEgoMotion = 0x8002;
inline constexpr std::uint16_t kEventgroupDetections = 0x0001;
inline constexpr std::uint16_t kEventgroupEgoMotion = 0x0002;

/// E2E Data ID unless the project assigns others.
[[nodiscard]] constexpr std::uint32_t data_id(std::uint16_t instance, std::uint16_t event) {
  return 0x4253'0000u | (instance & 0xFFu) << 8 | (event & 0xFFu);
}

// --- message ---------------------------------------------------------------------------------------------------------
inline constexpr std::size_t kSomeIpHeaderBytes = 16;
/// The E2E-protected data begin at the Request ID; the profile 7 header follows the SOME/IP header, 64 bits later.
inline constexpr std::size_t kProtectedFrom = 8;
inline constexpr std::size_t kE2eOffsetBytes = 8;
inline constexpr std::size_t kE2eHeaderBytes = 20;
/// Offset of the body within the message; the offsets below count from here.
inline constexpr std::size_t kBody = kSomeIpHeaderBytes + kE2eHeaderBytes;
/// Longest message, header included, that a receiver has to reassemble.
inline constexpr std::size_t kMaxMessageBytes = 131072;
/// Largest payload after the SOME/IP header of an unsegmented message, and the payload of a segment.
inline constexpr std::size_t kMaxUnsegmentedPayloadBytes = 1392;
inline constexpr std::size_t kSegmentBytes = 1392;

/// State of the sender's clock, in both events.
namespace sync_status {
inline constexpr std::uint8_t kSynchronised = 1;
inline constexpr std::uint8_t kNever = 2;
inline constexpr std::uint8_t kLost = 3;
}  // namespace sync_status

// --- detection list --------------------------------------------------------------------------------------------------
namespace detection_list {
inline constexpr std::uint16_t kLayoutVersionValue = 1;
inline constexpr std::size_t kMaxDetections = 1024;

inline constexpr std::size_t kLayoutVersion = 0;        // u16
inline constexpr std::size_t kHeaderBytes = 2;          // u16, where the first record begins
inline constexpr std::size_t kSeconds = 4;              // u32
inline constexpr std::size_t kNanoseconds = 8;          // u32, below 1e9
inline constexpr std::size_t kSyncStatus = 12;          // u8
inline constexpr std::size_t kReserved = 13;            // u8, 0
inline constexpr std::size_t kDroppedDetections = 14;   // u16, saturates
inline constexpr std::size_t kCycleCounter = 16;        // u32
inline constexpr std::size_t kFields = 20;              // u32
inline constexpr std::size_t kRangeRateMin_mps = 24;    // f32
inline constexpr std::size_t kRangeRateMax_mps = 28;    // f32
inline constexpr std::size_t kNumberOfDetections = 32;  // u16
inline constexpr std::size_t kRecordBytes = 34;         // u16
inline constexpr std::size_t kMinHeaderBytes = 36;
inline constexpr std::size_t kMinRecordBytes = 48;

namespace field {
inline constexpr std::uint32_t kElevation = 1u << 0;
inline constexpr std::uint32_t kRcs = 1u << 1;
inline constexpr std::uint32_t kSnr = 1u << 2;
inline constexpr std::uint32_t kStds = 1u << 3;
inline constexpr std::uint32_t kExistence = 1u << 4;
inline constexpr std::uint32_t kAmbiguity = 1u << 5;
}  // namespace field

/// Offsets within a record.
namespace record {
inline constexpr std::size_t kRange_m = 0;                // f32
inline constexpr std::size_t kAzimuth_rad = 4;            // f32, + left
inline constexpr std::size_t kElevation_rad = 8;          // f32, + up
inline constexpr std::size_t kRangeRate_mps = 12;         // f32, + receding
inline constexpr std::size_t kRangeStd_m = 16;            // f32
inline constexpr std::size_t kAzimuthStd_rad = 20;        // f32
inline constexpr std::size_t kElevationStd_rad = 24;      // f32
inline constexpr std::size_t kRangeRateStd_mps = 28;      // f32
inline constexpr std::size_t kRcs_dbsm = 32;              // f32
inline constexpr std::size_t kSnr_db = 36;                // f32
inline constexpr std::size_t kExistenceProbability = 40;  // f32
inline constexpr std::size_t kFlags = 44;                 // u16
inline constexpr std::size_t kReserved = 46;              // u16, 0
}  // namespace record

namespace flag {
inline constexpr std::uint16_t kInvalid = 1u << 0;
inline constexpr std::uint16_t kAmbiguous = 1u << 1;
inline constexpr std::uint16_t kDoubted = 1u << 2;
}  // namespace flag

/// Values allowed, both ends included.
namespace limit {
inline constexpr float kRange_m = 1500.0F;            // 0 …
inline constexpr float kAzimuth_rad = 3.14159274F;    // ±
inline constexpr float kElevation_rad = 1.57079637F;  // ±
inline constexpr float kRangeRate_mps = 150.0F;       // ±
inline constexpr float kRcsMin_dbsm = -100.0F, kRcsMax_dbsm = 100.0F;
inline constexpr float kSnrMin_db = -50.0F, kSnrMax_db = 150.0F;
inline constexpr float kRangeStd_m = 100.0F;         // 0 (not stated) …
inline constexpr float kAngleStd_rad = 1.57079637F;  // 0 (not stated) …
inline constexpr float kRangeRateStd_mps = 50.0F;    // 0 (not stated) …
}  // namespace limit
}  // namespace detection_list

// --- ego motion ------------------------------------------------------------------------------------------------------
namespace ego_motion {
inline constexpr std::uint16_t kLayoutVersionValue = 1;

inline constexpr std::size_t kLayoutVersion = 0;       // u16
inline constexpr std::size_t kBodyBytes = 2;           // u16, of the whole body
inline constexpr std::size_t kSeconds = 4;             // u32
inline constexpr std::size_t kNanoseconds = 8;         // u32, below 1e9
inline constexpr std::size_t kSyncStatus = 12;         // u8
inline constexpr std::size_t kReserved = 13;           // 3 × u8, 0
inline constexpr std::size_t kFields = 16;             // u32
inline constexpr std::size_t kSpeed_mps = 20;          // f32, + forward
inline constexpr std::size_t kYawRate_radps = 24;      // f32, + to the left
inline constexpr std::size_t kSteeringAngle_rad = 28;  // f32, at the steering wheel, + to the left
inline constexpr std::size_t kMinBodyBytes = 32;

namespace field {
inline constexpr std::uint32_t kSpeed = 1u << 0;
inline constexpr std::uint32_t kYawRate = 1u << 1;
inline constexpr std::uint32_t kSteeringAngle = 1u << 2;
inline constexpr std::uint32_t kDirection = 1u << 3;
}  // namespace field

/// Values allowed, both ends included.
namespace limit {
inline constexpr float kSpeed_mps = 150.0F;         // ±
inline constexpr float kYawRate_radps = 5.0F;       // ±
inline constexpr float kSteeringAngle_rad = 20.0F;  // ±
}  // namespace limit
}  // namespace ego_motion

// --- service discovery -----------------------------------------------------------------------------------------------
namespace discovery {
inline constexpr std::uint16_t kPort = 30490;
inline constexpr const char* kMulticastIpv4 = "224.244.224.245";
inline constexpr const char* kMulticastIpv6 = "ff14::4:c0";
inline constexpr std::uint32_t kOfferTtl_s = 3;
}  // namespace discovery

}  // namespace boresight::wire::boresight_service
