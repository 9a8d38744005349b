// The shipped file has the defaults, and each key has a place of its own.
#include "services/ingest_gateway/config.hpp"

#include <array>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace boresight::ingest {
namespace {

using Key = std::pair<const char*, double ContradictionConfig::*>;
using C = ContradictionConfig;
constexpr std::array<Key, 12> kKeys{{{"least_speed_mps", &C::least_speed_mps},
                                     {"fastest_reverse_mps", &C::fastest_reverse_mps},
                                     {"scene_s", &C::scene_s},
                                     {"seen_again", &C::seen_again},
                                     {"false_alarm", &C::false_alarm},
                                     {"false_return", &C::false_return},
                                     {"memory_s", &C::memory_s},
                                     {"prior_s", &C::prior_s},
                                     {"sigma", &C::sigma},
                                     {"usual_share", &C::usual_share},
                                     {"least_share", &C::least_share},
                                     {"few_detections", &C::few_detections}}};

ContradictionConfig read(const std::string& text) {
  return read_config(config::Reader::parse(text, "ingest_gateway.toml")).contradiction;
}

TEST(IngestConfig, TheShippedFileHasTheDefaults) {
  const ContradictionConfig expected;
  const ContradictionConfig shipped = read_config(config::Reader::open(std::filesystem::path(BORESIGHT_SOURCE_DIR) /
                                                                       "config/services/ingest_gateway.toml"))
                                          .contradiction;
  for (const auto& [name, member] : kKeys) EXPECT_EQ(shipped.*member, expected.*member) << name;
}

TEST(IngestConfig, EveryKeyIsReadIntoItsPlace) {
  for (const auto& [name, member] : kKeys) {
    const double other = 0.9 * (ContradictionConfig().*member);
    std::ostringstream line;
    line.precision(17);
    line << "[contradiction]\n" << name << " = " << std::showpoint << other << "\n";
    const ContradictionConfig changed = read(line.str());
    for (const auto& [each, place] : kKeys) {
      EXPECT_EQ(changed.*place, each == name ? other : ContradictionConfig().*place) << name << ' ' << each;
    }
  }
}

TEST(IngestConfig, ALeastShareAboveTheUsualOneIsRefused) {
  EXPECT_THROW(read("[contradiction]\nleast_share = 0.5"), config::Error);
  EXPECT_NO_THROW(read("[contradiction]\nleast_share = 0.5\nusual_share = 0.6"));
}

}  // namespace
}  // namespace boresight::ingest
