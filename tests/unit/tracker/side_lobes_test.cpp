// Side lobes through a whole tracker: a truck with weaker detections of its own range and range rate at other azimuths,
// and vehicles that drive abreast.
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

class SideLobes : public testing::TestWithParam<std::string> {
 protected:
  void begin(bool states_strength, std::uint32_t radar = 1) {
    scene_.begin(now_ns_, radar, kSpeed_mps);
    if (states_strength) scene_.scan->fields |= scan_field::kRcs;
    now_ns_ += 50 * kMillisecond;
  }
  /// A vehicle ahead at the speed of the own one, its rear at `rear_m`.
  void add_vehicle(const Eigen::Vector2d& rear_m, double length_m, double strength_dbsm, unsigned detections) {
    for (unsigned k = 0; k < detections; ++k) {
      const Eigen::Vector2d off(length_m * std::abs(normal_(random_)) / 2.0, 0.6 * normal_(random_));
      const Eigen::Vector2d sight = (rear_m + off - Eigen::Vector2d(3.6, 0.0)).normalized();
      add(rear_m + off, kSpeed_mps * sight.x(), strength_dbsm);
    }
  }
  /// An echo at another azimuth with the range and the range rate relative to the sensor of its object.
  void add_side_lobe(double range_m, double azimuth_rad, double range_rate_mps, double strength_dbsm) {
    const double at_rad = azimuth_rad + 0.005 * normal_(random_), at_m = range_m + 0.1 * normal_(random_);
    add({3.6 + at_m * std::cos(at_rad), at_m * std::sin(at_rad)}, range_rate_mps + kSpeed_mps * std::cos(at_rad),
        strength_dbsm);
  }
  void add(const Eigen::Vector2d& at_m, double range_rate_over_ground_mps, double strength_dbsm) {
    const std::uint32_t i = scene_.scan->number_of_valid_detections;
    scene_.add(at_m, {0.0, 0.0});
    scene_.scan->range_rate_over_ground_mps[i] =
        static_cast<float>(range_rate_over_ground_mps + 0.05 * normal_(random_));
    scene_.scan->rcs_dbsm[i] = static_cast<float>(strength_dbsm + 4.0 * normal_(random_));
  }
  /// Tracks after the scan that are likelier than that.
  unsigned tracks(double existence) {
    static_cast<void>(tracker_->step(*scene_.scan));
    tracker_->write(*list_);
    unsigned likely = 0;
    for (std::uint32_t i = 0; i < list_->number_of_tracks; ++i) {
      likely += list_->tracks[i].existence_probability >= static_cast<float>(existence) ? 1U : 0U;
    }
    return likely;
  }
  /// Scans of 5 s after the first second in which a truck with side lobes is the one likely track.
  int scans_with_truck_alone(bool states_strength) {
    int alone = 0;
    for (int k = 0; k < 120; ++k) {
      begin(states_strength);
      add_vehicle({60.0, 0.0}, 3.0, 10.0, 5);
      for (const double azimuth_deg : {-20.0, -11.0, -6.0, 6.0, 11.0, 20.0}) {
        if (uniform_(random_) < 0.7) add_side_lobe(56.4, azimuth_deg * kRadiansPerDegree, 0.0, -5.0);
      }
      alone += tracks(kConfirmed) == 1 && k >= 20 ? 1 : 0;
    }
    return alone;
  }
  /// Scans of 5 s after the first second in which both of two vehicles abreast are likely.
  int scans_with_both(double strength_dbsm, double other_dbsm, bool states_strength, unsigned most_detections) {
    int both = 0;
    for (int k = 0; k < 120; ++k) {
      begin(states_strength);
      add_vehicle({25.0, -1.8}, 1.0, strength_dbsm, 1 + static_cast<unsigned>(random_() % most_detections));
      add_vehicle({25.3, 1.8}, 1.0, other_dbsm, 1 + static_cast<unsigned>(random_() % most_detections));
      both += tracks(kConfirmed) == 2 && k >= 20 ? 1 : 0;
    }
    return both;
  }

  static constexpr double kSpeed_mps = 15.0, kConfirmed = 0.9;
  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_{0.0, 1.0};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  std::unique_ptr<MultiObjectTracker> tracker_ = make_tracker(GetParam(), two_radars(), {});
  Scene scene_;
  std::unique_ptr<TrackList> list_ = std::make_unique<TrackList>();
  std::int64_t now_ns_ = 1'000'000 * kMillisecond;
};

TEST_P(SideLobes, OfATruckAreNoVehicles) {
  EXPECT_GE(scans_with_truck_alone(true), 99) << "of 100";
}

TEST_P(SideLobes, OfUnknownStrengthAreNoVehicles) {
  EXPECT_GE(scans_with_truck_alone(false), 95) << "of 100";
}

TEST_P(SideLobes, CarsOfLikeStrengthAbreastAreBothConfirmed) {
  EXPECT_GE(scans_with_both(2.0, 0.0, true, 3), 95) << "of 100";
}

TEST_P(SideLobes, CarsAbreastOfUnknownStrengthAreBothConfirmed) {
  EXPECT_GE(scans_with_both(2.0, 0.0, false, 3), 95) << "of 100";
}

TEST_P(SideLobes, WeakCarBesideAStrongOneIsConfirmed) {
  EXPECT_GE(scans_with_both(10.0, 0.0, true, 3), 90) << "of 100";
}

TEST_P(SideLobes, OfATurnedRadarAreNoVehicles) {
  // On the left a vehicle keeps pace and drives away from the lane. Range rates over ground of its side lobes are far
  // from its own: only those relative to the sensor are the same.
  constexpr double kAway_mps = 3.0, kLeft_rad = 90.0 * kRadiansPerDegree;
  const Eigen::Vector2d sensor_m(3.6, 0.0), velocity_mps(kSpeed_mps, kAway_mps);
  int alone = 0;
  for (int k = 0; k < 120; ++k) {
    const double range_m = 40.0 + 0.05 * k * kAway_mps;
    begin(true, 2);
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector2d off(0.8 * normal_(random_), std::abs(normal_(random_)));
      const Eigen::Vector2d at_m = sensor_m + Eigen::Vector2d(0.0, range_m) + off;
      add(at_m, (at_m - sensor_m).normalized().dot(velocity_mps), 8.0);
    }
    for (const double off_deg : {-25.0, -15.0, 15.0, 25.0}) {
      if (uniform_(random_) < 0.7) add_side_lobe(range_m, kLeft_rad + off_deg * kRadiansPerDegree, kAway_mps, -7.0);
    }
    alone += tracks(kConfirmed) == 1 && k >= 20 ? 1 : 0;
  }
  EXPECT_GE(alone, 99) << "of 100";
}

INSTANTIATE_TEST_SUITE_P(Trackers, SideLobes, testing::ValuesIn(tracker_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace boresight::tracking
