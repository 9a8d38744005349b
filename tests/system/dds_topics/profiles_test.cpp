// The shipped profiles fit the topics: a reader that is made from them receives.
#include <memory>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <gtest/gtest.h>

#include "generated/alignment_estimatePubSubTypes.h"
#include "generated/service_statusPubSubTypes.h"
#include "generated/track_listPubSubTypes.h"
#include "services/health/dds/topic_publisher.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::dds {
namespace {

namespace fast = eprosima::fastdds::dds;
constexpr std::uint32_t kDomain = 75;

double seconds_of(const eprosima::fastrtps::Duration_t& duration) {
  return static_cast<double>(duration.to_ns()) * 1e-9;
}

/// A participant, a publisher and a subscriber of the shipped profiles.
class Profiles : public testing::Test {
 protected:
  void SetUp() override {
    auto* const factory = fast::DomainParticipantFactory::get_instance();
    ASSERT_EQ(factory->load_XML_profiles_file(BORESIGHT_SOURCE_DIR "/config/dds/fastdds_profiles.xml"),
              ReturnCode_t::RETCODE_OK);
    participant_ = factory->create_participant_with_profile(kDomain, "boresight");
    ASSERT_NE(participant_, nullptr);
    subscriber_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
    publisher_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
  }
  void TearDown() override {
    if (participant_ == nullptr) return;
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  template <typename PubSubType>
  fast::DataReader* reader(const TopicQos& topic) {
    const fast::TypeSupport type(new PubSubType());
    type.register_type(participant_);
    fast::Topic* const made = participant_->create_topic(topic.name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
    return subscriber_->create_datareader_with_profile(made, topic.name);
  }

  fast::DomainParticipant* participant_ = nullptr;
  fast::Subscriber* subscriber_ = nullptr;
  fast::Publisher* publisher_ = nullptr;
};

TEST_F(Profiles, RequestWhatTheWritersOfferForEveryTopic) {
  const Config config;
  for (const TopicQos& topic : kTopics) {
    if (topic.name == std::string_view(kCommandTopic.name)) {
      fast::DataWriterQos qos;
      ASSERT_EQ(publisher_->get_datawriter_qos_from_profile(topic.name, qos), ReturnCode_t::RETCODE_OK) << topic.name;
      EXPECT_EQ(qos.reliability().kind, fast::RELIABLE_RELIABILITY_QOS);
      EXPECT_EQ(qos.durability().kind, fast::VOLATILE_DURABILITY_QOS);
      continue;
    }
    fast::DataReaderQos qos;
    ASSERT_EQ(subscriber_->get_datareader_qos_from_profile(topic.name, qos), ReturnCode_t::RETCODE_OK) << topic.name;
    EXPECT_EQ(qos.reliability().kind == fast::RELIABLE_RELIABILITY_QOS, topic.reliability == Reliability::kReliable)
        << topic.name;
    EXPECT_EQ(qos.durability().kind == fast::TRANSIENT_LOCAL_DURABILITY_QOS,
              topic.durability == Durability::kTransientLocal)
        << topic.name;
    EXPECT_EQ(qos.history().depth, topic.read_depth) << topic.name;
    const double period_s = topic.period_s > 0.0 ? topic.period_s : config.period_s;
    for (const auto& [offered_periods, requested] : {std::pair{topic.deadline_periods, qos.deadline().period},
                                                     std::pair{topic.lease_periods, qos.liveliness().lease_duration}}) {
      if (offered_periods > 0.0) {
        EXPECT_EQ(seconds_of(requested), 2.0) << topic.name;
        EXPECT_LE(offered_periods * period_s, 2.0) << topic.name;
      } else {
        EXPECT_EQ(requested, eprosima::fastrtps::c_TimeInfinite) << topic.name << ": not offered";
      }
    }
  }
}

TEST_F(Profiles, ReceiveTracksAlignmentAndServices) {
  Config config;
  config.domain = kDomain;
  config.tracks_period_s = 0.0;
  Participant writer(config, "test");
  VehicleConfig vehicle;
  vehicle.name = "test car";
  TopicPublisher topics(writer, config, vehicle);
  fast::DataReader* const track_reader = reader<perception::TrackListPubSubType>(kTrackListTopic);
  fast::DataReader* const alignment_reader = reader<diagnostics::AlignmentEstimatePubSubType>(kAlignmentTopic);
  fast::DataReader* const service_reader = reader<diagnostics::ServiceStatusPubSubType>(kServiceStatusTopic);
  ASSERT_TRUE(track_reader != nullptr && alignment_reader != nullptr && service_reader != nullptr);

  const auto list = std::make_unique<TrackList>();
  list->number_of_tracks = kMaxTracks;
  for (std::uint32_t i = 0; i < kMaxTracks; ++i) list->tracks[i].tracking_id = i + 1;
  AlignmentEstimate estimate{};
  estimate.header.source_id = 3;
  estimate.alignment_yaw_rad = 0.0436F;
  const auto report = std::make_unique<HealthReport>();
  report->number_of_services = 1;
  report->services[0].service = 4;
  perception::TrackList got_list;
  diagnostics::AlignmentEstimate got_estimate;
  diagnostics::ServiceStatus got_status;
  fast::SampleInfo info;
  bool has_list = false, has_estimate = false, has_status = false;
  topics.take(estimate, Now{1, 1});
  ASSERT_TRUE(topics.send());
  ASSERT_TRUE(topics.write(*report, Now{1, 1}));
  EXPECT_TRUE(harness::eventually(
      10.0,
      [&] {
        topics.take(*list, Now{1, 1});
        EXPECT_TRUE(topics.send());
        has_list = has_list || track_reader->take_next_sample(&got_list, &info) == ReturnCode_t::RETCODE_OK;
        has_estimate =
            has_estimate || alignment_reader->take_next_sample(&got_estimate, &info) == ReturnCode_t::RETCODE_OK;
        has_status = has_status || service_reader->take_next_sample(&got_status, &info) == ReturnCode_t::RETCODE_OK;
        return has_list && has_estimate && has_status;
      }))
      << has_list << has_estimate << has_status;
  ASSERT_EQ(got_list.tracks().size(), kMaxTracks);
  EXPECT_EQ(got_list.tracks().back().tracking_id(), kMaxTracks);
  EXPECT_EQ(got_estimate.alignment_yaw_rad(), 0.0436F);
  EXPECT_EQ(got_status.service_name(), "tracker");
}

}  // namespace
}  // namespace boresight::dds
