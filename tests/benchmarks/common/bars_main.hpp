// Common main program of the benchmarks with bars (required values): runs groups of bars by name and reports them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench {

struct BarGroup {
  const char* name;
  void (*run)(const Options&, Report&);
  bool has_profile = false;  ///< its drives use Options::profile and real_car; other groups run if bars are judged only
};

struct BarsProgram {
  const char* about;
  const char* document;               ///< document that receives the tables of --markdown
  const char* data_option = nullptr;  ///< option for Options::data_folder; nullptr: no such option
  const char* data_about = nullptr;
  const char* first_seed_about = nullptr;  ///< help text of --first-seed; nullptr: no such option
  bool has_real_car = false;               ///< option --real-car for Options::real_car
  const char* fresh_seed_about = nullptr;  ///< help text of --fresh-seed; nullptr: no group has fresh seeds
  std::vector<std::string> methods{};      ///< values of --method for Options::method; empty: no such option
};

/// For main(). Exit code 0 also if bars fail, 1 on an error.
[[nodiscard]] int bars_main(int argc, char** argv, const BarsProgram& program, std::span<const BarGroup> groups);

}  // namespace boresight::bench
