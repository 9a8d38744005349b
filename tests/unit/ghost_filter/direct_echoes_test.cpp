// The detections of a scan by direction: all that may lie in front of another one are found.
#include "services/ghost_filter/core/classify/direct_echoes.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::ghosts {

namespace {

DirectEcho echo_at(double azimuth_rad, std::uint32_t index) {
  DirectEcho echo{};
  echo.direction = {std::cos(azimuth_rad), std::sin(azimuth_rad)};
  echo.index = index;
  return echo;
}

}  // namespace

TEST(DirectEchoes, AllWithinTheAngleAreFoundOnce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> azimuth(-3.14159, 3.14159);
  DirectEchoes echoes(200);
  std::vector<double> at;
  for (std::uint32_t i = 0; i < 200; ++i) {
    at.push_back(azimuth(random));
    echoes.add(echo_at(at.back(), i));
  }
  for (const double angle : {0.0, 0.01, 0.2, 1.0, 3.2, 1e9}) {
    for (int run = 0; run < 200; ++run) {
      const double middle = azimuth(random);
      std::vector<int> times(at.size(), 0);
      echoes.near({std::cos(middle), std::sin(middle)}, angle, [&](const DirectEcho& e) { ++times[e.index]; });
      for (std::size_t i = 0; i < at.size(); ++i) {
        const double off = std::abs(std::remainder(at[i] - middle, 2.0 * M_PI));
        EXPECT_LE(times[i], 1);
        if (off > angle || off > 3.0) continue;
        EXPECT_EQ(times[i], 1) << off << " of " << angle;
      }
    }
  }
}

TEST(DirectEchoes, AreForgottenAndBounded) {
  DirectEchoes echoes(2);
  for (std::uint32_t i = 0; i < 5; ++i) echoes.add(echo_at(0.1, i));
  std::size_t found = 0;
  echoes.near({1.0, 0.1}, 0.1, [&](const DirectEcho&) { ++found; });
  EXPECT_EQ(found, 2U);
  echoes.clear();
  echoes.near({1.0, 0.1}, 0.1, [&](const DirectEcho&) { ++found; });
  EXPECT_EQ(found, 2U);
}

}  // namespace boresight::ghosts
