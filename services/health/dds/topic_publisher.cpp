#include "services/health/dds/topic_publisher.hpp"

#include <algorithm>

#include <fastdds/dds/publisher/DataWriter.hpp>

#include "generated/alignment_estimatePubSubTypes.h"
#include "generated/service_statusPubSubTypes.h"
#include "generated/track_listPubSubTypes.h"
#include "services/health/dds/alignment.hpp"
#include "services/health/dds/guarded_type.hpp"
#include "services/health/dds/service_status.hpp"
#include "services/health/dds/track_list.hpp"

namespace boresight::dds {

namespace {

bool has_reader(const eprosima::fastdds::dds::DataWriter& writer) {
  eprosima::fastdds::dds::PublicationMatchedStatus status;
  writer.get_publication_matched_status(status);
  return status.current_count > 0;
}

}  // namespace

struct TopicPublisher::Samples {
  perception::TrackList tracks;
  diagnostics::AlignmentEstimate alignment;
  diagnostics::ServiceStatus service;
};

TopicPublisher::TopicPublisher(Participant& participant, const Config& config, const VehicleConfig& vehicle)
    : vehicle_(vehicle),
      samples_(std::make_unique<Samples>()),
      track_pace_(config.tracks_period_s),
      tracks_(config.tracks
                  ? &participant.writer(kTrackListTopic, guarded<perception::TrackListPubSubType>(kTrackListTopic))
                  : nullptr),
      alignment_(
          participant.writer(kAlignmentTopic, guarded<diagnostics::AlignmentEstimatePubSubType>(kAlignmentTopic))),
      service_status_(
          participant.writer(kServiceStatusTopic, guarded<diagnostics::ServiceStatusPubSubType>(kServiceStatusTopic))) {
  samples_->tracks.tracks().reserve(kMaxTracks);
  for (Radar& radar : radars_) radar.pace = Pace(config.period_s);
}

TopicPublisher::~TopicPublisher() = default;

void TopicPublisher::take(const TrackList& list, Now now) {
  if (tracks_ == nullptr || !track_pace_.take(now.monotonic_ns)) return;
  if (waiting_lists_ == lists_->size()) {
    first_list_ = (first_list_ + 1) % lists_->size();
    --waiting_lists_;
  }
  List& place = (*lists_)[(first_list_ + waiting_lists_++) % lists_->size()];
  place.list = list;
  place.at = now;
}

void TopicPublisher::take(const AlignmentEstimate& estimate, Now now) {
  if (estimate.header.source_id >= radars_.size()) return;
  Radar& radar = radars_[estimate.header.source_id];
  const AlignmentEvent event{.state = estimate.state,
                             .finding = estimate.finding,
                             .is_drifting = estimate.drift.since_ns != 0,
                             .step_changes = estimate.step_change.count,
                             .load_changes = estimate.load_change.count,
                             .speed_changes = estimate.speed_change.count};
  if (!radar.pace.take(now.monotonic_ns, radar.taken != event)) return;
  radar.taken = event;
  radar.estimate = estimate;
  radar.at = now;
  radar.is_due = true;
}

void TopicPublisher::take(const ServiceStatus& status, Now now) {
  if (status.header.source_id >= services_.size()) return;
  Service& service = services_[status.header.source_id];
  const bool is_news = !service.has_status || service.status.state != status.state ||
                       service.status.incarnation_ns != status.incarnation_ns;
  service.status = status;
  service.has_status = true;
  // Without a verdict there is nothing to send yet.
  if (!is_news || !service.has_health) return;
  service.at = now;
  service.is_due = true;
}

bool TopicPublisher::send() {
  bool is_taken = write_lists();
  for (Radar& radar : radars_) {
    if (!radar.is_due) continue;
    radar.is_due = false;
    fill(samples_->alignment, radar.estimate, vehicle_, radar.at.epoch_ns);
    is_taken = alignment_.write(&samples_->alignment) && is_taken;
  }
  for (Service& service : services_) {
    if (!service.is_due) continue;
    service.is_due = false;
    is_taken = write_service(service, service.at) && is_taken;
  }
  return is_taken;
}

bool TopicPublisher::write_lists() {
  if (waiting_lists_ == 0) return true;
  bool is_taken = true;
  const bool is_read = has_reader(*tracks_);
  for (; waiting_lists_ > 0; --waiting_lists_, first_list_ = (first_list_ + 1) % lists_->size()) {
    if (!is_read) continue;
    const auto& [list, at] = (*lists_)[first_list_];
    const std::int64_t age_ns = at.monotonic_ns - list.header.measurement_time_ns;
    fill(samples_->tracks, list, vehicle_.name, at.epoch_ns - age_ns);
    is_taken = tracks_->write(&samples_->tracks) && is_taken;
  }
  return is_taken;
}

bool TopicPublisher::write(const HealthReport& report, Now now) {
  bool is_taken = true;
  const std::size_t services = std::min<std::size_t>(report.number_of_services, kMaxServices);
  for (std::size_t i = 0; i < services; ++i) {
    const ServiceHealth& health = report.services[i];
    if (health.service >= services_.size()) continue;
    Service& service = services_[health.service];
    service.health = health;
    service.has_health = true;
    is_taken = write_service(service, now) && is_taken;
  }
  return is_taken;
}

void TopicPublisher::end() {
  const eprosima::fastrtps::rtps::InstanceHandle_t by_key;
  // The writer disposes what it unregisters.
  for (const Service& service : services_) {
    if (!service.has_health) continue;
    fill(samples_->service, service.health, nullptr, vehicle_.name, 0);
    service_status_.unregister_instance(&samples_->service, by_key);
  }
}

bool TopicPublisher::write_service(const Service& service, Now now) {
  fill(samples_->service, service.health, service.has_status ? &service.status : nullptr, vehicle_.name, now.epoch_ns);
  return service_status_.write(&samples_->service);
}

}  // namespace boresight::dds
