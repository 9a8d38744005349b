// config/services/alignment_estimator.toml → what the service runs with.
#pragma once

#include <string>

#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/station/settings.hpp"
#include "services/common/runtime/config/reader.hpp"

namespace boresight::alignment {

/// What survives the ignition cycle, and where.
struct MemorySettings {
  bool enabled = true;
  /// "": `alignment` in the folder that systemd names in $STATE_DIRECTORY; without one nothing is remembered.
  std::string path;
  double period_s = 30.0;
};

struct Settings {
  Config estimator;
  MemorySettings memory;
  station::Settings station;
};

/// Reads the document, and the truth that it names; the environment variable BORESIGHT_TRUTH overrides `truth_file`.
/// Throws config::Error.
[[nodiscard]] Settings read_settings(config::Reader root);

}  // namespace boresight::alignment
