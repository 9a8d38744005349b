// Every form beside the recorded states of another implementation, to 1e-9.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/tracker/filters_support.hpp"

namespace boresight::tracking::filters {
namespace {

const std::filesystem::path kData = std::filesystem::path(BORESIGHT_SHARED_DATA) / "srukf";

/// Rows of the first `N` numbers after the step.
template <int N>
std::vector<Vector<double, N>> read_rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<Vector<double, N>> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    Vector<double, N> row;
    for (int i = 0; i < N && std::getline(cells, cell, ','); ++i) row(i) = std::stod(cell);
    rows.push_back(row);
  }
  return rows;
}

template <typename Filter>
void expect_golden(const std::string& scene, const std::string& filter) {
  SCOPED_TRACE(scene + " " + filter);
  testing::Run run;
  run.measured = read_rows<3>(kData / ("golden_" + scene + "_meas.csv"));
  const std::vector<testing::Vector6> golden = read_rows<6>(kData / ("golden_" + scene + "_" + filter + "_a1.csv"));
  ASSERT_EQ(run.measured.size(), 200U);
  ASSERT_EQ(golden.size(), 199U);
  double worst = 0.0;
  const bool succeeds = testing::follow<Filter, double>(run, [&](std::size_t k, const Filter& f) {
    worst = std::max(worst, (f.gaussian().mean - golden[k - 1]).cwiseAbs().maxCoeff());
  });
  EXPECT_TRUE(succeeds);
  EXPECT_LT(worst, 1e-9);
}

TEST(GoldenStates, AreThoseOfEachFilter) {
  if (!std::filesystem::exists(kData)) GTEST_SKIP() << "skipped: no shared data";
  for (const std::string scene : {"approach", "crossing"}) {
    expect_golden<ExtendedKalman<double, 6>>(scene, "ekf");
    expect_golden<Unscented<double, 6>>(scene, "ukf");
    expect_golden<SquareRootUnscented<double, 6>>(scene, "srukf");
    expect_golden<testing::Published<double>>(scene, "fast_srukf_qr");
    expect_golden<testing::CovarianceForm<double>>(scene, "fast_srukf_qr");
    expect_golden<testing::PureRoot<double>>(scene, "fast_srukf_qr");
  }
}

}  // namespace
}  // namespace boresight::tracking::filters
