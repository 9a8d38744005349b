// boresight-bench-ghosts_bars: classification quality and cost of the published method and of the product's own, each
// figure with its bar (required value). See README.md.
#include "tests/benchmarks/common/bars_main.hpp"
#include "tests/benchmarks/ghosts/bars/bars.hpp"

using namespace boresight::bench;

namespace {

constexpr BarGroup kGroups[] = {{"highway", highway, true},
                                {"scenarios", scenarios, true},
                                {"ablation", ablation, true},
                                {"plan", plan, true},
                                {"cost", cost}};

}  // namespace

int main(int argc, char** argv) {
  return bars_main(
      argc, argv,
      {.about = "Measures the ghost filter on simulated drives and compares each figure with its bar (required value).",
       .document = "docs/ghosts.md",
       .first_seed_about = "first seed; the bars use seeds from 1 on, so tune on others, such as 101"},
      kGroups);
}
