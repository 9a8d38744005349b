// A stage that starts before RouDi and before all peers waits, and works when they start.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::Service;
using catalogue::TopicId;
using harness::Observer;

struct Early {
  Service service;
  TopicId output;
};

class StartedBeforePeers : public testing::TestWithParam<Early> {};

TEST_P(StartedBeforePeers, WaitsAndThenWorks) {
  const std::string name(catalogue::name_of(GetParam().service));
  const auto recordings = harness::simulated_drive(3.0);
  const auto early = harness::start_alone(name);
  EXPECT_EQ(early->wait_for(1.0), std::nullopt) << "it ended without RouDi";
  Observer observer("-story");
  harness::Domain domain("demo", {name});
  domain.start();
  ASSERT_TRUE(domain.until(5.0, [&] { return observer.is_attached(); }));
  domain.replay(recordings);
  ASSERT_TRUE(domain.until(15.0, [&] { return domain.replay_has_ended(); }));
  domain.run_for(0.3);
  const std::size_t scans = observer.of(TopicId::kRadarScan).size();
  EXPECT_GE(scans, 4 * 58u);
  if (GetParam().output == TopicId::kTrackList || GetParam().output == TopicId::kCorrectedScan) {
    EXPECT_EQ(observer.of(GetParam().output).size(), scans) << "a scan is missing in its output";
  } else {
    EXPECT_GE(observer.of(GetParam().output).size(), 30u);
  }
  EXPECT_EQ(observer.of(TopicId::kTrackList).size(), scans) << "not every scan became a track list";
  EXPECT_EQ(early->stop(), 0);
  EXPECT_EQ(observer.process().stop(), 0);
}

INSTANTIATE_TEST_SUITE_P(Each, StartedBeforePeers,
                         testing::Values(Early{Service::kTracker, TopicId::kTrackList},
                                         Early{Service::kDetectionCorrector, TopicId::kCorrectedScan},
                                         Early{Service::kIngestGateway, TopicId::kRadarScan},
                                         Early{Service::kHealth, TopicId::kHealthReport}),
                         [](const auto& info) { return std::string(catalogue::name_of(info.param.service)); });

}  // namespace
}  // namespace boresight
