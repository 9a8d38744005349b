// The signals in the project's code agree with the public DBC file.
#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "interfaces/wire/toyota.hpp"
#include "tests/golden/support/decoded.hpp"

namespace boresight::golden {
namespace {

struct Signal {
  int start = 0, length = 0;
  bool motorola = false, is_signed = false;
  double factor = 0.0, offset = 0.0;
};

/// Every signal of a DBC file by (message id, name).
std::map<std::pair<std::uint32_t, std::string>, Signal> read_dbc(const std::filesystem::path& file) {
  std::map<std::pair<std::uint32_t, std::string>, Signal> signals;
  std::uint32_t id = 0;
  std::ifstream input(file);
  for (std::string line; std::getline(input, line);) {
    std::array<char, 64> name{};
    Signal s;
    int order = 0;
    char sign = '+';
    static_cast<void>(std::sscanf(line.c_str(), "BO_ %u", &id));
    const int read = std::sscanf(line.c_str(), " SG_ %63s : %d|%d@%d%c (%lf,%lf)", name.data(), &s.start, &s.length,
                                 &order, &sign, &s.factor, &s.offset);
    if (read != 7) continue;
    s.motorola = order == 0;
    s.is_signed = sign == '-';
    signals[{id, name.data()}] = s;
  }
  return signals;
}

void expect_same(const Signal& reference, const wire::CanSignal& ours, std::uint32_t id) {
  EXPECT_EQ(ours.start_bit, reference.start) << ours.name << " of " << id;
  EXPECT_EQ(ours.length, reference.length) << ours.name << " of " << id;
  EXPECT_EQ(ours.order == wire::ByteOrder::kMotorola, reference.motorola) << ours.name << " of " << id;
  EXPECT_EQ(ours.is_signed, reference.is_signed) << ours.name << " of " << id;
  EXPECT_DOUBLE_EQ(ours.factor, reference.factor) << ours.name << " of " << id;
  EXPECT_DOUBLE_EQ(ours.offset, reference.offset) << ours.name << " of " << id;
}

TEST(ToyotaDbc, RadarSignalsAreThoseOfTheFile) {
  const auto file = shared_data() / "opendbc_radar/toyota_adas.dbc";
  REQUIRE_RECORDING(file);
  const auto reference = read_dbc(file);
  namespace layout = wire::toyota;
  for (std::uint32_t slot = 0; slot < layout::kNumberOfTracks; ++slot) {
    const std::uint32_t a = layout::kTrackA + slot, b = layout::kTrackB + slot;
    for (const wire::CanSignal& ours : {layout::kCounter, layout::kLongitudinalDistance_m, layout::kLateralDistance_m,
                                        layout::kNewTrack, layout::kRelativeSpeed_mps, layout::kValid}) {
      const auto found = reference.find({a, std::string(ours.name)});
      ASSERT_NE(found, reference.end()) << ours.name << " of " << a;
      expect_same(found->second, ours, a);
    }
    const auto score = reference.find({b, std::string(layout::kScore_percent.name)});
    ASSERT_NE(score, reference.end()) << b;
    expect_same(score->second, layout::kScore_percent, b);
  }
}

TEST(ToyotaDbc, EgoSignalsAreThoseOfTheFile) {
  const auto file = shared_data() / "opendbc_radar/toyota_2017_ref_pt.dbc";
  REQUIRE_RECORDING(file);
  const auto reference = read_dbc(file);
  namespace layout = wire::toyota;
  const auto compare = [&](std::uint32_t id, const wire::CanSignal& ours) {
    const auto found = reference.find({id, std::string(ours.name)});
    ASSERT_NE(found, reference.end()) << ours.name << " of " << id;
    expect_same(found->second, ours, id);
  };
  compare(layout::kYawRateId, layout::kYawRate_degps);
  compare(layout::kSteeringId, layout::kSteeringAngle_deg);
  compare(layout::kSteeringId, layout::kSteeringFraction_deg);
  for (const wire::CanSignal& wheel : {layout::kWheelFrontRight_kmph, layout::kWheelFrontLeft_kmph,
                                       layout::kWheelRearRight_kmph, layout::kWheelRearLeft_kmph}) {
    compare(layout::kWheelSpeedsId, wheel);
  }
}

}  // namespace
}  // namespace boresight::golden
