#include "services/boresight/decode/csv.hpp"

#include <memory>
#include <sstream>

#include <gmock/gmock.h>

namespace boresight::decode {
namespace {

std::vector<std::string> cells(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream stream(row + "!");  // so that an empty last cell is one
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  if (!cells.empty()) cells.back().pop_back();
  return cells;
}

std::unique_ptr<RadarScan> scan_of(std::uint32_t detections, std::uint32_t fields) {
  auto scan = std::make_unique<RadarScan>();
  scan->cycle_counter = 4'000'000'000;
  scan->number_of_valid_detections = detections;
  scan->fields = fields;
  scan->range_rate_min_mps = -20.25f;
  scan->range_rate_max_mps = 10.75f;
  for (std::uint32_t i = 0; i < detections; ++i) {
    scan->range_m[i] = 0.1f + static_cast<float>(i);
    scan->azimuth_rad[i] = -1.0f / 3.0f;
    scan->elevation_rad[i] = 1e-9f;
    scan->range_rate_mps[i] = -12.5f;
    scan->rcs_dbsm[i] = 3.0f;
    scan->snr_db[i] = 4.0f;
    scan->range_std_m[i] = 5.0f;
    scan->azimuth_std_rad[i] = 6.0f;
    scan->elevation_std_rad[i] = 7.0f;
    scan->range_rate_std_mps[i] = 8.0f;
    scan->existence_probability[i] = 0.5f;
    scan->detection_flags[i] = static_cast<std::uint16_t>(i);
  }
  return scan;
}

constexpr std::uint32_t kAll = scan_field::kElevation | scan_field::kRcs | scan_field::kSnr | scan_field::kStds |
                               scan_field::kAmbiguity | scan_field::kExistence;

TEST(Csv, EveryQuantityOfADetectionHasItsColumn) {
  std::string rows;
  const auto scan = scan_of(2, kAll);
  scan->integrity = scan_integrity::kFrozen | scan_integrity::kCounterGap;
  append_detections(rows, *scan, 3, {1'700'000'000'000'000'001, TimeSource::kSensorSynchronised});
  std::istringstream lines(rows);
  std::string first, second, none;
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_FALSE(std::getline(lines, none));
  EXPECT_THAT(cells(first), testing::ElementsAre("1700000000.000000001", "3", "4000000000", "0", "0.1", "-0.33333334",
                                                 "1e-09", "-12.5", "3", "4", "5", "6", "7", "8", "-20.25", "10.75",
                                                 "0.5", "", "sensor_synchronised", "counter_gap+frozen"));
  EXPECT_EQ(cells(second)[3], "1");
  EXPECT_EQ(cells(second)[17], "invalid");
  EXPECT_EQ(cells(std::string(detection_header())).size(), cells(first).size());
}

TEST(Csv, NumbersReadBackAsTheyWere) {
  const auto scan = scan_of(1, kAll);
  for (const float value : {1.17549435e-38f, 3.40282347e38f, 0.1f, 1.0f / 3.0f, -0.0f, 16777217.0f}) {
    scan->range_m[0] = value;
    std::string rows;
    append_detections(rows, *scan, 1, {0, TimeSource::kLinkArrival});
    const float back = std::stof(cells(rows)[4]);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(back), std::bit_cast<std::uint32_t>(value)) << cells(rows)[4];
  }
}

TEST(Csv, WhatTheSensorDoesNotMeasureIsEmpty) {
  std::string rows;
  append_detections(rows, *scan_of(1, 0), 1, {-1'500'000'000, TimeSource::kLinkArrival});
  const auto row = cells(rows);
  EXPECT_EQ(row[0], "-1.500000000");
  for (const std::size_t column : {6, 8, 9, 10, 11, 12, 13, 14, 15, 16}) EXPECT_EQ(row[column], "") << column;
  EXPECT_EQ(row[4], "0.1");
}

TEST(Csv, EgoMotionsAndTheNamesOfAllBits) {
  EgoMotion ego{};
  ego.fields = ego_field::kSpeed | ego_field::kReverse;
  ego.speed_mps = -1.5f;
  ego.yaw_rate_radps = 9.0f;
  std::string rows;
  append_ego(rows, ego, {2'000'000'003, TimeSource::kSensorFreeRunning});
  EXPECT_THAT(cells(rows.substr(0, rows.size() - 1)),
              testing::ElementsAre("2.000000003", "-1.5", "0", "", "", "", "", "0", "1", "sensor_free_running"));
  EXPECT_EQ(cells(std::string(ego_header())).size(), 10u);
  EXPECT_EQ(integrity_names(0), "");
  EXPECT_EQ(integrity_names(0xFFFF),
            "counter_gap+repeated+frozen+stale+implausible+contradicts_ego+incomplete+impossible_copies");
}

}  // namespace
}  // namespace boresight::decode
