#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/alignment_estimator/station/core/calibration_service.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/station/station_client.hpp"

namespace boresight::alignment::station {
namespace {

namespace service = wire::calibration_service;
using recording::Endpoint;
using recording::IpAddress;
using service::Failure;
using service::Method;
using service::Refusal;
using service::ReturnCode;
using service::State;
using test::Answer;
using test::Bytes;
using test::Header;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1000 * kMs;
const std::vector<std::int16_t> kTilts{-300, -200, -100, 0, 100, 200, 300};
const Endpoint kStation{IpAddress::v4(0xC0A81402), 41000};
constexpr std::size_t kVerdict = service::verdict::kState;  ///< where the state record of a verdict begins

class CalibrationServiceTest : public ::testing::Test, public Surroundings {
 protected:
  static VehicleConfig vehicle() {
    VehicleConfig config;
    for (const std::uint32_t id : {1u, 2u}) {
      config.radars.emplace_back();
      config.radars.back().id = id;
    }
    return config;
  }

  // --- Surroundings
  void answer(std::span<const std::uint8_t> message) override { answers.push_back({{message.begin(), message.end()}}); }
  void fault(Fault kind, std::string_view) override { faults.push_back(kind); }
  bool take_over(std::uint32_t radar_id, const plate::PlateResult& result) override {
    taken_over.emplace_back(radar_id, result.pitch_rad);
    return takes_over;
  }

  // --- the station
  void send(const Bytes& datagram, const Endpoint& from = kStation) { calibration.receive(datagram, from, now, *this); }
  /// The only answer to one request with a session of its own.
  Answer ask(Method method, const Bytes& payload, std::uint16_t client = 0x17) {
    Header header{.method = static_cast<std::uint16_t>(method), .client = client, .session = ++session};
    return ask(header, payload);
  }
  Answer ask(const Header& header, const Bytes& payload, const Endpoint& from = kStation) {
    answers.clear();
    send(test::message(header, payload), from);
    EXPECT_EQ(answers.size(), 1u);
    return answers.empty() ? Answer{Bytes(16 + 512)} : answers.front();
  }
  Refusal start(std::uint16_t client = 0x17) {
    return ask(Method::kStartCalibration, test::start_payload(2, kTilts), client).refusal();
  }
  Answer state() { return ask(Method::kGetState, {}); }
  Answer result() { return ask(Method::kGetResult, {}); }

  // --- the radar before the plate
  /// `flat`: an amplitude without a maximum.
  void scan(double tilt_rad, std::uint32_t radar = 2, bool flat = false) {
    now += 50 * kMs;
    radar_scan->header.source_id = radar;
    radar_scan->header.measurement_time_ns = now - 20 * kMs;
    radar_scan->integrity = 0;
    radar_scan->fields = scan_field::kRcs;
    radar_scan->number_of_valid_detections = 1;
    radar_scan->range_m[0] = 3.0F;
    radar_scan->azimuth_rad[0] = static_cast<float>(-yaw_rad + 0.001 * noise(random));
    radar_scan->elevation_rad[0] = 0.0F;
    radar_scan->range_rate_mps[0] = 0.0F;
    radar_scan->detection_flags[0] = 0;
    const double off_degrees = (tilt_rad + pitch_rad) / kRadiansPerDegree;
    const double amplitude = flat ? 20.0 + off_degrees * off_degrees : 30.0 - 0.5 * off_degrees * off_degrees;
    radar_scan->rcs_dbsm[0] = static_cast<float>(amplitude + 0.02 * noise(random));
    calibration.add_scan(*radar_scan, now);
    calibration.tick(now);
  }
  /// Scans until the tilt is done; the state record's state.
  State measure(std::uint16_t index, bool flat = false) {
    const double tilt = kTilts[index] * service::kRadiansPerUnitOfTilt;
    EXPECT_EQ(ask(Method::kMeasure, test::measure_payload(index, kTilts[index])).refusal(), Refusal::kNone);
    for (int i = 0; i < 20; ++i) scan(tilt, 2, flat);
    return state().state(0);
  }
  Answer whole_run(bool flat = false) {
    EXPECT_EQ(start(), Refusal::kNone);
    Answer last;
    for (std::uint16_t i = 0; i < kTilts.size(); ++i) {
      EXPECT_EQ(measure(i, flat), State::kTiltDone);
      last = ask(Method::kNext, test::tilt_payload(i));
    }
    return last;
  }

  std::vector<Answer> answers;
  std::vector<Fault> faults;
  std::vector<std::pair<std::uint32_t, double>> taken_over;
  bool takes_over = true;
  CalibrationService calibration{vehicle(), plate::StationConfig{}, 0.1};
  std::int64_t now = 10 * kSecond;
  std::uint16_t session = 0;
  double yaw_rad = 0.4 * kRadiansPerDegree, pitch_rad = -0.8 * kRadiansPerDegree;
  std::unique_ptr<RadarScan> radar_scan = std::make_unique<RadarScan>();
  std::mt19937 random{1};
  std::normal_distribution<double> noise{0.0, 1.0};
};

TEST_F(CalibrationServiceTest, AWholeRunFindsTheMountingErrorAndPassesItOn) {
  const Answer last = whole_run();
  EXPECT_TRUE(last.accepted());
  EXPECT_EQ(last.state(kVerdict), State::kFinished);
  const Answer found = result();
  EXPECT_EQ(found.code(), ReturnCode::kOk);
  ASSERT_EQ(found.payload_bytes(), service::result::kBytes + kTilts.size() * service::result::record::kBytes);
  EXPECT_EQ(found.u32(service::result::kRun), 1u);
  EXPECT_EQ(found.u32(service::result::kRadarId), 2u);
  EXPECT_EQ(found.u8(service::result::kFailure), 0);
  EXPECT_EQ(found.u8(service::result::kTakenOver), 1);
  EXPECT_NEAR(found.f32(service::result::kYaw_rad), yaw_rad, 0.03 * kRadiansPerDegree);
  EXPECT_NEAR(found.f32(service::result::kPitch_rad), pitch_rad, 0.05 * kRadiansPerDegree);
  EXPECT_NEAR(found.f32(service::result::kMaximum_db), 30.0F, 0.1F);
  EXPECT_GT(found.f32(service::result::kConfidence), 0.8F);
  for (std::size_t i = 0; i < kTilts.size(); ++i) {
    const std::size_t record = service::result::kBytes + i * service::result::record::kBytes;
    EXPECT_EQ(found.i16(record), kTilts[i]);
    EXPECT_EQ(found.u16(record + service::result::record::kScans), 10);
    EXPECT_EQ(found.u16(record + service::result::record::kFlags), 1);
  }
  ASSERT_EQ(taken_over.size(), 1u);
  EXPECT_EQ(taken_over[0].first, 2u);
  EXPECT_NEAR(taken_over[0].second, pitch_rad, 0.05 * kRadiansPerDegree);
  EXPECT_THAT(faults, IsEmpty());
}

TEST_F(CalibrationServiceTest, ReportsIfTheEstimatorDidNotTakeTheResult) {
  takes_over = false;
  whole_run();
  EXPECT_EQ(result().u8(service::result::kTakenOver), 0);
}

TEST_F(CalibrationServiceTest, WithoutAMaximumTheRunFailsAndNothingIsPassedOn) {
  const Answer last = whole_run(true);
  EXPECT_TRUE(last.accepted());
  EXPECT_EQ(last.state(kVerdict), State::kFailed);
  EXPECT_EQ(last.failure(kVerdict), Failure::kNoMaximum);
  EXPECT_EQ(result().u8(service::result::kFailure), static_cast<std::uint8_t>(Failure::kNoMaximum));
  EXPECT_THAT(taken_over, IsEmpty());
  // Again, now with a maximum.
  EXPECT_EQ(ask(Method::kRepeatRun, test::run_payload()).refusal(), Refusal::kNone);
  EXPECT_EQ(state().u32(service::state::kRun), 2u);
  EXPECT_EQ(result().code(), ReturnCode::kNotReady);
}

TEST_F(CalibrationServiceTest, TheStationsLimitsAreThoseOfItsRun) {
  Bytes payload = test::start_payload(2, kTilts);
  payload[service::start::kFields] = service::start::field::kMinAmplitude | service::start::field::kMethod;
  payload[service::start::kMethod] = service::start::kMethodPublished;
  write_f32(&payload[service::start::kMinAmplitude_db], 31.0F);
  EXPECT_EQ(ask(Method::kStartCalibration, payload).refusal(), Refusal::kNone);
  Answer last;
  for (std::uint16_t i = 0; i < kTilts.size(); ++i) {
    EXPECT_EQ(measure(i), State::kTiltDone);
    last = ask(Method::kNext, test::tilt_payload(i));
  }
  EXPECT_EQ(last.failure(kVerdict), Failure::kAmplitudeTooLow);
  EXPECT_EQ(result().u8(service::result::kMethod), service::start::kMethodPublished);
  EXPECT_EQ(whole_run().state(kVerdict), State::kFinished) << "the limit belonged to the other run";
}

TEST_F(CalibrationServiceTest, RefusesImpossiblePlans) {
  const auto refusal_of = [this](const Bytes& payload) { return ask(Method::kStartCalibration, payload).refusal(); };
  EXPECT_EQ(refusal_of(test::start_payload(3, kTilts)), Refusal::kUnknownRadar);
  EXPECT_EQ(refusal_of(test::start_payload(0, kTilts)), Refusal::kUnknownRadar);
  EXPECT_EQ(refusal_of(test::start_payload(0xFFFFFFFF, kTilts)), Refusal::kUnknownRadar);
  EXPECT_EQ(refusal_of(test::start_payload(2, {-100, 0, 100, 200})), Refusal::kTooFewTilts);
  EXPECT_EQ(refusal_of(test::start_payload(2, {})), Refusal::kTooFewTilts);
  EXPECT_EQ(refusal_of(test::start_payload(2, std::vector<std::int16_t>(12))), Refusal::kTooManyTilts);
  EXPECT_EQ(refusal_of(test::start_payload(2, {-100, 0, 100, 200, 2001})), Refusal::kTiltOutOfRange);
  EXPECT_EQ(refusal_of(test::start_payload(2, {-100, 0, 100, 200, 200})), Refusal::kTiltsNotMonotonic);
  EXPECT_EQ(refusal_of(test::start_payload(2, kTilts, 9)), Refusal::kScansOutOfRange);
  EXPECT_EQ(refusal_of(test::start_payload(2, kTilts, 51)), Refusal::kScansOutOfRange);
  Bytes payload = test::start_payload(2, kTilts);
  payload[service::start::kFields] = service::start::field::kMethod;
  payload[service::start::kMethod] = 2;
  EXPECT_EQ(refusal_of(payload), Refusal::kLimitOutOfRange);
  payload[service::start::kFields] = service::start::field::kMinAmplitude;
  write_f32(&payload[service::start::kMinAmplitude_db], std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(refusal_of(payload), Refusal::kLimitOutOfRange);
  EXPECT_EQ(state().state(0), State::kIdle);
  EXPECT_EQ(state().u32(service::state::kRun), 0u);
  EXPECT_THAT(faults, IsEmpty());
}

TEST_F(CalibrationServiceTest, ARefusedStartKeepsThePreviousResult) {
  whole_run();
  EXPECT_EQ(ask(Method::kStartCalibration, test::start_payload(9, kTilts)).refusal(), Refusal::kUnknownRadar);
  EXPECT_EQ(ask(Method::kStartCalibration, test::start_payload(2, {})).refusal(), Refusal::kTooFewTilts);
  EXPECT_EQ(result().code(), ReturnCode::kOk);
  EXPECT_EQ(result().u8(service::result::kTakenOver), 1);
}

TEST_F(CalibrationServiceTest, EveryCommandOutOfTurnIsRefusedAndChangesNothing) {
  const auto refusals = [this] {
    std::vector<Refusal> all;
    all.push_back(start());
    all.push_back(ask(Method::kMeasure, test::measure_payload(0)).refusal());
    all.push_back(ask(Method::kNext, test::tilt_payload(0)).refusal());
    all.push_back(ask(Method::kRepeatTilt, test::tilt_payload(0)).refusal());
    return all;
  };
  EXPECT_EQ(ask(Method::kAbort, test::run_payload()).refusal(), Refusal::kWrongState);
  EXPECT_EQ(ask(Method::kRepeatRun, test::run_payload()).refusal(), Refusal::kNoRun);
  EXPECT_THAT(refusals(), ElementsAre(Refusal::kNone, Refusal::kNone, Refusal::kWrongState, Refusal::kNone))
      << "idle, positioning, measuring, measuring";
  EXPECT_EQ(ask(Method::kRepeatTilt, test::tilt_payload(0)).refusal(), Refusal::kWrongState) << "positioning";
  EXPECT_EQ(ask(Method::kMeasure, test::measure_payload(1)).refusal(), Refusal::kWrongTiltIndex);
  EXPECT_EQ(ask(Method::kMeasure, test::measure_payload(0, -260)).refusal(), Refusal::kWrongTilt);
  EXPECT_EQ(measure(0), State::kTiltDone);
  EXPECT_EQ(start(), Refusal::kWrongState);
  EXPECT_EQ(ask(Method::kMeasure, test::measure_payload(0)).refusal(), Refusal::kWrongState);
  EXPECT_EQ(ask(Method::kNext, test::tilt_payload(1)).refusal(), Refusal::kWrongTiltIndex);
  EXPECT_EQ(ask(Method::kRepeatTilt, test::tilt_payload(1)).refusal(), Refusal::kWrongTiltIndex);
  EXPECT_EQ(state().u16(service::state::kScansCollected), 10) << "still there";
}

TEST_F(CalibrationServiceTest, ARepeatedTiltIsMeasuredAgain) {
  EXPECT_EQ(start(), Refusal::kNone);
  EXPECT_EQ(measure(0), State::kTiltDone);
  const Answer repeated = ask(Method::kRepeatTilt, test::tilt_payload(0));
  EXPECT_EQ(repeated.state(kVerdict), State::kPositioning);
  EXPECT_EQ(repeated.u16(kVerdict + service::state::kScansCollected), 0);
  EXPECT_EQ(measure(0), State::kTiltDone);
}

TEST_F(CalibrationServiceTest, AnAbortedRunHasNoResultButItsReason) {
  EXPECT_EQ(start(), Refusal::kNone);
  EXPECT_EQ(measure(0), State::kTiltDone);
  EXPECT_EQ(result().code(), ReturnCode::kNotReady);
  EXPECT_EQ(result().payload_bytes(), 0u);
  const Answer aborted = ask(Method::kAbort, test::run_payload());
  EXPECT_EQ(aborted.failure(kVerdict), Failure::kAborted);
  EXPECT_EQ(aborted.u16(kVerdict + service::state::kClientId), 0) << "no client owns the run now";
  EXPECT_EQ(result().u8(service::result::kFailure), static_cast<std::uint8_t>(Failure::kAborted));
  EXPECT_EQ(result().payload_bytes(), service::result::kBytes) << "no tilts";
}

TEST_F(CalibrationServiceTest, TimeOutsEndTheRunWithoutARequest) {
  EXPECT_EQ(start(), Refusal::kNone);
  EXPECT_EQ(state().u32(service::state::kTimeLeft_ms), 60'000u);
  now += 61 * kSecond;
  EXPECT_EQ(state().failure(0), Failure::kPositioningTimeout);
  EXPECT_EQ(start(0x18), Refusal::kNone) << "free for another station";
  EXPECT_EQ(ask(Method::kMeasure, test::measure_payload(0), 0x18).refusal(), Refusal::kNone);
  for (int i = 0; i < 100; ++i) scan(0.0, 1);  // the other radar
  EXPECT_EQ(state().failure(0), Failure::kNoPlateSeen);
}

TEST_F(CalibrationServiceTest, ARunBelongsToOneStation) {
  EXPECT_EQ(start(0x17), Refusal::kNone);
  EXPECT_EQ(start(0x18), Refusal::kBusy);
  for (const Method method : {Method::kRepeatRun, Method::kAbort}) {
    EXPECT_EQ(ask(method, test::run_payload(), 0x18).refusal(), Refusal::kBusy);
  }
  EXPECT_EQ(ask(Method::kMeasure, test::measure_payload(0), 0x18).refusal(), Refusal::kBusy);
  EXPECT_EQ(ask(Method::kNext, test::tilt_payload(0), 0x18).refusal(), Refusal::kBusy);
  EXPECT_EQ(ask(Method::kRepeatTilt, test::tilt_payload(0), 0x18).refusal(), Refusal::kBusy);
  const Answer seen = ask(Method::kGetState, {}, 0x18);
  EXPECT_EQ(seen.u16(service::state::kClientId), 0x17);
  // The same client id at another address is another station; another port of the same address is not.
  const Header abort{.method = static_cast<std::uint16_t>(Method::kAbort), .client = 0x17, .session = 900};
  EXPECT_EQ(ask(abort, test::run_payload(), {IpAddress::v4(0xC0A81403), 41000}).refusal(), Refusal::kBusy);
  EXPECT_EQ(ask(abort, test::run_payload(), {kStation.address, 41001}).refusal(), Refusal::kNone);
  EXPECT_EQ(start(0x18), Refusal::kNone);
}

TEST_F(CalibrationServiceTest, ARepetitionGetsTheSameAnswerAndIsNotExecutedTwice) {
  EXPECT_EQ(start(), Refusal::kNone);
  const Answer first = answers.front();
  const Header header{.method = static_cast<std::uint16_t>(Method::kStartCalibration), .session = session};
  now += 500 * kMs;
  EXPECT_EQ(ask(header, test::start_payload(2, kTilts)).bytes, first.bytes);
  // None of these requests is a repetition.
  EXPECT_EQ(ask(header, test::start_payload(1, kTilts)).refusal(), Refusal::kWrongState) << "other payload";
  EXPECT_EQ(ask(header, test::start_payload(2, kTilts), {kStation.address, 5}).refusal(), Refusal::kWrongState);
  Header other = header;
  other.client = 0x18;
  EXPECT_EQ(ask(other, test::start_payload(2, kTilts)).refusal(), Refusal::kBusy);
  now += 5 * kSecond;
  EXPECT_EQ(ask(header, test::start_payload(2, kTilts)).refusal(), Refusal::kWrongState) << "too late";
  EXPECT_EQ(state().u32(service::state::kRun), 1u);
  // A station without session handling does not count as repeating.
  Header without{.method = static_cast<std::uint16_t>(Method::kRepeatRun), .session = 0};
  EXPECT_EQ(ask(without, test::run_payload()).refusal(), Refusal::kNone);
  EXPECT_EQ(ask(without, test::run_payload()).refusal(), Refusal::kNone);
  EXPECT_EQ(state().u32(service::state::kRun), 3u);
}

TEST_F(CalibrationServiceTest, StartsOnlyWhileTheVehicleIsStationary) {
  EgoMotion motion{};
  motion.fields = ego_field::kSpeed;
  motion.speed_mps = -0.5F;
  calibration.add_ego_motion(motion, now);
  EXPECT_EQ(start(), Refusal::kVehicleMoves);
  motion.speed_mps = std::numeric_limits<float>::quiet_NaN();
  calibration.add_ego_motion(motion, now);
  EXPECT_EQ(start(), Refusal::kVehicleMoves);
  motion.speed_mps = 0.05F;
  calibration.add_ego_motion(motion, now);
  EXPECT_EQ(start(), Refusal::kNone);
  EXPECT_EQ(ask(Method::kAbort, test::run_payload()).refusal(), Refusal::kNone);
  motion.speed_mps = 5.0F;
  calibration.add_ego_motion(motion, now);
  EXPECT_EQ(ask(Method::kRepeatRun, test::run_payload()).refusal(), Refusal::kVehicleMoves);
  now += 2 * kSecond;
  EXPECT_EQ(start(), Refusal::kNone) << "an old signal is not used";
}

TEST_F(CalibrationServiceTest, EachFaultOfTheHeaderHasItsReturnCode) {
  const auto code_of = [this](Header header, const Bytes& payload = {}) {
    faults.clear();
    const Answer answer = ask(header, payload);
    EXPECT_EQ(answer.type(), 0x81);
    EXPECT_EQ(answer.payload_bytes(), 0u);
    EXPECT_EQ(faults.size(), 1u);
    EXPECT_EQ(read_u16(&answer.bytes[0]), header.service);
    EXPECT_EQ(read_u16(&answer.bytes[2]), header.method);
    EXPECT_EQ(read_u16(&answer.bytes[8]), header.client);
    EXPECT_EQ(read_u16(&answer.bytes[10]), header.session);
    EXPECT_EQ(answer.bytes[12], 1);
    EXPECT_EQ(answer.bytes[13], 1);
    return answer.code();
  };
  const Header sound{.method = static_cast<std::uint16_t>(Method::kGetState)};
  Header header = sound;
  header.protocol_version = 2;
  EXPECT_EQ(code_of(header), ReturnCode::kWrongProtocolVersion);
  header = sound;
  header.type = 0x20;
  EXPECT_EQ(code_of(header), ReturnCode::kWrongMessageType);
  header = sound;
  header.return_code = 1;
  EXPECT_EQ(code_of(header), ReturnCode::kWrongMessageType);
  header = sound;
  header.service = 0x4253;
  EXPECT_EQ(code_of(header), ReturnCode::kUnknownService);
  header = sound;
  header.interface_version = 2;
  EXPECT_EQ(code_of(header), ReturnCode::kWrongInterfaceVersion);
  for (const int method : {0, 9, 0x7FFF, 0x8001, 0xFFFF}) {
    header = sound;
    header.method = static_cast<std::uint16_t>(method);
    EXPECT_EQ(code_of(header), ReturnCode::kUnknownMethod) << method;
  }
  EXPECT_EQ(code_of(sound, {0}), ReturnCode::kMalformedMessage);
  for (std::uint16_t method = 1; method <= 8; ++method) {
    header = sound;
    header.method = method;
    EXPECT_EQ(code_of(header, Bytes(5)), ReturnCode::kMalformedMessage) << method;
    EXPECT_EQ(code_of(header, Bytes(60'000)), ReturnCode::kMalformedMessage) << method;
  }
  EXPECT_EQ(state().state(0), State::kIdle);
}

TEST_F(CalibrationServiceTest, OnlyRequestsAreAnswered) {
  for (const int type : {0x02, 0x80, 0x81, 0x22, 0xA0, 0x40, 0xFF}) {
    send(test::message({.method = 7, .type = static_cast<std::uint8_t>(type)}, {}));
  }
  EXPECT_EQ(faults.size(), 7u);
  const Bytes sound = test::message({.method = 7}, {});
  for (std::size_t size = 0; size < sound.size(); ++size)
    send(Bytes(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(size)));
  EXPECT_EQ(faults.size(), 7u + 16u);
  Bytes longer = sound;
  longer[7] = 9;
  send(longer);
  longer[7] = 7;
  send(longer);
  EXPECT_EQ(faults.size(), 25u);
  EXPECT_THAT(answers, IsEmpty());
}

TEST_F(CalibrationServiceTest, ARequestWithoutReturnIsExecutedWithoutAnswer) {
  send(test::message({.method = 1, .type = 0x01}, test::start_payload(2, kTilts)));
  send(test::message({.method = 99, .session = 2, .type = 0x01}, {}));
  EXPECT_THAT(answers, IsEmpty());
  EXPECT_EQ(state().state(0), State::kPositioning);
}

TEST_F(CalibrationServiceTest, RequestsThatShareADatagramAreAnsweredInTurn) {
  Bytes datagram = test::message({.method = 1, .session = 1}, test::start_payload(2, kTilts));
  for (const Bytes& more :
       {test::message({.method = 99, .session = 2}, {}), test::message({.method = 7, .session = 3}, {}),
        test::message({.method = 2, .session = 4}, test::measure_payload(0))}) {
    datagram.insert(datagram.end(), more.begin(), more.end());
  }
  send(datagram);
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_TRUE(answers[0].accepted());
  EXPECT_EQ(answers[1].code(), ReturnCode::kUnknownMethod);
  EXPECT_EQ(answers[2].state(0), State::kPositioning);
  EXPECT_EQ(answers[3].state(kVerdict), State::kMeasuring);
}

TEST_F(CalibrationServiceTest, EventsReportEachChangeOnceWithSessionsOfTheirOwn) {
  std::vector<std::pair<std::uint16_t, State>> events;
  const auto look = [&] {
    const auto bytes = calibration.event_if_changed(now);
    if (bytes.empty()) return;
    const Answer event{{bytes.begin(), bytes.end()}};
    EXPECT_EQ(read_u16(&event.bytes[2]), service::kEventState);
    EXPECT_EQ(event.type(), 0x02);
    EXPECT_EQ(event.payload_bytes(), service::state::kBytes);
    events.emplace_back(read_u16(&event.bytes[10]), event.state(0));
  };
  look();
  EXPECT_THAT(events, IsEmpty()) << "nothing has changed";
  EXPECT_EQ(start(), Refusal::kNone);
  look();
  EXPECT_EQ(start(0x18), Refusal::kBusy);
  look();
  EXPECT_EQ(ask(Method::kMeasure, test::measure_payload(0)).refusal(), Refusal::kNone);
  look();
  for (int i = 0; i < 20; ++i) {
    scan(kTilts[0] * service::kRadiansPerUnitOfTilt);
    look();
  }
  now += 61 * kSecond;
  calibration.tick(now);
  look();
  look();
  using Pair = std::pair<std::uint16_t, State>;
  EXPECT_THAT(events, ElementsAre(Pair{1, State::kPositioning}, Pair{2, State::kMeasuring}, Pair{3, State::kTiltDone},
                                  Pair{4, State::kFailed}));
  EXPECT_FALSE(calibration.event(now).empty()) << "a new subscriber gets the state in any case";
}

TEST_F(CalibrationServiceTest, NeverAllocates) {
  struct Silent : Surroundings {
    void answer(std::span<const std::uint8_t>) override {}
    void fault(Fault, std::string_view) override {}
    bool take_over(std::uint32_t, const plate::PlateResult&) override { return true; }
  } silent;
  std::vector<Bytes> requests{test::message({.method = 1, .session = 1}, test::start_payload(2, kTilts))};
  std::vector<double> tilts{0.0};
  std::uint16_t next_session = 1;
  for (std::uint16_t i = 0; i < kTilts.size(); ++i) {
    requests.push_back(test::message({.method = 2, .session = ++next_session}, test::measure_payload(i)));
    requests.push_back(test::message({.method = 3, .session = ++next_session}, test::tilt_payload(i)));
    tilts.insert(tilts.end(), 2, kTilts[i] * service::kRadiansPerUnitOfTilt);
  }
  requests.push_back(test::message({.method = 8, .session = ++next_session}, {}));
  requests.push_back(test::message({.method = 99}, {}));
  requests.push_back({1, 2, 3});
  tilts.insert(tilts.end(), 3, 0.0);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting(true);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      calibration.receive(requests[i], kStation, now, silent);
      for (int k = 0; k < 20; ++k) scan(tilts[i]);
      static_cast<void>(calibration.event_if_changed(now));
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_EQ(state().state(0), State::kFinished);
}

}  // namespace
}  // namespace boresight::alignment::station
