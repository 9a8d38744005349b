// The compared methods by name.
#pragma once

#include <string>
#include <vector>

#include "services/ghost_filter/core/config.hpp"
#include "tests/benchmarks/ghosts/common/changed_method.hpp"

namespace boresight::bench {

struct NamedGhostMethod {
  std::string name;
  ghosts::Config config;
  Change change{};
};

/// All methods of the configuration. The last one is the product's own, to which the bars apply.
[[nodiscard]] inline std::vector<NamedGhostMethod> ghost_methods() {
  std::vector<NamedGhostMethod> methods;
  ghosts::Config published;
  published.method = ghosts::MethodName::kPublished;
  methods.push_back({"published", published, {}});
  ghosts::Config mirror;
  mirror.method = ghosts::MethodName::kMirror;
  methods.push_back({"mirror", mirror, {}});
  return methods;
}

}  // namespace boresight::bench
