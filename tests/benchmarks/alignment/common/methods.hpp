// The methods by the names that configuration and the offline tool use.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/benchmarks/alignment/common/runner.hpp"

namespace boresight::bench {

struct NamedMethod {
  std::string name;  ///< "nelder_mead"
  MakeMethod make;
};

/// Boresight's own estimator with its shipped settings. With a name: that method instead, so that it can be judged
/// before it is the default. Throws std::invalid_argument for an unknown name.
[[nodiscard]] NamedMethod own_method(std::string_view name = {});
/// As in configuration: the given name, or that of the product's default.
[[nodiscard]] std::string own_method_name(std::string_view name);
/// Boresight's filter with the rows of Burza's planar model, for data that follow it.
[[nodiscard]] NamedMethod own_method_with_planar_rows();
/// The published methods with their published constants, in the order of Burza 2025; with the gate against moving
/// objects.
[[nodiscard]] std::vector<NamedMethod> published_methods();
/// The published methods without that gate: every detection counts.
[[nodiscard]] std::vector<NamedMethod> published_methods_without_gate();

}  // namespace boresight::bench
