// A tracker by name over scans of two radars, for tests of what every tracker must do.
#pragma once

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {

/// A rectangular object that drives straight ahead; its detections lie anywhere in it.
struct Moving {
  Eigen::Vector2d position_m, velocity_mps;
  double length_m = 4.0, width_m = 1.7;

  [[nodiscard]] Moving after(double time_s) const {
    return {position_m + time_s * velocity_mps, velocity_mps, length_m, width_m};
  }
};

class AnyTracker : public testing::TestWithParam<std::string> {
 protected:
  AnyTracker() { std::memset(static_cast<void*>(list_.get()), 0xCD, sizeof(TrackList)); }

  [[nodiscard]] static std::unique_ptr<MultiObjectTracker> made(const Config& config = {}) {
    return make_tracker(GetParam(), two_radars(), config);
  }
  const TrackList& list() {
    tracker_->write(*list_);
    return *list_;
  }
  /// Detections of an object, three by default.
  void add(const Moving& object, double moving_probability = 1.0, int detections = 3) {
    std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
    std::normal_distribution<double> noise(0.0, 0.1);
    const Eigen::Vector2d along = object.velocity_mps.normalized(), across(-along.y(), along.x());
    for (int k = 0; k < detections; ++k) {
      const double a = object.length_m * anywhere(random_), b = object.width_m * anywhere(random_);
      const double x = noise(random_), y = noise(random_);
      scene_.add(object.position_m + a * along + b * across + Eigen::Vector2d(x, y), object.velocity_mps,
                 Provenance::kMoving, 1.0 - moving_probability);
    }
  }
  /// One scan of radar 1 with that object, 50 ms after the one before.
  StepResult step(const Moving& object, int detections = 3) {
    scene_.begin(now_);
    add(object, 1.0, detections);
    return take();
  }
  StepResult step_empty(std::uint32_t radar = 1) {
    scene_.begin(now_, radar);
    return take();
  }
  /// Two vehicles, one of which approaches, keep one identity each; they have a second to be confirmed.
  void expect_two_identities(const Moving& one, const Moving& other, int scans) {
    std::map<bool, std::set<std::uint32_t>> ids;  // by whether the vehicle approaches
    for (int i = 0; i < scans; ++i) {
      scene_.begin(now_);
      add(one.after(kScan_s * i));
      add(other.after(kScan_s * i));
      take();
      if (i < 20) continue;
      EXPECT_EQ(list().number_of_confirmed_tracks, 2u) << i;
      for (std::size_t k = 0; k < list_->number_of_confirmed_tracks; ++k) {
        ids[list_->tracks[k].velocity_over_ground_mps[0] < 0.0F].insert(list_->tracks[k].tracking_id);
      }
    }
    EXPECT_EQ(ids[false].size(), 1u);
    EXPECT_EQ(ids[true].size(), 1u);
  }
  StepResult take() {
    const StepResult result = tracker_->step(*scene_.scan);
    now_ += kScan_ms * kMillisecond;
    return result;
  }
  /// `scans` scans of one object, from its place now; returns where it is in the last one.
  Moving drive(Moving object, int scans) {
    for (int i = 0; i < scans; ++i) {
      if (i > 0) object = object.after(kScan_s);
      step(object);
    }
    return object;
  }
  /// The confirmed track nearest to a place.
  [[nodiscard]] const Track* nearest(const Eigen::Vector2d& place_m) {
    const TrackList& tracks = list();
    const auto distance = [&place_m](const Track& t) {
      return (Eigen::Vector2d(t.position_vehicle_m[0], t.position_vehicle_m[1]) - place_m).norm();
    };
    const auto end = tracks.tracks.begin() + tracks.number_of_confirmed_tracks;
    const auto found = std::min_element(
        tracks.tracks.begin(), end, [&distance](const Track& a, const Track& b) { return distance(a) < distance(b); });
    return found == end ? nullptr : &*found;
  }

  static constexpr int kScan_ms = 50;
  static constexpr double kScan_s = 1e-3 * kScan_ms;
  std::mt19937_64 random_{7};
  std::unique_ptr<MultiObjectTracker> tracker_ = made();
  Scene scene_;
  std::unique_ptr<TrackList> list_ = std::make_unique<TrackList>();
  std::int64_t now_ = 1'000'000 * kMillisecond;
};

inline const Moving kCarAhead{{30.0, 0.0}, {8.0, 0.0}};

}  // namespace boresight::tracking
