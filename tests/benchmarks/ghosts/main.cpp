// boresight-bench-ghosts_bars: how well ghosts are told, by the published method and by the product's own, and what it
// costs, each figure with its bar. See README.md.
#include "tests/benchmarks/common/bars_main.hpp"
#include "tests/benchmarks/ghosts/bars/bars.hpp"

using namespace boresight::bench;

namespace {

constexpr BarGroup kGroups[] = {
    {"highway", highway}, {"scenarios", scenarios}, {"ablation", ablation}, {"plan", plan}, {"cost", cost}};

}  // namespace

int main(int argc, char** argv) {
  return bars_main(argc, argv,
                   {.about = "Each bar of the ghost filter with its figure.",
                    .document = "docs/ghosts.md",
                    .first_seed_about = "seeds from here on; the bars are for 1 on, so tune on others, such as 101"},
                   kGroups);
}
