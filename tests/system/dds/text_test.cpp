// Samples as lines for people and programs.
#include <gtest/gtest.h>

#include "services/boresight/diagnostics/diagnostics_text.hpp"
#include "services/health/dds/system_health.hpp"
#include "services/health/dds/to_dds.hpp"
#include "tests/system/dds/samples.hpp"

namespace boresight::dds {
namespace {

TEST(DiagnosticsText, StatesAWrongInputInOneSentence) {
  HealthReport with_finding = report();
  SensorHealth& swapped = with_finding.sensors[1];
  swapped.yaw.beyond_tolerance = 0;
  swapped.extended_qualifier = ExtendedQualifier::kWrongInput;
  swapped.reason = AlignmentReason::kWrongInput;
  swapped.finding = AlignmentFinding::kSpeedUnit;
  swapped.finding_value = 3.6F;
  const diagnostics::SensorHealth s = to_sensor_health(with_finding, 1, vehicle(), kTime_ns);
  EXPECT_EQ(s.extended_qualifier(), diagnostics::WRONG_INPUT);
  EXPECT_EQ(s.finding(), "speed_unit");
  const std::string line = diagnostics_text::to_line(s);
  EXPECT_NE(line.find("AVAILABLE_REDUCED WRONG_INPUT"), std::string::npos) << line;
  EXPECT_NE(line.find("speed signal in km/h (3.6 times too large)"), std::string::npos) << line;
  EXPECT_NE(line.find("load changed the vehicle's pitch by +0.78° (nose up)"), std::string::npos) << line;
}

TEST(DiagnosticsText, StatesTheSystemInOneLine) {
  const std::string line = diagnostics_text::to_line(to_system_health(report(), vehicle(), kTime_ns));
  EXPECT_NE(line.find(" system       AVAILABLE_REDUCED  pipeline AVAILABLE_REDUCED  12 scans lost  3 scans at a work "
                      "budget  queueing 31.5 ms  latency p99 62.5 ms  tracker:silent  U1B00-82 U1B00-33"),
            std::string::npos)
      << line;
}

TEST(DiagnosticsText, StatesVerdictErrorsAndDisplacement) {
  const diagnostics::SensorHealth s = to_sensor_health(report(), 1, vehicle(), kTime_ns);
  const std::string line = diagnostics_text::to_line(s);
  for (const char* part :
       {"front_right", "AVAILABLE_REDUCED MISALIGNED", "yaw +2.498 ± 0.023° (reduced, beyond 1.50°)",
        "lost coverage 3.1 %  loss of range 1.2 %  velocity error 0.61 m/s", "lateral displacement +4.36 m at 100 m",
        "20.0 Hz", "reported by the sensor: supply, without ego motion"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
  EXPECT_EQ(line.find("  pitch "), std::string::npos) << "not observable: " << line;
  const std::string json = diagnostics_text::to_json(s);
  EXPECT_NE(json.find(R"("radar":"front_right")"), std::string::npos) << json;
  EXPECT_NE(json.find(R"("extended_qualifier":"MISALIGNED")"), std::string::npos) << json;
  EXPECT_NE(
      json.find(
          R"("suspect_scans":34,"e2e_lost":5,"e2e_repeated":6,"e2e_wrong":7,"conditions":"supply, without ego motion"})"),
      std::string::npos)
      << json;
  const auto array = to_diagnostic_array(report(), vehicle(), kTime_ns);
  const std::string lines = diagnostics_text::to_lines(array);
  EXPECT_NE(lines.find("WARN  boresight/radar/front_right: AVAILABLE_REDUCED MISALIGNED"), std::string::npos) << lines;
  EXPECT_NE(lines.find("STALE boresight/service/tracker: silent"), std::string::npos) << lines;
  EXPECT_EQ(lines.find("front_left"), std::string::npos) << "statuses that are OK are not listed";
}

}  // namespace
}  // namespace boresight::dds
