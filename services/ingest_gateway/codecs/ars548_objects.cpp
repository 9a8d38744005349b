#include "services/ingest_gateway/codecs/ars548_objects.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/someip/big_endian.hpp"
#include "services/ingest_gateway/codecs/ars548.hpp"

namespace boresight::ingest::ars548 {

namespace layout = wire::ars548;

namespace {

constexpr std::uint8_t kUnknownMovement = 255;  // the other fields are still valid

std::size_t records_of(std::size_t bytes) {
  if (bytes == layout::kObjectListBytes) return layout::kShortListRecords;
  return bytes == layout::kLongObjectListBytes ? layout::kLongListRecords : 0;
}

/// Finite and not negative.
bool is_std(float value) {
  return std::isfinite(value) && value >= 0.0F;
}

PlanarVector vector_of(const std::uint8_t* p) {
  PlanarVector v{.x = read_f32(p + 1),
                 .x_std = read_f32(p + 5),
                 .y = read_f32(p + 9),
                 .y_std = read_f32(p + 13),
                 .covariance_xy = read_f32(p + 17),
                 .valid = false};
  v.valid = p[0] == 0 && std::isfinite(v.x) && std::isfinite(v.y) && is_std(v.x_std) && is_std(v.y_std) &&
            std::isfinite(v.covariance_xy);
  return v;
}

/// A value, or 0 if it is flagged or not finite.
float stated(const std::uint8_t* p, bool flagged) {
  const float value = read_f32(p);
  return !flagged && std::isfinite(value) ? value : 0.0F;
}

/// Ranges as in the open-source driver nebula.
bool is_valid(const Object& o, const std::uint8_t* record) {
  namespace f = layout::object;
  constexpr float kPi = 3.14159274F;
  constexpr float kMaxPosition_m = 1600.0F;
  const auto is_position = [](float v) { return std::abs(v) <= kMaxPosition_m; };  // false for NaN
  const auto is_probability = [](float v) { return v >= 0.0F && v <= 1.0F; };
  const bool unflagged = read_u16(record + f::kPositionInvalid) == 0 && record[f::kExistenceInvalid] == 0;
  const bool has_status = o.measurement_status <= 2 && o.position_reference <= 7 &&
                          (o.movement_status <= 1 || o.movement_status == kUnknownMovement);
  const bool has_position = is_position(o.x_m) && is_position(o.y_m) && is_position(o.z_m) && is_std(o.x_std_m) &&
                            is_std(o.y_std_m) && is_std(o.z_std_m) && std::isfinite(o.covariance_xy_m2);
  const bool has_orientation = std::abs(o.orientation_rad) <= kPi && is_std(o.orientation_std_rad);
  return unflagged && has_status && has_position && has_orientation && is_probability(o.existence_probability) &&
         std::all_of(o.class_probability.begin(), o.class_probability.end(), is_probability);
}

void write_object(const std::uint8_t* record, Object& o) {
  namespace f = layout::object;
  o.id = read_u32(record + f::kId);
  o.age = read_u16(record + f::kAge);
  o.measurement_status = record[f::kMeasurementStatus];
  o.movement_status = record[f::kMovementStatus];
  o.position_reference = record[f::kPositionReference];
  o.x_m = read_f32(record + f::kX_m);
  o.x_std_m = read_f32(record + f::kXStd_m);
  o.y_m = read_f32(record + f::kY_m);
  o.y_std_m = read_f32(record + f::kYStd_m);
  o.z_m = read_f32(record + f::kZ_m);
  o.z_std_m = read_f32(record + f::kZStd_m);
  o.covariance_xy_m2 = read_f32(record + f::kCovarianceXy_m2);
  o.orientation_rad = read_f32(record + f::kOrientation_rad);
  o.orientation_std_rad = read_f32(record + f::kOrientationStd_rad);
  o.existence_probability = 0.01F * read_f32(record + f::kExistence_percent);
  for (std::size_t i = 0; i < kNumberOfObjectClasses; ++i) {
    o.class_probability[i] = 0.01F * static_cast<float>(record[f::kClasses_percent + i]);
  }
  o.absolute_velocity_mps = vector_of(record + f::kAbsoluteVelocity_mps);
  o.relative_velocity_mps = vector_of(record + f::kRelativeVelocity_mps);
  o.absolute_acceleration_mps2 = vector_of(record + f::kAbsoluteAcceleration_mps2);
  o.relative_acceleration_mps2 = vector_of(record + f::kRelativeAcceleration_mps2);
  const bool no_rate = record[f::kOrientationRateInvalid] != 0;
  o.orientation_rate_radps = stated(record + f::kOrientationRate_radps, no_rate);
  o.orientation_rate_std_radps = stated(record + f::kOrientationRateStd_radps, no_rate);
  o.length_m = stated(record + f::kLength_m, record[f::kLengthInvalid] != 0);
  o.width_m = stated(record + f::kWidth_m, record[f::kWidthInvalid] != 0);
  o.valid = is_valid(o, record);
}

}  // namespace

DecodeResult check_objects(std::span<const std::uint8_t> datagram, std::string_view& problem) {
  if (datagram.size() < layout::kShortHeaderBytes) {
    problem = "ARS548: datagram shorter than its 8-byte header";
    return DecodeResult::kBadLength;
  }
  const std::uint8_t* const bytes = datagram.data();
  if (read_u16(bytes) != layout::kServiceId || read_u16(bytes + 2) != layout::kMethodObjectList) {
    problem = "ARS548: not an object list (service 0, method 329)";
    return DecodeResult::kUnknownMessage;
  }
  const std::size_t records = records_of(datagram.size());
  if (records == 0) {
    problem = "ARS548: object list is neither 9401 nor 37452 bytes long";
    return DecodeResult::kBadLength;
  }
  if (read_u32(bytes + 4) != datagram.size() - layout::kShortHeaderBytes) {
    problem = "ARS548: length field of the object list is not its length minus 8";
    return DecodeResult::kBadLength;
  }
  if (bytes[layout::kNumberOfObjects] > records) {
    problem = "ARS548: number of objects over 50 (9401 bytes) or 200 (37452 bytes)";
    return DecodeResult::kBadValue;
  }
  if (read_u32(bytes + layout::kNanoseconds) >= 1'000'000'000) {
    problem = "ARS548: nanoseconds of the stamp not below 1e9";
    return DecodeResult::kBadValue;
  }
  return DecodeResult::kComplete;
}

void decode_objects(std::span<const std::uint8_t> datagram, ObjectList& list) {
  const std::uint8_t* const bytes = datagram.data();
  list.time = stamp_of(datagram);
  list.cycle_counter = read_u32(bytes + layout::kSequenceCounter);
  list.number_of_objects = bytes[layout::kNumberOfObjects];
  for (std::size_t i = 0; i < list.number_of_objects; ++i) {
    write_object(bytes + layout::kObjects + i * layout::kObjectBytes, list.objects[i]);
  }
}

}  // namespace boresight::ingest::ars548
