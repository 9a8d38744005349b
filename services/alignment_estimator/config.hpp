// config/services/alignment_estimator.toml → settings of the service.
#pragma once

#include <string>

#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/station/settings.hpp"
#include "services/common/runtime/config/reader.hpp"

namespace boresight::alignment {

/// The memory over ignition cycles, and its place.
struct MemorySettings {
  bool enabled = true;
  /// "": the file `alignment` in systemd's $STATE_DIRECTORY; without that variable nothing is stored.
  std::string path;
  double period_s = 30.0;
};

struct Settings {
  Config estimator;
  MemorySettings memory;
  station::Settings station;
};

/// Reads the document and the truth file that it names; the environment variable BORESIGHT_TRUTH overrides
/// `truth_file`. Throws config::Error.
[[nodiscard]] Settings read_settings(config::Reader root);

}  // namespace boresight::alignment
