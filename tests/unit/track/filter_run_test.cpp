// A filter over the table of one object: reading, estimates, errors, figure.
#include "services/boresight/track/filter_run.hpp"

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include <gmock/gmock.h>

#include "services/boresight/score/table.hpp"
#include "services/boresight/track/filter_errors.hpp"
#include "services/boresight/track/filter_figure.hpp"
#include "tests/unit/track/files.hpp"

namespace boresight::track {
namespace {

using ::testing::HasSubstr;
using tracking::filters::FilterKind;

class RadarTables : public ::testing::Test {
 protected:
  testing::Files files_{"track_filter"};

  std::string error_of(std::string_view text) {
    try {
      (void)read_radar_measurements(files_.write("radar.csv", text));
    } catch (const score::InputError& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(RadarTables, AreReadWithAndWithoutTruth) {
  const RadarMeasurements without = read_radar_measurements(
      files_.write("a.csv", "radial_speed,k,range,azimuth_rad,note\n-3,4,20.5,0.1,0\n-2.5,6,20,-0.2,0\n"));
  ASSERT_EQ(without.rows.size(), 2U);
  EXPECT_EQ(without.rows[1].step, 6);
  EXPECT_EQ(without.rows[0].range_m, 20.5);
  EXPECT_EQ(without.rows[1].azimuth_rad, -0.2);
  EXPECT_EQ(without.rows[0].range_rate_mps, -3.0);
  EXPECT_TRUE(without.truth.empty());
  const RadarMeasurements with = read_radar_measurements(files_.write(
      "b.csv", "k,range,azimuth_rad,radial_speed,tx,tvx,tax,ty,tvy,tay\n0,1,0,0,1,2,3,4,5,6\n1,1,0,0,1,2,3,4,5,7\n"));
  ASSERT_EQ(with.truth.size(), 2U);
  EXPECT_EQ(with.truth[1](2), 3.0);
  EXPECT_EQ(with.truth[1](5), 7.0);
}

TEST_F(RadarTables, ErrorsNameFileLineColumnAndAllowedValues) {
  const std::string header = "k,range,azimuth_rad,radial_speed\n";
  EXPECT_THAT(error_of("k,range,azimuth_rad\n0,1,0\n"),
              HasSubstr("radar.csv:1: the header lacks the column radial_speed"));
  EXPECT_THAT(error_of(header + "0,1,0,0\n1,-2,0,0\n"), HasSubstr("radar.csv:3: range: read \"-2\""));
  EXPECT_THAT(error_of(header + "0,1,4,0\n"),
              HasSubstr("radar.csv:2: azimuth_rad: read \"4\", allowed is a number -3.14159"));
  EXPECT_THAT(error_of(header + "3,1,0,0\n3,1,0,0\n"),
              HasSubstr("radar.csv:3: k: read \"3\", allowed is more than 3, the step of the row before"));
  EXPECT_THAT(error_of(header + "0,1,0,0\n"), HasSubstr("has 1 rows of measurements"));
  EXPECT_THAT(error_of("k,range,azimuth_rad,radial_speed,tx,tvx\n0,1,0,0,0,0\n"),
              HasSubstr("the header lacks the column tax; a true state has the columns tx,tvx,tax,ty,tvy,tay"));
}

/// Two microseconds go by from each reading to the next.
std::int64_t made_clock() {
  static std::int64_t time_ns = 0;
  return time_ns += 2000;
}

/// An object that passes beside the radar, with the noise of the published test; every seventh step is missing.
RadarMeasurements crossing() {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  RadarMeasurements measurements;
  for (std::int64_t k = 10; k < 210; ++k) {
    if (k % 7 == 3) continue;
    const double t = 0.05 * static_cast<double>(k);
    ObjectState truth;
    truth << 25.0 - t, -1.0, 0.0, -20.0 + 4.0 * t, 4.0, 0.0;
    const Eigen::Vector3d seen = seen_from_origin(truth);
    measurements.rows.push_back(
        {k, seen(0) + normal(random), seen(1) + kRadiansPerDegree * normal(random), seen(2) + 0.05 * normal(random)});
    measurements.truth.push_back(truth);
  }
  return measurements;
}

TEST(FilterRuns, OfEachKindImproveTheMeasurements) {
  const RadarMeasurements measurements = crossing();
  for (const std::string_view name : tracking::filters::filter_kind_names()) {
    const FilterRun run = run_filter(*tracking::filters::filter_kind(name), measurements, {}, 2, made_clock);
    EXPECT_FALSE(run.refused_row) << name;
    EXPECT_TRUE(run.is_repeatable) << name;
    ASSERT_EQ(run.estimates.size(), measurements.rows.size() - 1) << name;
    EXPECT_NEAR(run.mean_cpu_us, 2.0 / static_cast<double>(run.estimates.size()), 1e-12) << name;
    const FilterErrors errors = filter_errors(measurements, run, 20);
    EXPECT_EQ(errors.steps, 153U) << name;
    EXPECT_NEAR(errors.measured(0), 1.0, 0.2) << name;
    EXPECT_LT(errors.filtered(0), 0.3 * errors.measured(0)) << name;
    EXPECT_LT(errors.filtered(1), 0.6 * errors.measured(1)) << name;
    EXPECT_LT(errors.filtered(2), 0.9 * errors.measured(2)) << name;
  }
}

TEST(FilterRuns, HaveTheGoldenStates) {
  const std::filesystem::path data = std::filesystem::path(BORESIGHT_SHARED_DATA) / "srukf";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "skipped: no shared data";
  for (const std::string scene : {"approach", "crossing"}) {
    const RadarMeasurements measurements = read_radar_measurements(data / ("golden_" + scene + "_meas.csv"));
    for (const std::string name : {"ekf", "ukf", "srukf"}) {
      const FilterRun run = run_filter(*tracking::filters::filter_kind(name), measurements, {}, 1, made_clock);
      score::Table golden(data / ("golden_" + scene + "_" + name + "_a1.csv"), {"k", "x", "vx", "ax", "y", "vy", "ay"});
      for (const auto& estimate : run.estimates) {
        ASSERT_TRUE(golden.next());
        Eigen::Index i = 0;
        for (const std::string_view column : {"x", "vx", "ax", "y", "vy", "ay"}) {
          EXPECT_NEAR(estimate.mean(i++), golden.number(column, -1e3, 1e3), 1e-9) << scene << name << column;
        }
      }
      EXPECT_FALSE(golden.next());
    }
  }
}

TEST(FilterRuns, EndWhereTheCovarianceIsLost) {
  RadarMeasurements measurements = crossing();
  FilterSetup setup;
  setup.jerk_density_m2ps5 = -1.0;  // refused
  const FilterRun run = run_filter(FilterKind::kSquareRootUnscented, measurements, setup, 1, made_clock);
  EXPECT_EQ(run.refused_row, 1U);
  EXPECT_TRUE(run.estimates.empty());
  EXPECT_THAT(filter_errors_text(filter_errors(measurements, run, 20), 20), HasSubstr("no step after the first 20"));
}

TEST(FilterRuns, AreWrittenWithTheirSteps) {
  const RadarMeasurements measurements = crossing();
  const FilterRun run = run_filter(FilterKind::kUnscented, measurements, {}, 1, made_clock);
  const std::string csv = filter_csv(measurements, run);
  EXPECT_THAT(csv, ::testing::StartsWith("k,x,vx,ax,y,vy,ay,range,azimuth_rad,radial_speed\n12,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(measurements.rows.size()));
  const std::string text = filter_errors_text(filter_errors(measurements, run, 20), 20);
  EXPECT_THAT(text, HasSubstr("RMS errors in 153 steps"));
  EXPECT_THAT(text, HasSubstr("azimuth, °"));
}

TEST(FilterFigures, ShowTheErrorsIfTheTruthIsKnown) {
  RadarMeasurements measurements = crossing();
  const FilterRun run = run_filter(FilterKind::kUnscented, measurements, {}, 1, made_clock);
  const std::string with_truth = filter_svg("ukf", measurements, run, 0.05);
  EXPECT_THAT(with_truth, HasSubstr("error of the azimuth"));
  measurements.truth.clear();
  const std::string without = filter_svg("ukf", measurements, run, 0.05);
  EXPECT_THAT(without, ::testing::Not(HasSubstr("error of")));
  EXPECT_THAT(without, HasSubstr("radial speed"));
}

}  // namespace
}  // namespace boresight::track
