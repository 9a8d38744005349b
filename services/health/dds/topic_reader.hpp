// Reader of tracks, alignment and services for a tool: delivers samples of the topics to callbacks.
#pragma once

#include <functional>
#include <memory>

#include "generated/alignment_estimate.h"
#include "generated/service_status.h"
#include "generated/track_list.h"
#include "services/health/dds/config.hpp"

namespace boresight::dds {

/// Callbacks run in the middleware's thread, one at a time for each topic. A topic with an empty callback is not read.
class TopicReader {
 public:
  struct Callbacks {
    std::function<void(const perception::TrackList&)> on_tracks;
    std::function<void(const diagnostics::AlignmentEstimate&)> on_alignment;
    std::function<void(const diagnostics::ServiceStatus&)> on_service_status;
  };
  /// Joins the domain; throws std::runtime_error if that is impossible.
  TopicReader(const Config& config, Callbacks callbacks);
  ~TopicReader();

 private:
  class Readers;

  std::unique_ptr<Readers> readers_;
};

}  // namespace boresight::dds
