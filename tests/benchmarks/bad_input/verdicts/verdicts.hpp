// The verdicts of health.jsonl (config/schema/run.md) on each radar while its data are damaged.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace boresight::bench::bad_input {

/// Times of the damage, seconds since the start of the drive.
struct Window {
  double begin_s = 0.0, end_s = 0.0;
};

/// One radar's verdict from a time on.
struct Verdict {
  double since_s = 0.0;
  bool is_available = false;  ///< AVAILABLE or AVAILABLE_REDUCED INITIALISING: no fault is reported
  std::string words;          ///< "NOT_AVAILABLE BLOCKED"
  std::string reason;         ///< the extended qualifier
};

/// By radar id, in the order of time; a verdict that stays has one entry.
using History = std::map<unsigned, std::vector<Verdict>>;

/// Throws std::runtime_error with file and line.
[[nodiscard]] History read_verdicts(const std::filesystem::path& health_jsonl);

/// How one radar's fault was reported.
struct Outcome {
  double right_after_s = 0.0;  ///< from the begin to the first right reason; infinite: never
  int returns = 0;             ///< to "no fault" during the damage, after a fault was reported
  bool is_right_at_end = false;
  double clear_after_s =
      0.0;  ///< from the end to the last change to "no fault"; infinite: a fault is reported at the end of the drive
  std::string at_end;  ///< verdict at the end of the damage
};

/// `right`: the extended qualifiers that name the fault.
[[nodiscard]] Outcome outcome_of(const std::vector<Verdict>& verdicts, const Window& damage,
                                 const std::set<std::string>& right);

}  // namespace boresight::bench::bad_input
