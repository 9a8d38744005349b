#include "services/alignment_estimator/core/memory/identity.hpp"

#include <algorithm>
#include <bit>
#include <string_view>

#include "services/common/e2e/crc.hpp"

namespace boresight::alignment {

namespace {

class Fingerprint {
 public:
  void add(std::uint64_t value) {
    std::array<std::uint8_t, 8> bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
    state_ = e2e::update_crc64(state_, bytes);
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value + 0.0)); }  // −0 is 0
  void add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    state_ = e2e::update_crc64(state_, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  [[nodiscard]] std::uint64_t value() const { return ~state_; }

 private:
  std::uint64_t state_ = ~std::uint64_t{0};
};

std::uint64_t fingerprint_of(const RadarConfig& radar) {
  Fingerprint print;
  print.add(static_cast<std::uint64_t>(radar.id));
  for (const double x : radar.mounting_pose.position_m) print.add(x);
  print.add(radar.mounting_pose.yaw_rad);
  print.add(radar.mounting_pose.pitch_rad);
  print.add(radar.mounting_pose.roll_rad);
  print.add(static_cast<std::uint64_t>(radar.profile));
  print.add(static_cast<std::uint64_t>(radar.sensor_id));
  print.add(radar.mapping);
  return print.value();
}

}  // namespace

Identity identity_of(const VehicleConfig& vehicle) {
  Identity identity;
  Fingerprint name;
  name.add(std::string_view(vehicle.name));
  identity.vehicle = name.value();
  identity.number_of_radars = std::min(vehicle.radars.size(), identity.radars.size());
  for (std::size_t i = 0; i < identity.number_of_radars; ++i) {
    identity.radars[i] = {vehicle.radars[i].id, fingerprint_of(vehicle.radars[i])};
  }
  return identity;
}

}  // namespace boresight::alignment
