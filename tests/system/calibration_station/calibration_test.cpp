#include <cmath>
#include <cstdio>
#include <filesystem>

#include "services/common/runtime/clock.hpp"
#include "tests/system/calibration_station/story.hpp"

namespace boresight::calibration_station {
namespace {

using alignment::station::test::Header;
using alignment::station::test::measure_payload;
using alignment::station::test::message;
using alignment::station::test::run_payload;
using alignment::station::test::start_payload;
using alignment::station::test::tilt_payload;
using ingest::someip::EntryType;
using service::Failure;
using service::Method;
using service::Refusal;
using service::ReturnCode;
using service::State;

constexpr std::uint16_t kEventPort = 41000;

class CalibrationStation : public Story {
 protected:
  static std::uint64_t faults(const ServiceStatus& status, Fault fault) {
    return status.faults[static_cast<std::size_t>(fault)];
  }
};

TEST_F(CalibrationStation, FindsTheServiceAndCalibratesARadar) {
  Finder finder(hosts());
  finder.find();
  const auto offer = finder.wait_for(EntryType::kOffer, 2.5);
  ASSERT_TRUE(offer && offer->endpoint);
  EXPECT_EQ(offer->service, service::kServiceId);
  EXPECT_EQ(offer->instance, service::kDefaultInstance);
  EXPECT_EQ(offer->endpoint->port, service::kDefaultPort);
  EventPort events(hosts(), kEventPort);
  finder.subscribe(service::kEventgroupState, kEventPort, 60);
  EXPECT_TRUE(finder.wait_for(EntryType::kSubscribeAck, 1.0));
  const auto initial = events.next(1.0);
  ASSERT_TRUE(initial) << "a new subscriber gets the field's value";
  EXPECT_EQ(initial->state(0), State::kIdle);

  Station station(hosts(), 0x17, *offer->endpoint);
  const std::int64_t begin_ns = runtime::monotonic_now_ns();
  const Answer started = start(station);
  ASSERT_EQ(started.refusal(), Refusal::kNone);
  const Answer last = finish(station);
  EXPECT_EQ(last.state(kVerdict), State::kFinished);
  const Answer result = station.result();
  expect_truth(result);
  EXPECT_EQ(result.u8(service::result::kTakenOver), 1);
  std::printf("%zu tilts of 10 scans in %.1f s: yaw off by %.3f deg, pitch by %.3f deg, confidence %.2f\n",
              kTilts.size(), static_cast<double>(runtime::monotonic_now_ns() - begin_ns) * 1e-9,
              (result.f32(service::result::kYaw_rad) - scene().yaw_rad) / kDegree_rad,
              (result.f32(service::result::kPitch_rad) - scene().pitch_rad) / kDegree_rad,
              static_cast<double>(result.f32(service::result::kConfidence)));

  // Each change is an event: three per tilt; the last one is that of the result.
  std::vector<State> states;
  while (const auto event = events.next(0.2)) states.push_back(event->state(0));
  ASSERT_EQ(states.size(), 3 * kTilts.size() + 1);
  for (std::size_t i = 0; i < kTilts.size(); ++i) {
    EXPECT_EQ(states[3 * i], State::kPositioning);
    EXPECT_EQ(states[3 * i + 1], State::kMeasuring);
    EXPECT_EQ(states[3 * i + 2], State::kTiltDone);
  }
  EXPECT_EQ(states.back(), State::kFinished);

  finder.forget();
  stop_estimator();
  EXPECT_TRUE(finder.wait_for(EntryType::kOffer, 1.0, true)) << "the offer is withdrawn";
}

TEST_F(CalibrationStation, TheResultIsTheEstimatorsPriorAndSurvivesTheIgnitionCycle) {
  Station here = station();
  ASSERT_EQ(start(here).refusal(), Refusal::kNone);
  ASSERT_EQ(finish(here).state(kVerdict), State::kFinished);
  const Answer result = here.result();
  ASSERT_EQ(result.u8(service::result::kTakenOver), 1);
  // Expects the result in the published estimate; returns its standard deviation of pitch.
  const auto pitch_std_of_published = [&] {
    const std::size_t before = reader().number_of_estimates(kRadarAtPlate);
    EXPECT_TRUE(harness::eventually(3.0, [&] { return reader().number_of_estimates(kRadarAtPlate) > before + 1; }));
    const AlignmentEstimate estimate = reader().estimate(kRadarAtPlate);
    EXPECT_NEAR(estimate.alignment_yaw_rad, result.f32(service::result::kYaw_rad), 0.002 * kDegree_rad);
    EXPECT_NEAR(estimate.alignment_pitch_rad, result.f32(service::result::kPitch_rad), 0.002 * kDegree_rad);
    EXPECT_TRUE(estimate.is_observable(alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch));
    const AlignmentEstimate other = reader().estimate(1);
    EXPECT_NEAR(other.alignment_pitch_rad, 0.0, 1e-6);
    return std::sqrt(
        static_cast<double>(estimate.covariance[5 * static_cast<std::size_t>(AlignmentParameter::kPitch)]));
  };
  EXPECT_LT(pitch_std_of_published(), 0.1 * kDegree_rad);
  // The result is stored at once, as power may be switched off at any time.
  EXPECT_TRUE(harness::eventually(2.0, [] { return std::filesystem::exists("/tmp/memory/alignment"); }));
  estimator_->send(SIGKILL);
  ASSERT_TRUE(estimator_->wait_for(5.0));
  estimator_.reset();
  start_estimator();
  EXPECT_LT(pitch_std_of_published(), 0.4 * kDegree_rad) << "a stored result has a larger standard deviation";
}

TEST_F(CalibrationStation, RepeatsATiltThatWasDisturbed) {
  Station here = station();
  ASSERT_EQ(start(here).refusal(), Refusal::kNone);
  for (std::uint16_t i = 0; i < 5; ++i) {
    ASSERT_EQ(measure(here, i), State::kTiltDone);
    ASSERT_EQ(here.ask(Method::kNext, tilt_payload(i)).refusal(), Refusal::kNone);
  }
  scene().disturbance_db = 8.0;
  ASSERT_EQ(measure(here, 5), State::kTiltDone);
  const Answer again = here.ask(Method::kRepeatTilt, tilt_payload(5));
  EXPECT_EQ(again.state(kVerdict), State::kPositioning);
  EXPECT_EQ(again.u16(kVerdict + service::state::kTiltIndex), 5);
  scene().disturbance_db = 0.0;
  EXPECT_EQ(finish(here, 5).state(kVerdict), State::kFinished);
  const Answer result = here.result();
  expect_truth(result);
  EXPECT_EQ(result.u16(service::result::kTiltsUsed), kTilts.size()) << "the disturbed scans are dropped";
}

TEST_F(CalibrationStation, AbortsAndStartsAgain) {
  Station here = station();
  ASSERT_EQ(start(here).refusal(), Refusal::kNone);
  ASSERT_EQ(measure(here, 0), State::kTiltDone);
  const Answer aborted = here.ask(Method::kAbort, run_payload());
  EXPECT_EQ(aborted.state(kVerdict), State::kFailed);
  EXPECT_EQ(aborted.failure(kVerdict), Failure::kAborted);
  EXPECT_EQ(here.result().u8(service::result::kFailure), static_cast<std::uint8_t>(Failure::kAborted));
  ASSERT_EQ(here.ask(Method::kRepeatRun, run_payload()).refusal(), Refusal::kNone);
  EXPECT_EQ(here.state().u32(service::state::kRun), 2u);
  EXPECT_EQ(finish(here).state(kVerdict), State::kFinished);
  expect_truth(here.result());
}

TEST_F(CalibrationStation, ARunWithoutAMaximumFailsAndDoesNotChangeTheEstimate) {
  scene().has_maximum = false;
  Station here = station();
  ASSERT_EQ(start(here).refusal(), Refusal::kNone);
  const Answer last = finish(here);
  EXPECT_EQ(last.state(kVerdict), State::kFailed);
  EXPECT_EQ(last.failure(kVerdict), Failure::kNoMaximum);
  const Answer result = here.result();
  EXPECT_EQ(result.u8(service::result::kFailure), static_cast<std::uint8_t>(Failure::kNoMaximum));
  EXPECT_EQ(result.u8(service::result::kTakenOver), 0);
  EXPECT_EQ(reader().estimate(kRadarAtPlate).alignment_pitch_rad, 0.0F);
}

TEST_F(CalibrationStation, TimeOutsFreeTheServiceByThemselves) {
  Station here = station();
  EventPort events(hosts(), kEventPort);
  Finder finder(hosts());
  finder.subscribe(service::kEventgroupState, kEventPort, 60);
  ASSERT_TRUE(events.next(1.0));
  ASSERT_EQ(start(here).refusal(), Refusal::kNone);
  ASSERT_TRUE(events.next(1.0));
  const auto timed_out = events.next(kPositioningTimeout_s + 0.5);
  ASSERT_TRUE(timed_out) << "without a request";
  EXPECT_EQ(timed_out->failure(0), Failure::kPositioningTimeout);
  EXPECT_EQ(timed_out->u16(service::state::kClientId), 0) << "belongs to no station";

  scene().is_plate_there = false;
  ASSERT_EQ(start(here).refusal(), Refusal::kNone);
  EXPECT_EQ(measure(here, 0), State::kFailed);
  const Answer state = here.state();
  EXPECT_EQ(state.failure(0), Failure::kNoPlateSeen);
  EXPECT_GT(state.u16(service::state::kScansWithoutPlate), 20);
}

TEST_F(CalibrationStation, CommandsOutOfTurnAreRefusedAndHarmless) {
  Station here = station();
  EXPECT_EQ(here.ask(Method::kMeasure, measure_payload(0)).refusal(), Refusal::kWrongState);
  EXPECT_EQ(here.ask(Method::kNext, tilt_payload(0)).refusal(), Refusal::kWrongState);
  EXPECT_EQ(here.ask(Method::kRepeatTilt, tilt_payload(0)).refusal(), Refusal::kWrongState);
  EXPECT_EQ(here.ask(Method::kAbort, run_payload()).refusal(), Refusal::kWrongState);
  EXPECT_EQ(here.ask(Method::kRepeatRun, run_payload()).refusal(), Refusal::kNoRun);
  EXPECT_EQ(here.result().code(), ReturnCode::kNotReady);
  EXPECT_EQ(here.ask(Method::kStartCalibration, start_payload(9, kTilts)).refusal(), Refusal::kUnknownRadar);
  scene().speed_mps = 3.0;
  harness::sleep_s(0.1);
  EXPECT_EQ(start(here).refusal(), Refusal::kVehicleMoves);
  scene().speed_mps = 0.0;
  harness::sleep_s(0.1);
  ASSERT_EQ(start(here).refusal(), Refusal::kNone);
  EXPECT_EQ(start(here).refusal(), Refusal::kWrongState);
  EXPECT_EQ(here.ask(Method::kMeasure, measure_payload(3)).refusal(), Refusal::kWrongTiltIndex);
  EXPECT_EQ(here.ask(Method::kMeasure, measure_payload(0, 0)).refusal(), Refusal::kWrongTilt);
  EXPECT_EQ(here.result().code(), ReturnCode::kNotReady);
  EXPECT_EQ(finish(here).state(kVerdict), State::kFinished);
  expect_truth(here.result());
}

TEST_F(CalibrationStation, ASecondStationIsRefusedWhileOneIsBusy) {
  Station first = station(0x17), second = station(0x18);
  ASSERT_EQ(start(first).refusal(), Refusal::kNone);
  EXPECT_EQ(start(second).refusal(), Refusal::kBusy);
  EXPECT_EQ(second.ask(Method::kAbort, run_payload()).refusal(), Refusal::kBusy);
  EXPECT_EQ(second.ask(Method::kMeasure, measure_payload(0)).refusal(), Refusal::kBusy);
  EXPECT_EQ(second.state().u16(service::state::kClientId), 0x17) << "but it may read the state";
  EXPECT_EQ(finish(first).state(kVerdict), State::kFinished);
  EXPECT_EQ(start(second).refusal(), Refusal::kNone);
  EXPECT_EQ(second.state().u16(service::state::kClientId), 0x18);
}

TEST_F(CalibrationStation, MalformedRequestsAreCountedAndAnsweredByTheirCode) {
  Station here = station();
  const ServiceStatus before = status_after_now();
  const auto code_of = [&](const Header& header, const Bytes& payload) {
    here.send(message(header, payload));
    const auto answer = here.receive(1.0);
    return answer ? answer->code() : ReturnCode::kOk;
  };
  EXPECT_EQ(code_of({.service = 0x4253, .method = 7}, {}), ReturnCode::kUnknownService);
  EXPECT_EQ(code_of({.method = 77}, {}), ReturnCode::kUnknownMethod);
  EXPECT_EQ(code_of({.method = 7, .protocol_version = 3}, {}), ReturnCode::kWrongProtocolVersion);
  EXPECT_EQ(code_of({.method = 7, .interface_version = 3}, {}), ReturnCode::kWrongInterfaceVersion);
  EXPECT_EQ(code_of({.method = 7, .type = 0x20}, {}), ReturnCode::kWrongMessageType);
  EXPECT_EQ(code_of({.method = 1}, {1, 2, 3}), ReturnCode::kMalformedMessage);
  EXPECT_EQ(code_of({.method = 2}, Bytes(1300, 0xFF)), ReturnCode::kMalformedMessage);
  // Without an answer: no header, a length beyond the datagram, an answer, an empty datagram.
  for (const Bytes& datagram : {Bytes{1, 2, 3}, Bytes(16, 0xFF), message({.method = 7, .type = 0x80}, {}), Bytes{}}) {
    here.send(datagram);
  }
  EXPECT_FALSE(here.receive(0.3));
  const ServiceStatus after = status_after_now();
  EXPECT_EQ(faults(after, Fault::kWireUnknown) - faults(before, Fault::kWireUnknown), 2u);
  EXPECT_EQ(faults(after, Fault::kWireValue) - faults(before, Fault::kWireValue), 4u);
  EXPECT_EQ(faults(after, Fault::kWireLength) - faults(before, Fault::kWireLength), 5u);
  EXPECT_EQ(here.state().state(0), State::kIdle) << "the service still runs";
}

TEST_F(CalibrationStation, ComesBackWithTheNetwork) {
  stop_estimator();
  hosts().cut_cable();
  start_estimator();
  Finder finder(hosts());
  EXPECT_FALSE(finder.wait_for(EntryType::kOffer, 1.2)) << "the cable is disconnected";
  for (int round = 0; round < 2; ++round) {
    hosts().lay_cable();
    finder.forget();
    const std::int64_t begin_ns = runtime::monotonic_now_ns();
    EXPECT_TRUE(finder.wait_for(EntryType::kOffer, 3.0)) << "the cable is connected, round " << round;
    std::printf("offered %.0f ms after the cable was laid\n",
                static_cast<double>(runtime::monotonic_now_ns() - begin_ns) * 1e-6);
    Station here = station();
    EXPECT_EQ(here.state().state(0), State::kIdle);
    if (round == 0) hosts().cut_cable();
  }
}

TEST_F(CalibrationStation, IsNotOfferedUnlessSwitchedOn) {
  stop_estimator();
  write_configuration(false);
  start_estimator();
  Finder finder(hosts());
  finder.find();
  Station here = station();
  here.send(message({.method = 7}, {}));
  EXPECT_FALSE(finder.wait_for(EntryType::kOffer, 1.2));
  EXPECT_FALSE(here.receive(0.1));
}

}  // namespace
}  // namespace boresight::calibration_station
