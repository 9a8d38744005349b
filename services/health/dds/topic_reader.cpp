#include "services/health/dds/topic_reader.hpp"

#include <utility>

#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "generated/alignment_estimatePubSubTypes.h"
#include "generated/service_statusPubSubTypes.h"
#include "generated/track_listPubSubTypes.h"
#include "services/health/dds/guarded_type.hpp"
#include "services/health/dds/participant.hpp"

namespace boresight::dds {

namespace {

template <typename Sample>
class SampleListener : public eprosima::fastdds::dds::DataReaderListener {
 public:
  explicit SampleListener(std::function<void(const Sample&)> callback) : callback_(std::move(callback)) {}

  [[nodiscard]] bool is_wanted() const { return static_cast<bool>(callback_); }

  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
    eprosima::fastdds::dds::SampleInfo info;
    while (reader->take_next_sample(&sample_, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) callback_(sample_);
    }
  }

 private:
  std::function<void(const Sample&)> callback_;
  Sample sample_;
};

}  // namespace

class TopicReader::Readers {
 public:
  Readers(const Config& config, Callbacks callbacks)
      : tracks_(std::move(callbacks.on_tracks)),
        alignment_(std::move(callbacks.on_alignment)),
        service_status_(std::move(callbacks.on_service_status)),
        participant_(config, "boresight") {
    if (tracks_.is_wanted()) {
      participant_.reader(kTrackListTopic, guarded<perception::TrackListPubSubType>(kTrackListTopic), &tracks_);
    }
    if (alignment_.is_wanted()) {
      participant_.reader(kAlignmentTopic, guarded<diagnostics::AlignmentEstimatePubSubType>(kAlignmentTopic),
                          &alignment_);
    }
    if (service_status_.is_wanted()) {
      participant_.reader(kServiceStatusTopic, guarded<diagnostics::ServiceStatusPubSubType>(kServiceStatusTopic),
                          &service_status_);
    }
  }

 private:
  SampleListener<perception::TrackList> tracks_;
  SampleListener<diagnostics::AlignmentEstimate> alignment_;
  SampleListener<diagnostics::ServiceStatus> service_status_;
  Participant participant_;  // last member: its destructor stops the listeners first
};

TopicReader::TopicReader(const Config& config, Callbacks callbacks)
    : readers_(std::make_unique<Readers>(config, std::move(callbacks))) {}

TopicReader::~TopicReader() = default;

}  // namespace boresight::dds
