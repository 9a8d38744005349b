#include "services/boresight/commands/diagnostics_topics.hpp"

#include "services/boresight/diagnostics/alignment_text.hpp"
#include "services/boresight/diagnostics/service_text.hpp"
#include "services/boresight/diagnostics/track_text.hpp"

namespace boresight {

void add_topic_options(CLI::App& command, TopicChoice& choice, CLI::Option* other) {
  command.add_flag("--tracks", choice.tracks, "Prints the track lists, boresight/track_list, instead of health")
      ->excludes(other);
  command
      .add_flag("--alignment", choice.alignment,
                "Prints the alignment estimates, boresight/alignment_estimate, instead of health")
      ->excludes(other);
  command
      .add_flag("--services", choice.services,
                "Prints the status of the services, boresight/service_status, instead of health")
      ->excludes(other);
}

dds::TopicReader::Callbacks printing(const TopicChoice& choice, bool is_json,
                                     const std::function<void(const std::string&)>& print) {
  dds::TopicReader::Callbacks callbacks;
  if (choice.tracks) {
    callbacks.on_tracks = [is_json, print](const perception::TrackList& list) {
      print(is_json ? diagnostics_text::to_json(list) : diagnostics_text::to_lines(list) + "\n");
    };
  }
  if (choice.alignment) {
    callbacks.on_alignment = [is_json, print](const diagnostics::AlignmentEstimate& estimate) {
      print(is_json ? diagnostics_text::to_json(estimate) : diagnostics_text::to_line(estimate) + "\n");
    };
  }
  if (choice.services) {
    callbacks.on_service_status = [is_json, print](const diagnostics::ServiceStatus& status) {
      print(is_json ? diagnostics_text::to_json(status) : diagnostics_text::to_line(status) + "\n");
    };
  }
  return callbacks;
}

}  // namespace boresight
