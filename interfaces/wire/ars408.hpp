// Continental ARS408 (long-range radar) on classic CAN: clusters, objects, configuration and ego motion. A sensor with
// id n adds n · 0x10 to every CAN id, so that eight sensors can share a bus. No frame has a CRC or a counter.
// References: the manufacturer's public interface description ("Standardized ARS Interface") as quoted by open drivers;
// signal names are the manufacturer's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/wire/can_signal.hpp"

namespace boresight::wire::ars408 {

inline constexpr std::uint32_t kIdStep = 0x10;
inline constexpr unsigned kMaxSensorId = 7;

inline constexpr std::uint32_t kStateId = 0x201;
inline constexpr std::uint32_t kClusterStatusId = 0x600;
inline constexpr std::uint32_t kClusterGeneralId = 0x701;
inline constexpr std::uint32_t kClusterQualityId = 0x702;
inline constexpr std::uint32_t kObjectStatusId = 0x60A;
inline constexpr std::uint32_t kObjectGeneralId = 0x60B;
inline constexpr std::uint32_t kObjectQualityId = 0x60C;
inline constexpr std::uint32_t kObjectExtendedId = 0x60D;
inline constexpr std::uint32_t kConfigurationId = 0x200;  // to the sensor
inline constexpr std::uint32_t kEgoSpeedId = 0x300;       // to the sensor
inline constexpr std::uint32_t kEgoYawRateId = 0x301;     // to the sensor

inline constexpr std::size_t kStateBytes = 8;
inline constexpr std::size_t kClusterStatusBytes = 5;
inline constexpr std::size_t kClusterGeneralBytes = 8;
inline constexpr std::size_t kClusterQualityBytes = 5;
inline constexpr std::size_t kObjectStatusBytes = 4;
inline constexpr std::size_t kObjectGeneralBytes = 8;
inline constexpr std::size_t kObjectQualityBytes = 7;
inline constexpr std::size_t kObjectExtendedBytes = 8;
inline constexpr std::size_t kConfigurationBytes = 8;
inline constexpr std::size_t kEgoBytes = 2;

/// All signals are unsigned and big endian.
[[nodiscard]] constexpr CanSignal motorola(std::string_view name, std::uint8_t start_bit, std::uint8_t length,
                                           double factor = 1.0, double offset = 0.0) {
  return {name, start_bit, length, ByteOrder::kMotorola, false, factor, offset};
}

/// First byte of every cluster and object frame.
inline constexpr CanSignal kEntryId = motorola("ID", 7, 8);

/// State reported by the sensor. "Motion" is its input of ego motion: bit 0 speed missing, bit 1 yaw rate missing.
namespace state {
inline constexpr CanSignal kMaxDistance_m = motorola("RadarState_MaxDistanceCfg", 15, 10, 2.0);
inline constexpr CanSignal kPersistentError = motorola("RadarState_Persistent_Error", 21, 1);
inline constexpr CanSignal kInterference = motorola("RadarState_Interference", 20, 1);
inline constexpr CanSignal kTemperatureError = motorola("RadarState_Temperature_Error", 19, 1);
inline constexpr CanSignal kTemporaryError = motorola("RadarState_Temporary_Error", 18, 1);
inline constexpr CanSignal kVoltageError = motorola("RadarState_Voltage_Error", 17, 1);
inline constexpr CanSignal kSensorId = motorola("RadarState_SensorID", 34, 3);
inline constexpr CanSignal kMotion = motorola("RadarState_MotionRxState", 47, 2);
}  // namespace state

namespace cluster_status {
inline constexpr CanSignal kNear = motorola("Cluster_NofClustersNear", 7, 8);
inline constexpr CanSignal kFar = motorola("Cluster_NofClustersFar", 15, 8);
inline constexpr CanSignal kMeasurementCounter = motorola("Cluster_MeasCounter", 23, 16);
inline constexpr CanSignal kInterfaceVersion = motorola("Cluster_InterfaceVersion", 39, 4);
}  // namespace cluster_status

namespace object_status {
inline constexpr CanSignal kCount = motorola("Obj_NofObjects", 7, 8);
inline constexpr CanSignal kMeasurementCounter = motorola("Obj_MeasCounter", 15, 16);
inline constexpr CanSignal kInterfaceVersion = motorola("Obj_InterfaceVersion", 31, 4);
}  // namespace object_status

/// Position and velocity relative to the sensor, x along boresight, y to the left. Clusters and objects differ in the
/// lateral distance only.
namespace general {
inline constexpr CanSignal kLongitudinal_m = motorola("DistLong", 15, 13, 0.2, -500.0);
inline constexpr CanSignal kClusterLateral_m = motorola("DistLat", 17, 10, 0.2, -102.3);
inline constexpr CanSignal kObjectLateral_m = motorola("DistLat", 18, 11, 0.2, -204.6);
inline constexpr CanSignal kLongitudinalVelocity_mps = motorola("VrelLong", 39, 10, 0.25, -128.0);
inline constexpr CanSignal kLateralVelocity_mps = motorola("VrelLat", 45, 9, 0.25, -64.0);
inline constexpr CanSignal kDynamicProperty = motorola("DynProp", 50, 3);
inline constexpr CanSignal kRcs_dbsm = motorola("RCS", 63, 8, 0.5, -64.0);
}  // namespace general

/// Codes of standard deviations (see kRms), the same in clusters and objects where clusters have them.
namespace quality {
inline constexpr CanSignal kLongitudinal = motorola("DistLong_rms", 15, 5);
inline constexpr CanSignal kLateral = motorola("DistLat_rms", 10, 5);
inline constexpr CanSignal kLongitudinalVelocity = motorola("VrelLong_rms", 21, 5);
inline constexpr CanSignal kLateralVelocity = motorola("VrelLat_rms", 16, 5);
}  // namespace quality

namespace cluster_quality {
inline constexpr CanSignal kFalseAlarm = motorola("Cluster_Pdh0", 26, 3);  ///< see kProbability
inline constexpr CanSignal kInvalidState = motorola("Cluster_InvalidState", 39, 5);
inline constexpr CanSignal kAmbiguityState = motorola("Cluster_AmbigState", 34, 3);
}  // namespace cluster_quality

namespace object_quality {
inline constexpr CanSignal kLongitudinalAcceleration = motorola("Obj_ArelLong_rms", 27, 5);
inline constexpr CanSignal kLateralAcceleration = motorola("Obj_ArelLat_rms", 38, 5);
inline constexpr CanSignal kOrientation = motorola("Obj_Orientation_rms", 33, 5);
inline constexpr CanSignal kMeasurementState = motorola("Obj_MeasState", 52, 3);
inline constexpr CanSignal kExistence = motorola("Obj_ProbOfExist", 55, 3);  ///< see kProbability
}  // namespace object_quality

namespace object_extended {
inline constexpr CanSignal kLongitudinalAcceleration_mps2 = motorola("Obj_ArelLong", 15, 11, 0.01, -10.0);
inline constexpr CanSignal kLateralAcceleration_mps2 = motorola("Obj_ArelLat", 20, 9, 0.01, -2.5);
inline constexpr CanSignal kClass = motorola("Obj_Class", 26, 3);
inline constexpr CanSignal kOrientation_deg = motorola("Obj_OrientationAngle", 39, 10, 0.4, -180.0);
inline constexpr CanSignal kLength_m = motorola("Obj_Length", 55, 8, 0.2);
inline constexpr CanSignal kWidth_m = motorola("Obj_Width", 63, 8, 0.2);
}  // namespace object_extended

namespace ego {
inline constexpr CanSignal kDirection = motorola("RadarDevice_SpeedDirection", 7, 2);
inline constexpr CanSignal kSpeed_mps = motorola("RadarDevice_Speed", 4, 13, 0.02);
inline constexpr CanSignal kYawRate_degps = motorola("RadarDevice_YawRate", 7, 16, 0.01, -327.68);  ///< + left
inline constexpr std::uint8_t kStandstill = 0;
inline constexpr std::uint8_t kForward = 1;
inline constexpr std::uint8_t kBackward = 2;
}  // namespace ego

/// Upper bound of a standard deviation of distance (m), velocity (m/s) or acceleration (m/s²) by its code; code 31 is
/// "invalid".
inline constexpr std::array<double, 31> kRms{
    0.005, 0.006, 0.008, 0.011, 0.014, 0.018, 0.023, 0.029, 0.038, 0.049, 0.063, 0.081, 0.105, 0.135, 0.174, 0.224,
    0.288, 0.371, 0.478, 0.616, 0.794, 1.023, 1.317, 1.697, 2.187, 2.817, 3.630, 4.676, 6.025, 7.762, 10.0};
/// Upper bound of a probability by its code; the lower bound is that of the previous code. Code 0 is "invalid".
inline constexpr std::array<double, 8> kProbability{0.0, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999, 1.0};

/// Values of Cluster_AmbigState.
inline constexpr std::uint8_t kAmbiguityStaggeredRamp = 2;  ///< resolved
inline constexpr std::uint8_t kAmbiguityUnambiguous = 3;
inline constexpr std::uint8_t kAmbiguityStationary = 4;  ///< resolved under the assumption of a stationary target
/// Bit n: Cluster_InvalidState n is a valid state. Invalid are 1 low RCS, 2 near-field artefact, 3 far cluster not
/// confirmed near, 6 mirror, 7 outside the field of view, 14 harmonics, and the reserved states.
inline constexpr std::uint32_t kValidStates =
    1u << 0 | 1u << 4 | 1u << 8 | 1u << 9 | 1u << 10 | 1u << 11 | 1u << 12 | 1u << 15 | 1u << 16 | 1u << 17;
/// Bit n: an object in Obj_MeasState n was measured in this cycle: 1 new, 2 measured, 5 new from merge. Not measured
/// are 0 deleted, 3 predicted, 4 deleted for merge.
inline constexpr std::uint32_t kMeasuredStates = 1u << 1 | 1u << 2 | 1u << 5;

}  // namespace boresight::wire::ars408
