#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/alignment_estimator/station/codecs/calibration_codec.hpp"
#include "services/common/geometry/angles.hpp"
#include "tests/unit/alignment_estimator/station/station_client.hpp"
#include "tests/unit/document.hpp"

namespace boresight::alignment::station {
namespace {

namespace service = wire::calibration_service;
using test::Bytes;
using ::testing::ElementsAreArray;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Bytes example(const std::string& name) {
  return boresight::test::document_example("calibration_service.md", name);
}
/// The payload of an example that is a whole message.
Bytes payload_of(const std::string& name) {
  const Bytes bytes = example(name);
  EXPECT_GT(bytes.size(), 16u) << name;
  return bytes.size() > 16 ? Bytes(bytes.begin() + 16, bytes.end()) : Bytes{};
}

template <typename Write>
Bytes written(Write write) {
  Bytes bytes(kMaxAnswerPayloadBytes);
  someip::ByteWriter out(bytes);
  write(out);
  EXPECT_FALSE(out.overflowed());
  bytes.resize(out.size());
  return bytes;
}

RunState state_of_examples() {
  RunState state{.run = 1, .radar_id = 2, .client = 0x17, .progress = {}};
  state.progress.state = plate::State::kPositioning;
  state.progress.instruction = plate::Instruction::kMovePlate;
  state.progress.number_of_tilts = 5;
  state.progress.tilt_rad = -2.0 * kRadiansPerDegree;
  state.progress.scans_per_tilt = 30;
  state.progress.seconds_left = 60.0;
  return state;
}

TEST(CalibrationCodec, ReadsTheDocumentsStart) {
  const auto start = read_start(payload_of("start"));
  ASSERT_TRUE(start);
  EXPECT_EQ(start->radar_id, 2u);
  EXPECT_EQ(start->plan.number_of_tilts, 5u);
  EXPECT_EQ(start->plan.scans_per_tilt, 30u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(start->plan.tilts_rad[static_cast<std::size_t>(i)], (i - 2) * kRadiansPerDegree, 1e-12);
  }
  EXPECT_FALSE(start->method);
  EXPECT_EQ(start->min_amplitude_db, 12.5F);
}

TEST(CalibrationCodec, ReadsTheDocumentsMeasure) {
  const auto measure = read_measure(payload_of("measure"));
  ASSERT_TRUE(measure);
  EXPECT_EQ(measure->tilt_index, 0u);
  ASSERT_TRUE(measure->tilt_rad);
  EXPECT_NEAR(*measure->tilt_rad, -1.98 * kRadiansPerDegree, 1e-12);
  EXPECT_FALSE(read_measure(test::measure_payload(3))->tilt_rad) << "exactly as requested";
}

TEST(CalibrationCodec, WritesTheDocumentsAnswers) {
  RunState state = state_of_examples();
  EXPECT_THAT(written([&](auto& out) { write_verdict(service::Refusal::kNone, state, out); }),
              ElementsAreArray(payload_of("accepted")));
  EXPECT_THAT(written([&](auto& out) { write_verdict(service::Refusal::kBusy, state, out); }),
              ElementsAreArray(payload_of("busy")));
  state.progress.state = plate::State::kTiltDone;
  state.progress.instruction = plate::Instruction::kSendNext;
  state.progress.tilt_rad = -1.98 * kRadiansPerDegree;
  state.progress.scans_collected = 30;
  EXPECT_THAT(written([&](auto& out) { write_state(state, out); }), ElementsAreArray(payload_of("event")));
}

plate::PlateResult result_of_examples() {
  plate::PlateResult result;
  result.yaw_rad = 0.0078125;
  result.yaw_std_rad = 0.000244140625;
  result.pitch_rad = -0.015625;
  result.pitch_std_rad = 0.00048828125;
  result.maximum_db = 30.5;
  result.self_consistency = 0.75;
  result.triples_median_rad = -0.0155029296875;
  result.triples_std_rad = 0.001953125;
  result.azimuth_inlier_ratio = 0.96875;
  result.number_of_tilts = 5;
  result.tilts_used = 4;
  for (std::size_t i = 0; i < 5; ++i) {
    result.tilts[i] = {.tilt_rad = (static_cast<double>(i) - 2.0) * kRadiansPerDegree,
                       .scans = 30,
                       .mean_db = 30.0,
                       .std_db = 0.25,
                       .median_db = 30.25,
                       .mean_azimuth_rad = -0.0078125,
                       .azimuth_std_rad = 0.001953125,
                       .fitted_db = 30.125,
                       .used = i != 1};
  }
  return result;
}

TEST(CalibrationCodec, WritesTheDocumentsResult) {
  const Bytes result = written([&](auto& out) { write_result(state_of_examples(), result_of_examples(), true, out); });
  ASSERT_EQ(result.size(), 64u + 5 * 32u);
  const Bytes beginning = payload_of("result, first 128 bytes");
  ASSERT_EQ(beginning.size(), 112u);
  EXPECT_THAT(Bytes(result.begin(), result.begin() + 112), ElementsAreArray(beginning));
}

TEST(CalibrationCodec, UnavailableValuesAreNaNOrZeroAndNeverOverflow) {
  plate::PlateResult result = result_of_examples();
  result.number_of_tilts = 99;
  result.pitch_rad = std::numeric_limits<double>::infinity();
  result.maximum_db = 1e300;
  result.tilts[0].tilt_rad = kNaN;
  result.tilts[1].tilt_rad = 100.0;
  const test::Answer answer{
      test::message({}, written([&](auto& out) { write_result(state_of_examples(), result, false, out); }))};
  EXPECT_EQ(answer.u16(service::result::kNumberOfTilts), plate::kMaxTilts);
  EXPECT_EQ(answer.payload_bytes(), kMaxAnswerPayloadBytes);
  EXPECT_TRUE(std::isnan(answer.f32(service::result::kPitch_rad)));
  EXPECT_TRUE(std::isnan(answer.f32(service::result::kMaximum_db)));
  EXPECT_EQ(answer.i16(service::result::kBytes), 0);
  EXPECT_EQ(answer.i16(service::result::kBytes + service::result::record::kBytes), 32767);
}

TEST(CalibrationCodec, ALongerHeaderIsSkipped) {
  Bytes payload = test::start_payload(3, {-100, 100});
  payload[3] = 24;
  payload.insert(payload.begin() + 20, {9, 9, 9, 9});
  const auto start = read_start(payload);
  ASSERT_TRUE(start);
  EXPECT_NEAR(start->plan.tilts_rad[1], kRadiansPerDegree, 1e-12);
}

TEST(CalibrationCodec, TooManyTiltsKeepOnlyTheirNumber) {
  const auto start = read_start(test::start_payload(3, std::vector<std::int16_t>(600)));
  ASSERT_TRUE(start);
  EXPECT_EQ(start->plan.number_of_tilts, 600u);
}

TEST(CalibrationCodec, RefusesEveryOtherLengthAndLayout) {
  const auto reads = [](int kind, const Bytes& payload) {
    if (kind == 0) return read_start(payload).has_value();
    if (kind == 1) return read_measure(payload).has_value();
    if (kind == 2) return read_tilt(payload).has_value();
    return read_run(payload);
  };
  const std::vector<Bytes> sound{test::start_payload(1, {-200, -100, 0, 100, 200}), test::measure_payload(0),
                                 test::tilt_payload(0), test::run_payload()};
  for (int kind = 0; kind < 4; ++kind) {
    const Bytes& payload = sound[static_cast<std::size_t>(kind)];
    EXPECT_TRUE(reads(kind, payload));
    for (std::size_t size = 0; size <= payload.size() + 8; ++size) {
      if (size == payload.size()) continue;
      Bytes cut = payload;
      cut.resize(size);
      EXPECT_FALSE(reads(kind, cut)) << "request " << kind << " of " << size << " bytes";
    }
    Bytes other = payload;
    other[1] = 2;
    EXPECT_FALSE(reads(kind, other)) << "layout version 2 of request " << kind;
  }
  for (const int header_bytes : {0, 16, 21, 22, 24, 255}) {
    Bytes payload = sound[0];
    payload[3] = static_cast<std::uint8_t>(header_bytes);
    EXPECT_FALSE(read_start(payload)) << "header of " << header_bytes;
  }
}

}  // namespace
}  // namespace boresight::alignment::station
