// What `boresight diagnostics` shows of tracks, alignment and services.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "services/boresight/diagnostics/alignment_text.hpp"
#include "services/boresight/diagnostics/service_text.hpp"
#include "services/boresight/diagnostics/track_text.hpp"

namespace boresight::diagnostics_text {
namespace {

TEST(TopicText, ShowsATrackInOneLine) {
  perception::TrackList list;
  list.vehicle_name("demo");
  list.radar_id(2);
  list.number_of_confirmed_tracks(1);
  perception::Track track;
  track.tracking_id(17);
  track.status(perception::CONFIRMED);
  track.movement(perception::MOVING);
  track.object_class(perception::TRUCK);
  track.position_vehicle_m({40.25F, -3.5F, 0.0F});
  track.heading_rad(std::nanf(""));
  list.tracks().push_back(track);
  const std::string lines = to_lines(list);
  EXPECT_NE(lines.find(" demo: 1 tracks, 1 confirmed, after a scan of radar 2\n"), std::string::npos) << lines;
  EXPECT_NE(lines.find("17 confirmed measured  moving     truck       x   40.25 m  y   -3.50 m"), std::string::npos)
      << lines;
  EXPECT_NE(lines.find("heading "), std::string::npos) << lines;
  EXPECT_EQ(lines.find("nan"), std::string::npos) << lines;
  EXPECT_NE(to_json(list).find(R"("heading_rad":null)"), std::string::npos);
}

TEST(TopicText, ShowsObservableAnglesWithTheirStandardDeviation) {
  diagnostics::AlignmentEstimate estimate;
  estimate.radar_name("front_right");
  estimate.state(diagnostics::ALIGNMENT_CONVERGED);
  estimate.observable(1U << 1);
  estimate.alignment_yaw_rad(0.0436F);
  estimate.covariance()[5] = 0.0004F * 0.0004F;
  estimate.speed_scale(1.012F);
  const std::string line = to_line(estimate);
  EXPECT_NE(line.find("front_right  converged  yaw +2.498 ± 0.023°  speed scale 1.012"), std::string::npos) << line;
  EXPECT_EQ(line.find("pitch"), std::string::npos) << "not observable: " << line;
}

TEST(TopicText, ShowsVerdictAndFaultsOfAService) {
  diagnostics::ServiceStatus status;
  status.service_name("tracker");
  status.condition(diagnostics::CONDITION_DEGRADED);
  status.state(diagnostics::SERVICE_RUNNING);
  status.has_heartbeat(true);
  status.pid(42);
  diagnostics::FaultCount fault;
  fault.name("input lost");
  fault.count(3);
  status.faults() = {fault, diagnostics::FaultCount()};
  const std::string line = to_line(status);
  EXPECT_NE(line.find("tracker              degraded  running  pid 42"), std::string::npos) << line;
  EXPECT_NE(line.find("  input lost: 3"), std::string::npos) << line;
  status.has_heartbeat(false);
  EXPECT_NE(to_line(status).find("no heartbeat"), std::string::npos);
}

TEST(TopicText, ReplacesControlCharactersOfAStranger) {
  const std::string hostile = "x\x1b[2Jx\ny";
  perception::TrackList list;
  list.vehicle_name(hostile);
  list.time_ns(-1);
  diagnostics::AlignmentEstimate estimate;
  estimate.radar_name(hostile);
  diagnostics::ServiceStatus status;
  status.service_name(hostile);
  status.last_fault(hostile);
  status.has_heartbeat(true);
  diagnostics::FaultCount fault;
  fault.name(hostile);
  fault.count(1);
  status.faults().push_back(fault);
  for (const std::string& text : {to_lines(list), to_line(estimate), to_line(status)}) {
    EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_NE(text.find("x?[2Jx?y"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace boresight::diagnostics_text
