// Single precision beside double precision, on the same runs.
#include <algorithm>
#include <string>

#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/tracking/filters/bars/bars.hpp"
#include "tests/benchmarks/tracking/filters/common/errors.hpp"

namespace boresight::bench::filters {

namespace {

template <typename Real>
std::array<std::vector<RunErrors>, kForms> run_all(const std::vector<Run>& runs, std::size_t jobs) {
  std::array<std::vector<RunErrors>, kForms> errors;
  for (std::vector<RunErrors>& form : errors) form.resize(runs.size());
  const Model<Real> the_model = model<Real>();
  parallel_for(runs.size(), jobs, [&](std::size_t i) {
    for_each_form<Real>([&]<typename Filter>(std::size_t form, const Filter&) {
      errors[form][i] = errors_of<Real, Filter>(runs[i], the_model);
    });
  });
  return errors;
}

}  // namespace

void precision(const Options& options, Report& report) {
  constexpr double kBar_percent = 1.0;
  constexpr std::size_t kRuns = 2'000;
  const std::size_t number = options.seeds(kRuns);
  for (const Scene& scene : scenes()) {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < number; ++i) runs.push_back(draw_run(scene, options.fresh_seed + i));
    const auto in_double = run_all<double>(runs, options.jobs);
    const auto in_float = run_all<float>(runs, options.jobs);
    for (std::size_t form = 0; form < kForms; ++form) {
      const Accuracy precise = accuracy_of(in_double[form]), single = accuracy_of(in_float[form]);
      const double worst = (single.rms.cwiseQuotient(precise.rms) - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff();
      const auto failures = std::count_if(in_float[form].begin(), in_float[form].end(),
                                          [](const RunErrors& run) { return run.has_failed; });
      const std::string what = std::string(scene.name) + ", " + kFormNames[form] + ": ";
      const std::string how = "the same " + std::to_string(number) + " runs in both";
      report.at_most("precision", what + "single precision, largest difference of an RMS error from double",
                     100.0 * worst, kBar_percent, "%", how);
      report.at_most("precision", what + "single precision, runs in which the covariance was lost",
                     static_cast<double>(failures), 0.0, "", how);
    }
  }
}

}  // namespace boresight::bench::filters
