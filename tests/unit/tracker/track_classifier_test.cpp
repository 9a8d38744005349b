#include "services/tracker/core/classes/track_classifier.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "interfaces/messages/radar_scan.hpp"
#include "services/tracker/config.hpp"

namespace boresight::tracking::track_classifier_test {
namespace {

namespace fs = std::filesystem;
using extended_object::RoadUserClass;

constexpr double kScan_s = 0.025;

const ObjectForest& shipped() {
  static const ObjectForest forest = read_forest(fs::path(BORESIGHT_SOURCE_DIR) / "config/services/object_forest.csv");
  return forest;
}

double share(const ClassProbabilities& p, RoadUserClass of) {
  return p[static_cast<std::size_t>(of)];
}

/// An object that passes a sensor at the origin, as the tables of measured radars describe it.
struct Made {
  double length_m, width_m, speed_mps, detections, strength_db, range_rate_std_mps;
};

ClassProbabilities classified(const Made& made, const TrackClassifier& classifier, double duration_s = 4.0) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  std::normal_distribution<double> gaussian;
  std::poisson_distribution<int> number(made.detections);
  ClassEvidence evidence;
  for (double t_s = 0.0; t_s < duration_s; t_s += kScan_s) {
    TrackObservation scan;
    scan.position_m = {20.0 + 0.2 * made.speed_mps * t_s, 4.0};
    scan.velocity_mps = {made.speed_mps, 0.0};
    scan.elapsed_s = kScan_s;
    std::vector<ClusterPoint> points(static_cast<std::size_t>(number(random)));
    for (ClusterPoint& p : points) {
      p.position_m = scan.position_m + Vector2<double>{made.length_m * unit(random), made.width_m * unit(random)};
      p.range_m = std::sqrt(squared_norm(p.position_m));
      p.sight = (1.0 / p.range_m) * p.position_m;
      p.range_rate_mps = dot(p.sight, scan.velocity_mps) + made.range_rate_std_mps * gaussian(random);
      p.strength_db = made.strength_db + 7.0 * gaussian(random);
    }
    scan.points = points;
    classifier.add(evidence, scan);
  }
  return classifier.probabilities(evidence);
}

constexpr Made kPedestrian{0.5, 0.5, 1.4, 0.9, 3.0, 0.3};
constexpr Made kTruck{12.0, 2.5, 15.0, 3.5, 16.0, 0.05};

TEST(TrackClassifier, KnowsAPedestrianFromATruck) {
  const TrackClassifier classifier(shipped(), 1);
  const ClassProbabilities walks = classified(kPedestrian, classifier), drives = classified(kTruck, classifier);
  EXPECT_GT(share(walks, RoadUserClass::kPedestrian), 0.7);
  EXPECT_LT(share(walks, RoadUserClass::kTruck), 0.05);
  EXPECT_GT(share(drives, RoadUserClass::kTruck), 0.5);
  EXPECT_LT(share(drives, RoadUserClass::kPedestrian), 0.05);
}

TEST(TrackClassifier, ProbabilitiesSumToOne) {
  const TrackClassifier classifier(shipped(), 1);
  for (const Made& made : {kPedestrian, kTruck}) {
    const ClassProbabilities p = classified(made, classifier);
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-9);
  }
}

TEST(TrackClassifier, IsThePriorBeforeTheFirstDetection) {
  const ClassProbabilities prior{0.1, 0.2, 0.3, 0.1, 0.3};
  EXPECT_EQ(TrackClassifier(shipped(), 1, prior).probabilities({}), prior);
  EXPECT_EQ(TrackClassifier(ObjectForest{}, 1).probabilities({}), ForestTable{}.prior_share);
}

TEST(TrackClassifier, PriorShiftWeighsTheProbabilities) {
  ClassProbabilities prior = shipped().table.prior_share;
  prior[0] *= 0.5;
  prior[4] += prior[0];
  const ClassProbabilities before = classified(kPedestrian, TrackClassifier(shipped(), 1), 0.3);
  const ClassProbabilities after = classified(kPedestrian, TrackClassifier(shipped(), 1, prior), 0.3);
  // Odds of two classes change by the ratio of their shifts.
  EXPECT_NEAR((after[0] / after[1]) / (before[0] / before[1]), 0.5, 1e-9);
}

TEST(TrackClassifier, ShippedTableIsSmall) {
  EXPECT_LE(shipped().table.trees.size(), 50U);
  EXPECT_LE(fs::file_size(fs::path(BORESIGHT_SOURCE_DIR) / "config/services/object_forest.csv"), 300'000U);
  EXPECT_EQ(shipped().evidence.memory_s, ClassEvidenceParameters{}.memory_s);
}

TEST(TrackClassifier, WrongTableIsNamedWithItsLine) {
  const fs::path file = fs::path(testing::TempDir()) / "wrong_forest.csv";
  std::ofstream(file) << "version,1\nclasses,car\n";
  try {
    static_cast<void>(read_forest(file));
    FAIL();
  } catch (const config::Error& error) {
    EXPECT_NE(std::string(error.what()).find("wrong_forest.csv:2: "), std::string::npos) << error.what();
  }
  fs::remove(file);
}

class Levels : public testing::Test {
 protected:
  /// A scan with stationary detections of one strength at one range.
  void learn(double range_m, double rcs_dbsm, std::size_t number, std::uint16_t flags = corrected_flag::kStationary) {
    scan_->fields = scan_field::kRcs;
    scan_->header.measurement_time_ns += 50'000'000;
    scan_->number_of_valid_detections = static_cast<std::uint32_t>(number);
    for (std::size_t i = 0; i < number; ++i) {
      scan_->range_m[i] = static_cast<float>(range_m);
      scan_->rcs_dbsm[i] = static_cast<float>(rcs_dbsm);
      scan_->detection_flags[i] = flags;
    }
    levels_.learn(*scan_, 0);
  }
  std::unique_ptr<ClassifiedScan> scan_ = std::make_unique<ClassifiedScan>();
  RadarLevels levels_{2, {}};
};

TEST_F(Levels, AreThoseOfTheStationaryWorldByRange) {
  for (int i = 0; i < 100; ++i) {
    learn(15.0, -12.0, 20);
    learn(60.0, -2.0, 20);
    learn(15.0, 30.0, 20, corrected_flag::kMoving);
    learn(15.0, 30.0, 20, corrected_flag::kStationary | corrected_flag::kWeak);
  }
  EXPECT_NEAR(levels_.strength_db(0, 15.0, 0.0), 12.0, 0.2);
  EXPECT_NEAR(levels_.strength_db(0, 60.0, 0.0), 2.0, 0.2);
}

TEST_F(Levels, ShiftOfTheScaleChangesNothing) {
  learn(15.0, -12.0, 20);
  const double before = levels_.strength_db(0, 15.0, 3.0);
  levels_.clear();
  learn(15.0, -2.0, 20);
  EXPECT_NEAR(levels_.strength_db(0, 15.0, 13.0), before, 1e-6);
}

TEST_F(Levels, AreUnknownBeforeTheFirstDetectionAndWithoutTheQuantity) {
  EXPECT_TRUE(std::isnan(levels_.strength_db(0, 15.0, 0.0)));
  learn(15.0, -12.0, 20);
  EXPECT_TRUE(std::isnan(levels_.strength_db(1, 15.0, 0.0)));
  EXPECT_TRUE(std::isnan(levels_.strength_db(2, 15.0, 0.0)));
  EXPECT_TRUE(std::isnan(levels_.snr_db(0, 15.0, 0.0)));
}

TEST_F(Levels, FollowAChange) {
  for (int i = 0; i < 200; ++i) learn(15.0, -12.0, 20);
  for (int i = 0; i < 1000; ++i) learn(15.0, -2.0, 20);
  EXPECT_NEAR(levels_.strength_db(0, 15.0, 0.0), 2.0, 0.2);
}

}  // namespace
}  // namespace boresight::tracking::track_classifier_test
