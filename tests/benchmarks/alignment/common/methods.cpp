#include "tests/benchmarks/alignment/common/methods.hpp"

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

NamedMethod own_method() {
  return {"boresight",
          [](const VehicleConfig& vehicle) { return alignment::make_method(vehicle, alignment::Config{}); }};
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
