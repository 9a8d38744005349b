#include "services/tracker/core/classes/class_evidence.hpp"

#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::tracking::class_evidence_test {
namespace {

constexpr double kScan_s = 0.05;

double of(const ClassFeatures& features, ClassFeature feature) {
  return features[static_cast<std::size_t>(feature)];
}

/// A body of 4 × 2 m that drives straight, seen by a sensor at the origin of the axes.
class Drive {
 public:
  explicit Drive(double turn_rad = 0.0) : turn_rad_(turn_rad) {}

  /// A scan with this many detections, at this range.
  TrackObservation scan(std::size_t detections, double range_m = 20.0, double speed_mps = 8.0) {
    std::uniform_real_distribution<double> along(-2.0, 2.0), across(-1.0, 1.0), noise(-0.2, 0.2);
    points_.clear();
    TrackObservation scan;
    scan.position_m = turned({range_m, 3.0});
    scan.velocity_mps = turned({speed_mps * std::cos(kHeading_rad), speed_mps * std::sin(kHeading_rad)});
    scan.heading_rad = kHeading_rad + turn_rad_;
    scan.yaw_rad = -turn_rad_;
    scan.elapsed_s = kScan_s;
    for (std::size_t i = 0; i < detections; ++i) {
      const double x = along(random_), y = across(random_);
      const double c = std::cos(kHeading_rad), s = std::sin(kHeading_rad);
      ClusterPoint& p = points_.emplace_back();
      p.position_m = scan.position_m + turned({c * x - s * y, s * x + c * y});
      p.range_m = std::sqrt(squared_norm(p.position_m));
      p.sight = (1.0 / p.range_m) * p.position_m;
      p.range_rate_mps = dot(p.sight, scan.velocity_mps) + noise(random_);
      p.strength_db = 10.0 + 5.0 * noise(random_);
    }
    scan.points = points_;
    return scan;
  }

 private:
  static constexpr double kHeading_rad = 0.6;
  [[nodiscard]] Vector2<double> turned(const Vector2<double>& v) const {
    const double c = std::cos(turn_rad_), s = std::sin(turn_rad_);
    return {c * v.x - s * v.y, s * v.x + c * v.y};
  }
  double turn_rad_;
  std::mt19937 random_{7};
  std::vector<ClusterPoint> points_;
};

ClassFeatures after(int scans, std::size_t detections, double range_m = 20.0, double turn_rad = 0.0) {
  Drive drive(turn_rad);
  ClassEvidence evidence;
  for (int i = 0; i < scans; ++i) evidence.add(drive.scan(detections, range_m), {});
  return evidence.features();
}

TEST(ClassEvidence, FeaturesHaveDifferentNames) {
  std::set<std::string_view> names;
  for (std::size_t k = 0; k < kClassFeatures; ++k) names.insert(name_of(static_cast<ClassFeature>(k)));
  EXPECT_EQ(names.size(), kClassFeatures);
}

TEST(ClassEvidence, AccumulatesTheSizeThatSingleScansDoNotShow) {
  Drive drive;
  ClassEvidence evidence;
  for (int i = 0; i < 200; ++i) evidence.add(drive.scan(1), {});
  const ClassFeatures f = evidence.features();
  EXPECT_EQ(of(f, ClassFeature::kLength), 0.0);
  // Extremes fade to what the present scans show, so the reach is less than the body's.
  EXPECT_GT(of(f, ClassFeature::kReachAlong), 2.5);
  EXPECT_LE(of(f, ClassFeature::kReachAlong), 4.0);
  EXPECT_GT(of(f, ClassFeature::kReachAcross), 1.25);
  EXPECT_LE(of(f, ClassFeature::kReachAcross), 2.0);
}

TEST(ClassEvidence, SpreadWithinScansIsThatOfTheBody) {
  const ClassFeatures f = after(400, 3);
  EXPECT_NEAR(of(f, ClassFeature::kAlongStd), 4.0 / std::sqrt(12.0), 0.1);
  EXPECT_NEAR(of(f, ClassFeature::kAcrossStd), 2.0 / std::sqrt(12.0), 0.05);
  EXPECT_NEAR(of(f, ClassFeature::kRangeRateResidual), 0.4 / std::sqrt(12.0), 0.02);
  EXPECT_EQ(of(f, ClassFeature::kWideShare), 0.0);
  EXPECT_NEAR(of(f, ClassFeature::kSpeed), 8.0, 1e-9);
  EXPECT_NEAR(of(f, ClassFeature::kStrength), 10.0, 0.1);
}

TEST(ClassEvidence, NumberOfDetectionsIsRelativeToThatExpectedAtTheRange) {
  const ClassEvidenceParameters p;
  Drive drive;
  ClassEvidence evidence;
  evidence.add(drive.scan(2, 60.0), p);
  evidence.add(drive.scan(0, 60.0), p);
  const double range_m = std::hypot(60.0, 3.0), expected = std::pow(range_m / p.count_range_m, -p.count_power);
  EXPECT_NEAR(of(evidence.features(), ClassFeature::kCountRate), 1.0 / expected, 0.02);
  EXPECT_NEAR(of(evidence.features(), ClassFeature::kDetectedShare), 0.5, 0.01);
  EXPECT_NEAR(of(evidence.features(), ClassFeature::kMostCount), 2.0 / expected, 1e-9);
}

TEST(ClassEvidence, ScanThatDoesNotHaveTheObjectInViewIsNoMiss) {
  Drive drive;
  ClassEvidence evidence;
  evidence.add(drive.scan(2), {});
  TrackObservation unseen = drive.scan(0);
  unseen.in_view = 0.1;
  for (int i = 0; i < 10; ++i) evidence.add(unseen, {});
  EXPECT_EQ(of(evidence.features(), ClassFeature::kDetectedShare), 1.0);
}

TEST(ClassEvidence, OldScansFade) {
  Drive drive;
  ClassEvidence evidence;
  for (int i = 0; i < 100; ++i) evidence.add(drive.scan(1, 20.0, 20.0), {});
  for (int i = 0; i < 600; ++i) evidence.add(drive.scan(1, 20.0, 5.0), {});
  const ClassFeatures f = evidence.features();
  EXPECT_NEAR(of(f, ClassFeature::kSpeed), 5.0, 0.1);
  EXPECT_NEAR(of(f, ClassFeature::kLargestSpeed), 20.0, 1e-9);  // of a whole life: what walks was never fast
}

TEST(ClassEvidence, IsTheSameInTurnedAxes) {
  const ClassFeatures straight = after(50, 3);
  for (const double turn_rad : {0.7, 2.5, -1.8}) {
    const ClassFeatures turned = after(50, 3, 20.0, turn_rad);
    for (std::size_t k = 0; k < kClassFeatures; ++k) {
      if (std::isnan(straight[k])) {
        EXPECT_TRUE(std::isnan(turned[k])) << k;
      } else {
        EXPECT_NEAR(turned[k], straight[k], 1e-6) << name_of(static_cast<ClassFeature>(k));
      }
    }
  }
}

TEST(ClassEvidence, IsTheSameWhileTheAxesTurnWithTheVehicle) {
  Drive straight, turning(1.0);
  ClassEvidence still, mixed;
  for (int i = 0; i < 100; ++i) {
    still.add(straight.scan(2), {});
    mixed.add(i % 2 == 0 ? Drive(1.0).scan(0) : turning.scan(0), {});
  }
  EXPECT_NEAR(of(mixed.features(), ClassFeature::kTurnRate), 0.0, 1e-9);
  EXPECT_NEAR(of(still.features(), ClassFeature::kTurnRate), 0.0, 1e-9);
}

TEST(ClassEvidence, WithoutDetectionsOrHeightsFeaturesAreUnknown) {
  const ClassFeatures none = ClassEvidence().features();
  EXPECT_TRUE(std::isnan(of(none, ClassFeature::kSpeed)));
  EXPECT_TRUE(std::isnan(of(none, ClassFeature::kCountRate)));
  const ClassFeatures f = after(20, 2);
  EXPECT_TRUE(std::isnan(of(f, ClassFeature::kHeight)));
  EXPECT_TRUE(std::isnan(of(f, ClassFeature::kVolume)));
  EXPECT_TRUE(std::isnan(of(f, ClassFeature::kSnr)));
}

TEST(ClassEvidence, ValuesThatAreNotFiniteDoNotSpread) {
  Drive drive;
  ClassEvidence evidence;
  for (int i = 0; i < 20; ++i) {
    TrackObservation scan = drive.scan(3);
    std::vector<ClusterPoint> points(scan.points.begin(), scan.points.end());
    points[0].position_m.x = points[1].range_rate_mps = points[2].strength_db = NAN;
    scan.points = points;
    evidence.add(scan, {});
  }
  for (const ClassFeature feature : {ClassFeature::kAlongStd, ClassFeature::kRangeRateResidual, ClassFeature::kStrength,
                                     ClassFeature::kReachAlong, ClassFeature::kWideShare}) {
    EXPECT_TRUE(std::isfinite(of(evidence.features(), feature))) << name_of(feature);
  }
}

TEST(ClassEvidence, AllocatesNothing) {
  Drive drive;
  ClassEvidence evidence;
  const TrackObservation scan = drive.scan(5);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int i = 0; i < 100; ++i) {
      evidence.add(scan, {});
      static_cast<void>(evidence.features());
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::tracking::class_evidence_test
