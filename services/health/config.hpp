// config/services/health.toml
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/health/core/config.hpp"
#include "services/health/dds/config.hpp"

namespace boresight::health {

/// What begins an operation cycle of the fault memory.
enum class OperationCycle : std::uint8_t {
  kBoot,   ///< a boot of the ECU
  kStart,  ///< a start of the service
};

struct FaultStoreConfig {
  bool enabled = true;
  /// "": the file `fault_memory` in systemd's $STATE_DIRECTORY; without that variable nothing is stored.
  std::string path;
  OperationCycle operation_cycle = OperationCycle::kBoot;
};

struct LevelStoreConfig {
  bool enabled = true;
  /// "": the file `levels` in systemd's $STATE_DIRECTORY; without that variable nothing is stored.
  std::string path;
  double first_write_s = 3.0;    ///< after a start; each wait is twice the last, up to the period (choice: likewise)
  double write_period_s = 60.0;  ///< while something is learnt (choice: motion that a power cut may cost, against wear)
};

struct FileConfig {
  Config supervision;
  FaultStoreConfig fault_store;
  LevelStoreConfig level_store;
  dds::Config dds;
};

/// Throws config::Error. BORESIGHT_DDS_DOMAIN in the environment takes precedence over the file's domain.
[[nodiscard]] FileConfig read_config(config::Reader root);

/// BORESIGHT_DDS_DOMAIN of the environment, or `fallback`. Throws config::Error if it is no number from 0 to 232.
[[nodiscard]] std::uint32_t domain_from_environment(std::uint32_t fallback);

}  // namespace boresight::health
