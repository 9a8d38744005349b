// A folder that holds a drive and the true origins of its detections.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "services/boresight/score/truth_source.hpp"

namespace boresight::fit_evidence {

struct LabelledDrive {
  std::string name;                               ///< of the folder
  std::string seed;                               ///< of a simulated drive, as truth.csv states it; "": not stated
  std::filesystem::path folder;                   ///< as given
  std::vector<std::filesystem::path> recordings;  ///< pcap, pcapng and candump logs, by name; empty: tables
  std::filesystem::path detections, ego;          ///< tables (config/schema/tables.md)
  score::TruthSource truth;                       ///< with `detections`

  [[nodiscard]] bool has_tables() const { return recordings.empty(); }
};

/// The tables detections.csv and ego.csv of the folder, else its recordings *.pcap, *.pcapng and *.log, and the truth
/// (config/schema/truth.md). Throws score::InputError, which names what is absent.
[[nodiscard]] LabelledDrive find_labelled_drive(const std::filesystem::path& folder);

}  // namespace boresight::fit_evidence
