#include "services/boresight/run/settings.hpp"

#include <iterator>

#include "services/alignment_estimator/config.hpp"
#include "services/detection_corrector/config.hpp"
#include "services/ghost_filter/config.hpp"
#include "services/health/config.hpp"
#include "services/ingest_gateway/config.hpp"
#include "services/tracker/config.hpp"

namespace boresight::run {

Settings read_settings(const runtime::Configuration& configuration, const VehicleConfig& vehicle) {
  const auto open = [&](std::string_view service) { return config::Reader::open(configuration.service_file(service)); };
  return {.estimator = alignment::read_settings(open("alignment_estimator")).estimator,
          .corrector = corrector::read_config(open("detection_corrector")),
          .ghosts = ghosts::read_config(configuration, vehicle),
          .tracker = tracking::read_config(configuration),
          .health = health::read_config(open("health")).supervision,
          .contradiction = ingest::read_config(open("ingest_gateway")).contradiction};
}

std::vector<std::pair<std::string, std::string>> settings_files(const runtime::Configuration& configuration) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const char* const service : {"ingest_gateway", "alignment_estimator", "detection_corrector", "ghost_filter",
                                    "tracker", "object_classes", "health"}) {
    files.emplace_back(service, configuration.service_file(service).string());
  }
  const auto health = std::prev(files.end());  // the classes stay beside each other
  files.emplace(health, "object_forest", tracking::forest_file(configuration).string());
  return files;
}

}  // namespace boresight::run
