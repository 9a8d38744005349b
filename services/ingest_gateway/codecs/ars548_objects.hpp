// ARS548 object list: the output of the sensor's own tracker.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "interfaces/wire/ars548.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/codecs/result.hpp"

namespace boresight::ingest::ars548 {

enum class ObjectClass : std::uint8_t {
  kCar,
  kTruck,
  kMotorcycle,
  kBicycle,
  kPedestrian,
  kAnimal,
  kHazard,
  kUnknown,
};
inline constexpr std::size_t kNumberOfObjectClasses = 8;

/// A velocity or an acceleration in the vehicle's frame, x ahead and y left, in m/s or m/s².
struct PlanarVector {
  float x;
  float x_std;
  float y;
  float y_std;
  float covariance_xy;
  bool valid;  ///< all are finite, no standard deviation is negative, and the sensor sets no flag
};

struct Object {
  std::uint32_t id;
  std::uint16_t age;  ///< as sent; saturates
  std::uint8_t measurement_status;
  std::uint8_t movement_status;
  std::uint8_t position_reference;
  float x_m;
  float x_std_m;
  float y_m;
  float y_std_m;
  float z_m;
  float z_std_m;
  float covariance_xy_m2;
  float orientation_rad;
  float orientation_std_rad;
  float existence_probability;                                  ///< 0 … 1
  std::array<float, kNumberOfObjectClasses> class_probability;  ///< 0 … 1, by ObjectClass
  PlanarVector absolute_velocity_mps;                           ///< over ground
  PlanarVector relative_velocity_mps;
  PlanarVector absolute_acceleration_mps2;
  PlanarVector relative_acceleration_mps2;
  float orientation_rate_radps;  ///< this and the following: 0 ("not stated") if flagged or not finite
  float orientation_rate_std_radps;
  float length_m;
  float width_m;
  /// False: position, orientation, a status or a probability is out of its range or flagged invalid; the record must
  /// not be used.
  bool valid;
};

struct ObjectList {
  SensorStamp time;
  std::uint32_t cycle_counter;
  std::size_t number_of_objects;
  std::array<Object, wire::ars548::kLongListRecords> objects;
};

/// Checks one UDP payload by its header, lengths and ranges. kComplete: a valid object list of 50 or 200 records for
/// decode_objects(). kUnknownMessage: another message. Otherwise `problem` is the fault.
[[nodiscard]] DecodeResult check_objects(std::span<const std::uint8_t> datagram, std::string_view& problem);

/// Writes all fields of `list` up to its count from a datagram with check_objects() kComplete. A single implausible
/// object is marked, not rejected.
void decode_objects(std::span<const std::uint8_t> datagram, ObjectList& list);

}  // namespace boresight::ingest::ars548
