// Levels of rt/diagnostics: ERROR is a proven fault, STALE is not known.
#include <gtest/gtest.h>

#include "services/health/dds/to_dds.hpp"

namespace boresight::dds {
namespace {

enum Level : int { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };
constexpr std::size_t kWhole = 0, kRadar = 1, kService = 2;

class DiagnosticLevel : public testing::Test {
 protected:
  DiagnosticLevel() {
    report_.number_of_sensors = 1;
    report_.number_of_services = 1;
    report_.sensors[0].radar_id = 1;
    report_.services[0].condition = ServiceCondition::kAlive;
  }
  void radar_is(DataQualifier qualifier, ExtendedQualifier reason, std::initializer_list<RadarEvent> failed = {}) {
    report_.sensors[0].data_qualifier = qualifier;
    report_.sensors[0].extended_qualifier = reason;
    report_.overall = qualifier;
    for (const RadarEvent event : failed) report_.sensors[0].failed_events |= bit_of(event);
  }
  [[nodiscard]] int level(std::size_t status) const {
    return to_diagnostic_array(report_, VehicleConfig{}, 0).status_().at(status).level_();
  }
  HealthReport report_{};
};

TEST_F(DiagnosticLevel, FollowsTheEffect) {
  radar_is(DataQualifier::kAvailable, ExtendedQualifier::kNormal);
  EXPECT_EQ(level(kRadar), kOk);
  EXPECT_EQ(level(kWhole), kOk);
  radar_is(DataQualifier::kAvailableReduced, ExtendedQualifier::kInitialising);
  EXPECT_EQ(level(kRadar), kWarn);
  EXPECT_EQ(level(kWhole), kWarn);
}

TEST_F(DiagnosticLevel, OfARadarWithoutDataIsStale) {
  radar_is(DataQualifier::kNotAvailable, ExtendedQualifier::kNoData, {RadarEvent::kNoData});
  EXPECT_EQ(level(kRadar), kStale);
  EXPECT_EQ(level(kWhole), kStale) << "nothing is proven to be faulty";
  radar_is(DataQualifier::kNotAvailable, ExtendedQualifier::kInitialising);
  EXPECT_EQ(level(kRadar), kStale);
}

TEST_F(DiagnosticLevel, OfAProvenFaultIsErrorAlsoWithoutData) {
  radar_is(DataQualifier::kNotAvailable, ExtendedQualifier::kBlocked, {RadarEvent::kBlocked});
  EXPECT_EQ(level(kRadar), kError);
  EXPECT_EQ(level(kWhole), kError);
  radar_is(DataQualifier::kNotAvailable, ExtendedQualifier::kNoData, {RadarEvent::kNoData});
  EXPECT_EQ(level(kRadar), kError) << "the sensor reported the blockage before it fell silent";
}

TEST_F(DiagnosticLevel, OfAServiceWithoutHeartbeatIsStale) {
  for (const auto& [condition, expected] :
       {std::pair{ServiceCondition::kUnknown, kStale}, std::pair{ServiceCondition::kSilent, kStale},
        std::pair{ServiceCondition::kDegraded, kWarn}, std::pair{ServiceCondition::kRestarted, kWarn}}) {
    report_.services[0].condition = condition;
    EXPECT_EQ(level(kService), expected) << static_cast<int>(condition);
  }
}

TEST_F(DiagnosticLevel, OfTheWholeIsErrorIfATestOfThePipelineFailed) {
  radar_is(DataQualifier::kNotAvailable, ExtendedQualifier::kNoData, {RadarEvent::kNoData});
  report_.pipeline.failed_events = 1;
  EXPECT_EQ(level(kWhole), kError);
}

TEST_F(DiagnosticLevel, OfEverythingIsStaleAfterTheEnd) {
  radar_is(DataQualifier::kAvailable, ExtendedQualifier::kNormal);
  auto array = to_diagnostic_array(report_, VehicleConfig{}, 0);
  to_ended(array, 1'500'000'000);
  EXPECT_EQ(array.header_().stamp_().sec_(), 1);
  for (const auto& status : array.status_()) {
    EXPECT_EQ(status.level_(), kStale);
    EXPECT_EQ(status.message_(), "the health service ended");
  }
}

}  // namespace
}  // namespace boresight::dds
