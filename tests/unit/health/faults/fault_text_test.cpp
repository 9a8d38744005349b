#include "services/boresight/diagnostics/fault_text.hpp"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>

#include "services/health/core/faults/status.hpp"
#include "services/health/dds/fault_memory_server.hpp"

namespace boresight::diagnostics_text {
namespace {

using testing::HasSubstr;
using testing::Not;

diagnostics::FaultRecord example() {
  VehicleConfig vehicle;
  RadarConfig radar;
  radar.id = 2;
  radar.name = "front\x1b[31m_right";
  vehicle.radars.push_back(radar);
  health::FaultRecord record{.event = {health::kind_of(RadarEvent::kYawMisaligned), 2},
                             .status = {},
                             .debounce = {},
                             .first = {},
                             .latest = {}};
  record.status.take(health::TestResult::kFailed, {});
  record.latest.time_ns = 1'700'000'000'000'000'000;
  record.latest.speed_mps = 13.9F;
  record.latest.reference_range_m = 100.0F;
  record.latest.lateral_displacement_m = 4.36F;
  record.latest.lost_coverage_ratio = 0.031F;
  record.latest.range_loss_ratio = 0.012F;
  record.latest.velocity_error_mps = 0.61F;
  record.latest.estimate = {1.01F, 0.0436F, 0.0F, 0.0F};
  record.latest.covariance[4] = 1e-6F;  // variance of the yaw
  return dds::to_fault_record(record, vehicle);
}

TEST(FaultText, ListsAndShowsARecordWithoutControlCharacters) {
  const std::string list = fault_list({example()}, "demo: operation cycle 1, 1 stored");
  EXPECT_THAT(list, HasSubstr("C1D02-78"));
  EXPECT_THAT(list, HasSubstr("failed, confirmed, pending, warning"));
  const std::string page = fault_page(example());
  EXPECT_THAT(page, HasSubstr("yaw                         2.498 ± 0.057°"));
  EXPECT_THAT(page, HasSubstr("4.36 m at 100 m"));
  EXPECT_THAT(page, HasSubstr("lost coverage               3.1 %"));
  EXPECT_THAT(page, HasSubstr("loss of range               1.2 %"));
  EXPECT_THAT(page, HasSubstr("velocity error              0.61 m/s"));
  EXPECT_THAT(page, HasSubstr("13.90 m/s"));
  EXPECT_THAT(list + page, Not(HasSubstr("\x1b")));
}

TEST(FaultText, WordsOfTheStatusByte) {
  using namespace health::dtc_status;
  EXPECT_EQ(status_text(kCleared), "not tested in this cycle");
  EXPECT_EQ(status_text(kConfirmed), "passed, confirmed");
  EXPECT_EQ(status_text(kTestFailed | kPending), "failed, pending");
}

TEST(FaultText, TheTableOfTroubleCodesIsInTheManual) {
  std::ifstream stream(BORESIGHT_SOURCE_DIR "/docs/operations.md");
  const std::string page((std::istreambuf_iterator<char>(stream)), {});
  EXPECT_THAT(page, HasSubstr(dtc_table())) << "paste the output of `boresight dtc table`";
}

}  // namespace
}  // namespace boresight::diagnostics_text
