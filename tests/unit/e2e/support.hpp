// Every profile in every mode, and messages to protect with them.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "services/common/e2e/profile.hpp"

namespace boresight::e2e::test {

struct Named {
  std::string name;
  Config config;
};

/// All profiles and modes, with identifiers whose bytes all differ.
inline std::vector<Named> all_configs(std::uint32_t offset_bytes = 0) {
  std::vector<Named> all;
  const auto add = [&](std::string name, Profile profile, std::uint32_t id, DataIdMode mode = DataIdMode::kBoth) {
    Config config;
    config.profile = profile;
    config.data_id = id;
    config.data_id_mode = mode;
    config.offset_bytes = offset_bytes;
    for (std::size_t i = 0; i < config.data_id_list.size(); ++i) {
      config.data_id_list[i] = static_cast<std::uint8_t>(i + 1);
    }
    all.push_back({name + " at " + std::to_string(offset_bytes), config});
  };
  add("P01 both", Profile::kP01, 0x5A3C, DataIdMode::kBoth);
  add("P01 alternating", Profile::kP01, 0x5A3C, DataIdMode::kAlternating);
  add("P01 low", Profile::kP01, 0x5A3C, DataIdMode::kLow);
  add("P01 nibble", Profile::kP01, 0xA3C, DataIdMode::kNibble);
  add("P02", Profile::kP02, 0);
  add("P04", Profile::kP04, 0x0A1B2C3D);
  add("P05", Profile::kP05, 0x5A3C);
  add("P06", Profile::kP06, 0x5A3C);
  add("P07", Profile::kP07, 0x0A1B2C3D);
  add("P11 both", Profile::kP11, 0x5A3C, DataIdMode::kBoth);
  add("P11 nibble", Profile::kP11, 0xA3C, DataIdMode::kNibble);
  add("P22", Profile::kP22, 0);
  return all;
}

inline std::vector<std::uint8_t> random_bytes(std::size_t size, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(generator());
  return bytes;
}

}  // namespace boresight::e2e::test
