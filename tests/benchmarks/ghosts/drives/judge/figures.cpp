#include "tests/benchmarks/ghosts/drives/judge/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::bench::ghosts_drives {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double p_of(const JudgedDetection& d, Lane lane) {
  return static_cast<double>(d.p_moving[static_cast<std::size_t>(lane)]);
}

template <typename Visit>
void visit(const Drives& drives, const Visit& each) {
  for (const DriveResult* drive : drives) {
    for (const JudgedDetection& d : drive->detections) each(d);
  }
}

double squared_error(double p, bool is_real) {
  const double error = p - (is_real ? 1.0 : 0.0);
  return error * error;
}

double log_loss(double p, bool is_real) {
  constexpr double kLeast = 1e-4;
  const double clamped = std::clamp(p, kLeast, 1.0 - kLeast);
  return -std::log(is_real ? clamped : 1.0 - clamped);
}

Figure ratio(Lane lane, double (*loss)(double, bool)) {
  return [lane, loss](const Drives& drives) {
    double of_lane = 0.0, of_base = 0.0;
    visit(drives, [&](const JudgedDetection& d) {
      of_lane += loss(p_of(d, lane), d.is_real);
      of_base += loss(static_cast<double>(d.base_rate), d.is_real);
    });
    return of_base > 0.0 ? of_lane / of_base : kNaN;
  };
}

/// Share of those that are counted for which `is` holds.
template <typename Counts, typename Is>
Figure share(const Counts& counts, const Is& is) {
  return [counts, is](const Drives& drives) {
    double all = 0.0, so = 0.0;
    visit(drives, [&](const JudgedDetection& d) {
      if (!counts(d)) return;
      all += 1.0;
      so += is(d) ? 1.0 : 0.0;
    });
    return all > 0.0 ? so / all : kNaN;
  };
}

}  // namespace

Figure brier_ratio(Lane lane) {
  return ratio(lane, squared_error);
}

Figure log_loss_ratio(Lane lane) {
  return ratio(lane, log_loss);
}

std::vector<ReliabilityBin> reliability(const Drives& drives, Lane lane) {
  constexpr std::size_t kBins = 10;
  std::vector<ReliabilityBin> bins(kBins);
  visit(drives, [&](const JudgedDetection& d) {
    const double p = p_of(d, lane);
    ReliabilityBin& bin = bins[static_cast<std::size_t>(std::clamp(p * kBins, 0.0, kBins - 1.0))];
    bin.stated += p;
    bin.real += d.is_real ? 1.0 : 0.0;
    bin.detections += 1.0;
  });
  return bins;
}

Figure calibration_error(Lane lane) {
  return [lane](const Drives& drives) {
    double error = 0.0, all = 0.0;
    for (const ReliabilityBin& bin : reliability(drives, lane)) {
      error += std::abs(bin.stated - bin.real);
      all += bin.detections;
    }
    return all > 0.0 ? error / all : kNaN;
  };
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
  return [lane, origin](const Drives& drives) {
    constexpr double kLost = 0.1;
    std::vector<double> real;
    visit(drives, [&](const JudgedDetection& d) {
      if (d.is_real) real.push_back(p_of(d, lane));
    });
    if (real.empty()) return kNaN;
    const auto place = real.begin() + static_cast<std::ptrdiff_t>(kLost * static_cast<double>(real.size()));
    std::nth_element(real.begin(), place, real.end());
    const double threshold = *place;
    double all = 0.0, below = 0.0;
    visit(drives, [&](const JudgedDetection& d) {
      if (d.is_real || (origin != Provenance::kUnknown && d.truth != origin)) return;
      all += 1.0;
      below += p_of(d, lane) < threshold ? 1.0 : 0.0;
    });
    return all > 0.0 ? below / all : kNaN;
  };
}

Figure share_of_false(Provenance origin) {
  return share([](const JudgedDetection& d) { return !d.is_real; },
               [origin](const JudgedDetection& d) { return d.truth == origin; });
}

}  // namespace boresight::bench::ghosts_drives
