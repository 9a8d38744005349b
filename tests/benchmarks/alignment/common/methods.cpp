#include "tests/benchmarks/alignment/common/methods.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "services/alignment_estimator/core/make_method.hpp"
#include "services/alignment_estimator/core/published/published.hpp"

namespace boresight::bench {

namespace {

using alignment::published::Kind;
using alignment::published::PublishedConfig;

std::vector<NamedMethod> published_with(const PublishedConfig& config) {
  constexpr std::pair<const char*, Kind> kKinds[] = {{"steepest_descent", Kind::kSteepestDescent},
                                                     {"nls", Kind::kLeastSquares},
                                                     {"tls", Kind::kTotalLeastSquares},
                                                     {"nelder_mead", Kind::kNelderMead},
                                                     {"azimuth_1d", Kind::kAzimuth1d}};
  std::vector<NamedMethod> methods;
  for (const auto& [name, kind] : kKinds) {
    methods.push_back({name, [kind, config](const VehicleConfig& vehicle) {
                         return alignment::published::make_published(kind, vehicle, config);
                       }});
  }
  return methods;
}

}  // namespace

NamedMethod own_method(std::string_view name) {
  alignment::Config config;
  std::string shown = "boresight";
  if (!name.empty()) {
    const auto known = std::find_if(alignment::kMethodNames.begin(), alignment::kMethodNames.end(),
                                    [&](const auto& entry) { return entry.first == name; });
    if (known == alignment::kMethodNames.end()) throw std::invalid_argument("no alignment method " + std::string(name));
    config.method = known->second;
    shown = name;
  }
  return {shown, [config](const VehicleConfig& vehicle) { return alignment::make_method(vehicle, config); }};
}

std::string own_method_name(std::string_view name) {
  if (!name.empty()) return std::string(name);
  for (const auto& [known, method] : alignment::kMethodNames) {
    if (method == alignment::Config{}.method) return std::string(known);
  }
  throw std::logic_error("the default alignment method has no name");
}

NamedMethod own_method_with_planar_rows() {
  return {"boresight_planar", [](const VehicleConfig& vehicle) {
            alignment::Config config;
            config.method = alignment::MethodName::kBoresightPlanar;
            return alignment::make_method(vehicle, config);
          }};
}

std::vector<NamedMethod> published_methods() {
  return published_with({});
}
std::vector<NamedMethod> published_methods_without_gate() {
  return published_with(alignment::published::as_published());
}

}  // namespace boresight::bench
