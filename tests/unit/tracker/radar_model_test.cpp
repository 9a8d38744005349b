// The radar model through its public interface: births, parts, views and learning of tracked objects in made-up scans.
#include "services/tracker/core/model/radar_model.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/tracker/simulated_object.hpp"

namespace boresight::tracking {
namespace {

using extended_object::RoadUserClass;

constexpr double kRadarScan_s = 0.05, kHalfView_rad = 0.9;

struct Echo {
  Eigen::Vector2d position_m;
  double range_rate_mps = 0.0;
  double log_likelihood_ratio{ClassifiedScan::kCertain};
};
struct TrackedObject {
  Component<double> component;
  double existence = 0.99;
};

/// A standing vehicle with one radar at the front, all of it turned by `turn_rad`; objects whose association is known.
class RadarBench {
 public:
  explicit RadarBench(double turn_rad = 0.0)
      : turn_rad_(turn_rad), model(vehicle(turn_rad), RadarModelParameters{}, 32) {
    std::memset(static_cast<void*>(scan_.get()), 0, sizeof(ClassifiedScan));
  }

  /// Echoes in axes before the turn.
  void begin(const std::vector<Echo>& echoes, double elapsed_s = kRadarScan_s) {
    time_s_ += elapsed_s;
    ClassifiedScan& s = *scan_;
    s.header.source_id = 1;
    s.header.measurement_time_ns = static_cast<std::int64_t>(std::llround(time_s_ * 1e9));
    s.number_of_valid_detections = 0;
    const Eigen::Matrix2d turn = support::rotation(turn_rad_);
    s.geometry = {};
    const Eigen::Vector2d sensor = turn * kSensor;
    s.geometry.sensor_position_vehicle_m = {static_cast<float>(sensor.x()), static_cast<float>(sensor.y()), 0.5F};
    s.geometry.sensor_to_vehicle = {static_cast<float>(turn(0, 0)),
                                    static_cast<float>(turn(0, 1)),
                                    0.0F,
                                    static_cast<float>(turn(1, 0)),
                                    static_cast<float>(turn(1, 1)),
                                    0.0F,
                                    0.0F,
                                    0.0F,
                                    1.0F};
    for (const Echo& echo : echoes) {
      const std::uint32_t i = s.number_of_valid_detections++;
      const Eigen::Vector2d at = turn * echo.position_m, sight = at - sensor;
      s.x_vehicle_m[i] = static_cast<float>(at.x());
      s.y_vehicle_m[i] = static_cast<float>(at.y());
      s.range_m[i] = static_cast<float>(sight.norm());
      s.azimuth_vehicle_rad[i] = static_cast<float>(std::atan2(sight.y(), sight.x()));
      s.range_rate_over_ground_mps[i] = static_cast<float>(echo.range_rate_mps);
      s.detection_flags[i] = corrected_flag::kMoving;
      s.set_certain(i, Provenance::kMoving);
      s.moving_log_likelihood_ratio[i] = static_cast<float>(echo.log_likelihood_ratio);
    }
    static_cast<void>(model.begin_scan(s));
    for (TrackedObject& o : objects) static_cast<void>(model.predict(o.component, elapsed_s));
  }
  /// On the spot, before anything is tracked.
  void turn_vehicle(double turn_rad) {
    begin({});
    scan_->geometry.ego_yaw_rate_radps = static_cast<float>(turn_rad);
    time_s_ += 1.0;
    scan_->header.measurement_time_ns = static_cast<std::int64_t>(std::llround(time_s_ * 1e9));
    static_cast<void>(model.begin_scan(*scan_));
  }
  /// Of the echo of the scan, were it alone.
  [[nodiscard]] double log_newborn(std::size_t echo) {
    std::vector<Prediction<double>> predictions;
    std::vector<double> existence;
    for (const TrackedObject& o : objects) {
      predictions.emplace_back(o.component, model.view(o.component));
      existence.push_back(o.existence);
    }
    const Measurement<double>& z = model.measurements()[echo];
    model.begin_group({&z, 1}, predictions, existence);
    Cell<double> cell;
    cell.add(z, std::uint64_t{1});
    return model.log_newborn(cell);
  }
  /// Each object gets the echoes from its first on.
  void end(const std::vector<std::size_t>& first_of) {
    std::vector<ObjectEstimate> estimates;
    std::vector<double> explained(model.measurements().size(), 1.0);
    for (std::size_t k = 0; k < objects.size(); ++k) {
      Component<double>& c = objects[k].component;
      ObjectEstimate e;
      e.id = c.label;
      e.existence = objects[k].existence;
      const std::size_t to = k + 1 < first_of.size() ? first_of[k + 1] : explained.size();
      const auto z = model.measurements().subspan(first_of[k], to - first_of[k]);
      if (!z.empty()) {
        const Cell<double> cell = support::cell_of(z);
        e.detections = cell.n;
        e.detected = true;
        e.scatter = cell.scatter();
        e.mean_m = cell.mean();
        c = Prediction<double>(c, model.view(c)).updated(c, cell);
      }
      e.component = &c;
      estimates.push_back(e);
    }
    model.learn(explained, estimates);
  }

  static inline const Eigen::Vector2d kSensor{3.6, 0.0};
  static Echo echo_of(const Eigen::Vector2d& at, const Eigen::Vector2d& velocity_mps, double off_mps = 0.0) {
    return {at, (at - kSensor).normalized().dot(velocity_mps) + off_mps};
  }

 private:
  static VehicleConfig vehicle(double turn_rad) {
    VehicleConfig v;
    RadarConfig r;
    r.id = 1;
    const Eigen::Vector2d sensor = support::rotation(turn_rad) * kSensor;
    r.mounting_pose = {{sensor.x(), sensor.y(), 0.5}, turn_rad, 0.0, 0.0};
    r.field_of_view.azimuth_min_rad = -kHalfView_rad;
    r.field_of_view.azimuth_max_rad = kHalfView_rad;
    r.field_of_view.range_max_m = 120.0;
    v.radars.push_back(r);
    return v;
  }
  std::unique_ptr<ClassifiedScan> scan_ = std::make_unique<ClassifiedScan>();
  double turn_rad_, time_s_ = 10.0;

 public:
  RadarModel model;
  std::vector<TrackedObject> objects;
};

/// An object whose place and velocity are known as of a track of some seconds.
Component<double> known(std::uint32_t label, const Eigen::Vector2d& at, const Eigen::Vector2d& velocity_mps) {
  Component<double> c;
  c.label = label;
  c.position_m = support::vector_of(at);
  c.velocity_mps = support::vector_of(velocity_mps);
  c.position_covariance = {0.2, 0.0, 0.2};
  c.velocity_covariance = {0.05, 0.0, 0.05};
  c.rate_shape = 8.0;
  c.rate_inverse_scale = 4.0;
  c.extent_dof = 20.0;
  c.extent_scale = {14.0, 0.0, 14.0};
  return c;
}

/// Objects of 4 m/s or more seen for a second: places of each follow its velocity, with two echoes a scan.
void watch(RadarBench& bench, const std::vector<Eigen::Vector2d>& first_m, const std::vector<Eigen::Vector2d>& velocity,
           double existence = 0.99, std::uint64_t seed = 3) {
  support::Random random(seed);
  for (std::size_t k = 0; k < first_m.size(); ++k) {
    bench.objects.push_back({known(static_cast<std::uint32_t>(k + 1), first_m[k], velocity[k]), existence});
  }
  for (int scan = 1; scan <= 20; ++scan) {
    std::vector<Echo> echoes;
    std::vector<std::size_t> first_of;
    for (std::size_t k = 0; k < first_m.size(); ++k) {
      first_of.push_back(echoes.size());
      for (int i = 0; i < 2; ++i) {
        const double x = 0.4 * support::normal(random), y = 0.4 * support::normal(random);
        echoes.push_back(RadarBench::echo_of(first_m[k] + scan * kRadarScan_s * velocity[k] + Eigen::Vector2d(x, y),
                                             velocity[k], 0.05 * support::normal(random)));
      }
    }
    bench.begin(echoes);
    bench.end(first_of);
  }
}
Eigen::Vector2d place_of(const RadarBench& bench, std::size_t object) {
  return support::eigen(bench.objects[object].component.position_m);
}

TEST(RadarModel, BoxesFollowTheTableOfClasses) {
  VehicleConfig vehicle;
  vehicle.radars.emplace_back().id = 1;
  RadarModelParameters parameters;
  const double length_m = RadarModel(vehicle, parameters, 8).box({}).length_m;
  for (auto& c : parameters.classes) c.size.length_mean_m *= 2.0;
  EXPECT_NEAR(RadarModel(vehicle, parameters, 8).box({}).length_m, 2.0 * length_m, 1e-9);
}

TEST(RadarModel, NothingNewIsBornInTheBoxOfAnObject) {
  RadarBench bench;
  const Eigen::Vector2d velocity(8.0, 0.0);
  watch(bench, {{30.0, 2.0}}, {velocity});
  ASSERT_TRUE(bench.model.memory(1)->has_point);
  const Eigen::Vector2d p = place_of(bench, 0) + kRadarScan_s * velocity;
  bench.begin({RadarBench::echo_of(p + Eigen::Vector2d(1.2, 0.3), velocity),
               RadarBench::echo_of(p + Eigen::Vector2d(-6.0, 9.0), velocity)});
  const double in_box = bench.log_newborn(0), beside = bench.log_newborn(1);
  std::printf("  log newborn: in the box %.1f, beside %.1f\n", in_box, beside);
  EXPECT_LT(in_box, beside - 2.0);
  bench.objects[0].existence = 0.0;
  EXPECT_GT(bench.log_newborn(0), in_box + 1.0) << "an object that is unlikely takes no place";
}

TEST(RadarModel, RangeRateOfAMovingPartInTheBoxOfACarIsNoNewObject) {
  const auto log_newborn_at = [](const Eigen::Vector2d& off, double existence) {
    RadarBench bench;
    const Eigen::Vector2d velocity(12.0, 0.0);
    watch(bench, {{6.0, 12.0}}, {velocity}, existence);
    const Eigen::Vector2d p = place_of(bench, 0) + kRadarScan_s * velocity;
    bench.begin({RadarBench::echo_of(p + off, velocity, -4.0)});
    return bench.log_newborn(0);
  };
  const double in_box = log_newborn_at({1.0, 0.2}, 0.99), beside = log_newborn_at({-1.0, 7.0}, 0.99);
  std::printf("  log newborn with a range rate of micro-Doppler: in the box %.1f, beside %.1f\n", in_box, beside);
  EXPECT_LT(in_box, beside - 2.0);
  EXPECT_NEAR(beside, log_newborn_at({-1.0, 7.0}, 0.3), 1.0) << "beside the car it makes no difference";
  EXPECT_LT(in_box, log_newborn_at({1.0, 0.2}, 0.3) - 2.0);
}

TEST(RadarModel, DetectionsOfMovingPartsAreMarked) {
  RadarBench bench;
  const Eigen::Vector2d velocity(12.0, 0.0);
  watch(bench, {{6.0, 12.0}}, {velocity});
  const Eigen::Vector2d p = place_of(bench, 0) + kRadarScan_s * velocity;
  bench.begin({RadarBench::echo_of(p + Eigen::Vector2d(1.0, 0.2), velocity, -4.0),
               RadarBench::echo_of(p + Eigen::Vector2d(-1.0, 7.0), velocity, -4.0)});
  EXPECT_GT(bench.model.measurements()[0].wide_share, 0.5);
  EXPECT_LT(bench.model.measurements()[1].wide_share, 0.05);
  for (const auto& z : bench.model.measurements()) {
    EXPECT_LE(z.wide_share + z.side_lobe_share, 1.0 + 1e-12);
    EXPECT_TRUE(std::isfinite(z.log_clutter));
  }
}

/// Log of the clutter intensity at one echo of a first scan.
double log_clutter_of(double log_likelihood_ratio) {
  RadarBench bench;
  bench.begin({{{30.0, 2.0}, 7.0, log_likelihood_ratio}});
  return bench.model.measurements()[0].log_clutter;
}

TEST(RadarModel, EvidenceForAnObjectLowersTheClutterByItsRatio) {
  const ClutterParameters c;
  const double without = log_clutter_of(0.0);
  for (const double ratio : {-2.5, -0.5, 0.7, 2.0}) {
    EXPECT_NEAR(log_clutter_of(ratio) - without, -c.origin_weight * ratio, 1e-6) << ratio;
  }
}

TEST(RadarModel, EvidenceOfOriginsSaturates) {
  const ClutterParameters c;
  const double without = log_clutter_of(0.0);
  for (const double beyond : {c.origin_limit, 2.0 * c.origin_limit, static_cast<double>(ClassifiedScan::kCertain)}) {
    EXPECT_NEAR(log_clutter_of(beyond - c.origin_offset) - without,
                -c.origin_weight * (c.origin_limit - c.origin_offset), 1e-6);
    EXPECT_NEAR(log_clutter_of(-beyond) - without, c.origin_weight * (c.origin_limit + c.origin_offset), 1e-6);
  }
}

TEST(RadarModel, EvidenceOfOneDetectionDoesNotChangeAnother) {
  for (const double ratio : {-3.0, 0.0, 3.0}) {
    RadarBench bench;
    for (int scan = 0; scan < 20; ++scan) {
      bench.begin({{{30.0, 2.0}, 7.0}, {{50.0, -9.0}, -7.0, ratio}});
      if (scan == 19) break;
      bench.end({});
    }
    static double first = bench.model.measurements()[0].log_clutter;
    EXPECT_NEAR(bench.model.measurements()[0].log_clutter, first, 1e-9) << "no mean of the others counts";
  }
}

TEST(RadarModel, ADetectionWithoutAFiniteRatioIsLeftOut) {
  RadarBench bench;
  bench.begin({{{30.0, 2.0}, 7.0, std::numeric_limits<double>::quiet_NaN()}, {{40.0, 2.0}, 7.0}});
  ASSERT_EQ(bench.model.measurements().size(), 1U);
}

TEST(RadarModel, ObjectsThatOverlapAndMoveAlikeArePartsOfOne) {
  const Eigen::Vector2d velocity(10.0, 0.0);
  const auto log_odds = [&](const Eigen::Vector2d& apart, const Eigen::Vector2d& other_velocity) {
    RadarBench bench;
    watch(bench, {{20.0, 3.0}, Eigen::Vector2d(20.0, 3.0) + apart}, {velocity, other_velocity});
    const Component<double>&a = bench.objects[0].component, &b = bench.objects[1].component;
    return std::max(bench.model.log_odds_of_part(a, b), bench.model.log_odds_of_part(b, a));
  };
  EXPECT_GT(log_odds({1.5, 0.2}, velocity), 0.0);
  EXPECT_LT(log_odds({1.5, 0.2}, {15.0, 0.0}), 0.0) << "they do not move alike";
  EXPECT_LT(log_odds({20.0, 0.0}, velocity), 0.0) << "cars of a queue";
  EXPECT_LT(log_odds({0.0, 3.6}, velocity), 0.0) << "cars side by side";
  EXPECT_LT(log_odds({50.0, 0.0}, velocity), 0.0);
}

TEST(RadarModel, PartsNeedBoxesOfBoth) {
  RadarBench bench;
  watch(bench, {{20.0, 3.0}}, {{10.0, 0.0}});
  const Component<double>& a = bench.objects[0].component;
  EXPECT_EQ(bench.model.log_odds_of_part(a, known(9, {21.0, 3.0}, {10.0, 0.0})),
            -std::numeric_limits<double>::infinity());
}

TEST(RadarModel, JoinedObjectKeepsTheOlderLabel) {
  RadarBench bench;
  watch(bench, {{20.0, 3.0}, {21.5, 3.2}}, {{10.0, 0.0}, {10.0, 0.0}});
  const Eigen::Vector2d point = bench.model.memory(2)->classes[2].point_m;
  bench.model.join(bench.objects[1].component, bench.objects[0].component, 1);
  ASSERT_NE(bench.model.memory(1), nullptr);
  EXPECT_EQ(bench.model.memory(1)->classes[2].point_m, point);
}

TEST(RadarModel, ChanceOfADetectionFollowsTheShareInView) {
  RadarBench bench;
  const Eigen::Vector2d velocity(8.0, 0.0);
  // Too unlikely to have side lobes: its view is computed when it is asked for.
  watch(bench, {{20.0, 2.0}}, {velocity}, 0.4);
  const Component<double> c = bench.objects[0].component;
  double before = 1.0, most = 0.0, least = 1.0, exposure_before = 1e9;
  // The object is moved around the sensor towards the edge of the field of view. A new scan for each place: views are
  // kept for a scan.
  for (double azimuth_rad = 0.0; azimuth_rad < 1.4; azimuth_rad += 0.02) {
    bench.begin({}, 1e-9);
    Component<double> at = c;
    at.position_m =
        support::vector_of(RadarBench::kSensor + 14.0 * Eigen::Vector2d(std::cos(azimuth_rad), std::sin(azimuth_rad)));
    // Range rates by aspect do not matter here: it recedes at any bearing.
    at.velocity_mps = support::vector_of(8.0 * Eigen::Vector2d(std::cos(azimuth_rad), std::sin(azimuth_rad)));
    const View<double> v = bench.model.view(at);
    EXPECT_GE(v.detection_probability, 0.0);
    EXPECT_LE(v.detection_probability, 0.95 + 1e-12);
    // Of any detection at all.
    const double seen = 1.0 - Prediction<double>(at, v).missed();
    EXPECT_LE(seen, before + 1e-3) << azimuth_rad;
    EXPECT_LE(v.exposure, exposure_before * 1.02) << azimuth_rad;
    before = seen;
    exposure_before = v.exposure;
    most = std::max(most, before);
    least = std::min(least, before);
  }
  EXPECT_GT(most, 0.8);
  EXPECT_LT(least, 0.02);
}

TEST(RadarModel, ReadingsAreDistributionsWithPositiveCovariances) {
  RadarBench bench;
  watch(bench, {{20.0, 4.0}}, {{8.0, 1.0}});
  bench.begin({});
  const View<double> v = bench.model.view(bench.objects[0].component);
  double sum = 0.0;
  ASSERT_GE(v.number_of_readings, 1U);
  for (std::size_t k = 0; k < v.number_of_readings; ++k) {
    const Reading<double>& r = v.readings[k];
    sum += r.weight;
    EXPECT_GE(r.covariance_m2.xx, 0.0);
    EXPECT_GE(determinant(r.covariance_m2), -1e-12);
    EXPECT_TRUE(!r.knows_scatter || determinant(r.scatter_m2) > 0.0);
    EXPECT_LT(squared_norm(r.offset_m), 1.0) << "it was seen from here before";
  }
  EXPECT_NEAR(sum, 1.0, 0.01);
}

TEST(RadarModel, EvidenceForClassesDoesNotDependOnTheExistence) {
  RadarBench sure, unsure;
  watch(sure, {{40.0, 4.0}}, {{8.0, 0.0}}, 0.99);
  watch(unsure, {{40.0, 4.0}}, {{8.0, 0.0}}, 0.45);
  for (std::size_t k = 0; k < extended_object::kRoadUserClasses; ++k) {
    EXPECT_NEAR(sure.model.memory(1)->classes[k].log_evidence, unsure.model.memory(1)->classes[k].log_evidence, 1e-9)
        << k;
  }
}

/// The box after a second, and the axes: a scene that is turned with its radar, before a vehicle that is turned.
struct TurnedScene {
  Box box;
  LocalAxes axes;
};
TurnedScene turned_scene(double mount_rad, double vehicle_rad) {
  RadarBench bench(mount_rad);
  bench.turn_vehicle(vehicle_rad);
  const Eigen::Vector2d from(20.0, 4.0), velocity(8.0, 1.0);
  const Eigen::Matrix2d turn = support::rotation(mount_rad + vehicle_rad);
  bench.objects.push_back({known(1, turn * from, turn * velocity), 0.99});
  support::Random random(3);
  for (int scan = 1; scan <= 20; ++scan) {
    std::vector<Echo> echoes;
    for (int i = 0; i < 2; ++i) {
      const double x = 0.4 * support::normal(random), y = 0.4 * support::normal(random);
      echoes.push_back(RadarBench::echo_of(from + scan * kRadarScan_s * velocity + Eigen::Vector2d(x, y), velocity,
                                           0.05 * support::normal(random)));
    }
    bench.begin(echoes);
    bench.end({0});
  }
  return {bench.model.box(bench.objects[0].component), bench.model.axes()};
}

// Most vehicles drive along the road, so a mount is turned by half a turn, and other turns are of the vehicle.
TEST(RadarModel, TurnedMountAndTurnedVehicleGiveTheTurnedBox) {
  const Box b = turned_scene(0.0, 0.0).box;
  for (const auto& [mount_rad, vehicle_rad] :
       {std::pair(std::numbers::pi, 0.0), std::pair(0.0, 1.2), std::pair(std::numbers::pi, -2.0)}) {
    const double turn_rad = mount_rad + vehicle_rad;
    const Eigen::Matrix2d turn = support::rotation(turn_rad);
    const auto [c, axes] = turned_scene(mount_rad, vehicle_rad);
    EXPECT_NEAR(axes.heading_rad, vehicle_rad, 1e-6);
    // Scans hold floats.
    EXPECT_LT((c.centre_m - turn * b.centre_m).norm(), 1e-3) << turn_rad;
    EXPECT_LT((c.covariance_m2 - turn * b.covariance_m2 * turn.transpose()).norm(), 1e-3);
    EXPECT_NEAR(std::remainder(c.heading_rad - b.heading_rad - turn_rad, 2.0 * std::numbers::pi), 0.0, 1e-4);
    EXPECT_NEAR(c.length_m, b.length_m, 1e-3);
  }
}

TEST(RadarModel, ScansOfTrackedObjectsAllocateNothing) {
  RadarBench bench;
  watch(bench, {{20.0, 4.0}, {40.0, -5.0}}, {{8.0, 1.0}, {10.0, 0.0}});
  bench.begin({RadarBench::echo_of({25.0, 4.0}, {8.0, 1.0})});
  const Component<double> c = bench.objects[0].component;
  const Measurement<double> z = bench.model.measurements()[0];
  const std::array explained = {1.0};
  std::array<ObjectEstimate, 1> estimates;
  estimates[0].id = c.label;
  estimates[0].existence = 0.99;
  estimates[0].component = &c;
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    const std::array predictions = {Prediction<double>(c, bench.model.view(c))};
    const std::array existence = {0.99};
    bench.model.begin_group({&z, 1}, predictions, existence);
    Cell<double> cell;
    cell.add(z, std::uint64_t{1});
    static_cast<void>(bench.model.log_newborn(cell));
    static_cast<void>(bench.model.newborn(cell));
    static_cast<void>(bench.model.log_odds_of_part(c, bench.objects[1].component));
    bench.model.learn(explained, estimates);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::tracking
