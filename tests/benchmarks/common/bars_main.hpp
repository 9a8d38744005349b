// The program that all benchmarks with bars are: groups of bars by name, run and reported.
#pragma once

#include <span>

#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench {

struct BarGroup {
  const char* name;
  void (*run)(const Options&, Report&);
};

struct BarsProgram {
  const char* about;
  const char* document;               ///< whose tables --markdown writes
  const char* data_option = nullptr;  ///< option for Options::data_folder; nullptr: there is none
  const char* data_about = nullptr;
  const char* first_seed_about = nullptr;  ///< of --first-seed; nullptr: there is no such option
};

/// For main(): exit code 0 whatever passes, 1 on an error.
[[nodiscard]] int bars_main(int argc, char** argv, const BarsProgram& program, std::span<const BarGroup> groups);

}  // namespace boresight::bench
