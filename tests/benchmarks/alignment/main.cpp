// boresight-bench-alignment_bars: the accuracy, consistency and cost of the alignment estimator; each figure with
// the bar that it must meet. See README.md.
#include "services/alignment_estimator/core/config.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/common/bars_main.hpp"

using namespace boresight::bench;

namespace {

// clang-format off
constexpr BarGroup kGroups[] = {
    {"clean", clean},
    {"disturbed", disturbed},
    {"roll", roll},
    {"consistency", consistency},
    {"degenerate", degenerate},
    {"cramer_rao", cramer_rao},
    {"time_to_95", time_to_95_percent},
    {"published", published},
    {"published_optimum", published_optimum},
    {"published_filter", published_filter},
    {"outliers", outliers},
    {"step_change", step_change},
    {"cost", cost},
    {"plate", plate},
    {"drive_1", drive_1},
    {"real_car", real_car},
    {"real_car_published", real_car_published},
    {"real_car_drift", real_car_drift},
    {"real_car_no_change", real_car_no_change},
    {"real_car_changes", real_car_changes},
    {"real_car_load", real_car_load},
    {"world", world, true},
};
// clang-format on

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& entry : boresight::alignment::kMethodNames) names.emplace_back(entry.first);
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  return bars_main(argc, argv,
                   {.about = "Each bar (limit) of the alignment estimator with the measured figure.",
                    .document = "docs/alignment.md",
                    .data_option = "--drive-data",
                    .data_about = "folder of drive_1.csv.xz, ego_1.csv and truth_1.txt",
                    .first_seed_about = "first seed of the group world; the other groups have fixed seeds",
                    .has_real_car = true,
                    .fresh_seed_about = "first seed of the groups real_car…; drawn for each run if not given",
                    .methods = method_names()},
                   kGroups);
}
