// Judges a run by a truth: reads both as the time goes on and gives the judges what belongs together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "services/boresight/score/truth_source.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/judge/figure_list.hpp"

namespace boresight::score {

struct Input {
  std::filesystem::path run;
  TruthSource truth;
  /// Nominal mountings and tolerances; nullptr: alignment and health are not judged.
  const VehicleConfig* vehicle = nullptr;
  /// Called now and then with the time of the run; may throw to end the work.
  std::function<void(double t_s)> progress;
};

struct Score {
  judge::FigureList figures;
  /// What was not judged and why, and what was assumed; sentences for the report.
  std::vector<std::string> notes;
  /// Why nothing could be judged; "" if something was.
  std::string finding;
};

/// Throws InputError for tables that cannot be used.
[[nodiscard]] Score score(const Input& input);

}  // namespace boresight::score
