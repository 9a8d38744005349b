#include "tests/benchmarks/ghosts/drives/judge/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "services/boresight/fit_evidence/scores.hpp"

namespace boresight::bench::ghosts_drives {

namespace {

constexpr std::size_t kTenths = 10;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double p_of(const JudgedDetection& d, Lane lane) {
  return static_cast<double>(d.p_moving[static_cast<std::size_t>(lane)]);
}

/// The first sum over the second one.
double quotient(const Figure::Sums& sums) {
  return sums[1] > 0.0 ? sums[0] / sums[1] : kNaN;
}

Figure ratio(Lane lane, double (*loss)(double, bool)) {
  return {[lane, loss](const DriveResult& drive) {
            Figure::Sums sums(2);
            for (const JudgedDetection& d : drive.detections) {
              sums[0] += loss(p_of(d, lane), d.is_real);
              sums[1] += loss(static_cast<double>(d.base_rate), d.is_real);
            }
            return sums;
          },
          quotient};
}

/// Share of those that are counted for which `is` holds.
template <typename Counts, typename Is>
Figure share(const Counts& counts, const Is& is) {
  return {[counts, is](const DriveResult& drive) {
            Figure::Sums sums(2);
            for (const JudgedDetection& d : drive.detections) {
              if (!counts(d)) continue;
              sums[0] += is(d) ? 1.0 : 0.0;
              sums[1] += 1.0;
            }
            return sums;
          },
          quotient};
}

/// Index of the probability's bin among `bins` equal ones.
std::size_t bin_of(double p, std::size_t bins) {
  const auto all = static_cast<double>(bins);
  return static_cast<std::size_t>(std::clamp(p * all, 0.0, all - 1.0));
}

void add(const Figure::Sums& sums, Figure::Sums& to) {
  if (to.empty()) to.resize(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) to[i] += sums[i];
}

}  // namespace

double Figure::operator()(const Drives& drives) const {
  Sums all = sums(DriveResult{});
  for (const DriveResult* drive : drives) add(sums(*drive), all);
  return value(all);
}

Estimate estimate(const Figure& figure, const Drives& drives) {
  std::vector<Figure::Sums> each;
  std::vector<double> single;
  for (const DriveResult* drive : drives) {
    each.push_back(figure.sums(*drive));
    const double value = figure.value(each.back());
    if (!std::isnan(value)) single.push_back(value);
  }
  const auto of = [&](const std::vector<std::size_t>& picks) {
    Figure::Sums sums;
    for (const std::size_t pick : picks) add(each[pick], sums);
    return figure.value(sums);
  };
  std::vector<std::size_t> all(drives.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return {of(all), bootstrap(drives.size(), of), median(std::move(single))};
}

Figure brier_ratio(Lane lane) {
  return ratio(lane, fit_evidence::squared_error);
}

Figure log_loss_ratio(Lane lane) {
  return ratio(lane, fit_evidence::log_loss);
}

std::vector<ReliabilityBin> reliability(const Drives& drives, Lane lane) {
  std::vector<ReliabilityBin> bins(kTenths);
  for (const DriveResult* drive : drives) {
    for (const JudgedDetection& d : drive->detections) {
      const double p = p_of(d, lane);
      ReliabilityBin& bin = bins[bin_of(p, kTenths)];
      bin.stated += p;
      bin.real += d.is_real ? 1.0 : 0.0;
      bin.detections += 1.0;
    }
  }
  return bins;
}

Figure calibration_error(Lane lane) {
  // Three sums for each tenth.
  return {[lane](const DriveResult& drive) {
            Figure::Sums sums;
            for (const ReliabilityBin& bin : reliability({&drive}, lane)) {
              sums.insert(sums.end(), {bin.stated, bin.real, bin.detections});
            }
            return sums;
          },
          [](const Figure::Sums& sums) {
            double error = 0.0, all = 0.0;
            for (std::size_t k = 0; k < kTenths; ++k) {
              error += std::abs(sums[3 * k] - sums[3 * k + 1]);
              all += sums[3 * k + 2];
            }
            return all > 0.0 ? error / all : kNaN;
          }};
}

Figure known_lost(Lane lane) {
  constexpr double kKnown_s = 1.0;
  return share([](const JudgedDetection& d) { return static_cast<double>(d.known_s) > kKnown_s; },
               [lane](const JudgedDetection& d) { return p_of(d, lane) < 0.5; });
}

Figure ambiguous_kept(Lane lane) {
  return share([](const JudgedDetection& d) { return d.is_ambiguous && d.known_s >= 0.0F; },
               [lane](const JudgedDetection& d) { return p_of(d, lane) >= 0.5; });
}

Figure recognised_at_90(Lane lane, Provenance origin) {
  constexpr std::size_t kSteps = 10000;
  // Real ones by probability, then false ones.
  return {[lane, origin](const DriveResult& drive) {
            Figure::Sums sums(2 * kSteps);
            for (const JudgedDetection& d : drive.detections) {
              if (!d.is_real && origin != Provenance::kUnknown && d.truth != origin) continue;
              sums[bin_of(p_of(d, lane), kSteps) + (d.is_real ? 0 : kSteps)] += 1.0;
            }
            return sums;
          },
          [](const Figure::Sums& sums) {
            constexpr double kLost = 0.1;
            const auto middle = sums.begin() + static_cast<std::ptrdiff_t>(kSteps);
            const double real = std::accumulate(sums.begin(), middle, 0.0);
            const double all = std::accumulate(middle, sums.end(), 0.0);
            if (real == 0.0 || all == 0.0) return kNaN;
            double lost = 0.0, below = 0.0;
            for (std::size_t k = 0; k < kSteps; ++k) {
              lost += sums[k];
              if (lost > kLost * real) break;
              below += sums[kSteps + k];
            }
            return below / all;
          }};
}

Figure share_of_false(Provenance origin) {
  return share([](const JudgedDetection& d) { return !d.is_real; },
               [origin](const JudgedDetection& d) { return d.truth == origin; });
}

}  // namespace boresight::bench::ghosts_drives
