#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "interfaces/messages/names.hpp"
#include "services/boresight/fit_evidence/weights_text.hpp"
#include "services/ghost_filter/weights_file.hpp"
#include "tests/benchmarks/ghosts/drives/groups/groups.hpp"

namespace boresight::bench::ghosts_drives {

namespace {

struct JudgedFigure {
  const char* what;
  Figure figure;
  Limits limits;
};

std::vector<JudgedFigure> judged_figures(bool is_of_other_scenarios) {
  const Limits calibration = at_most(is_of_other_scenarios ? 0.08 : 0.05);
  return {
      {"Brier / base rate, without tracks", brier_ratio(Lane::kWithout), at_most(0.6)},
      {"log loss / base rate, without tracks", log_loss_ratio(Lane::kWithout), at_most(0.7)},
      {"calibration error, without tracks", calibration_error(Lane::kWithout), calibration},
      {"false ones recognised at 90 % of real ones kept, without tracks", recognised_at_90(Lane::kWithout),
       at_least(0.75)},
      {"Brier / base rate, perfect tracks", brier_ratio(Lane::kPerfect), at_most(0.25)},
      {"log loss / base rate, perfect tracks", log_loss_ratio(Lane::kPerfect), at_most(0.3)},
      {"calibration error, perfect tracks", calibration_error(Lane::kPerfect), calibration},
      {"real ones of objects known over 1 s lost, perfect tracks", known_lost(Lane::kPerfect), at_most(0.03)},
      {"Doppler-ambiguous ones of known objects kept, perfect tracks", ambiguous_kept(Lane::kPerfect), at_least(0.85)},
      {"Brier / base rate, in the chain", brier_ratio(Lane::kChain), at_most(0.4)},
      {"log loss / base rate, in the chain", log_loss_ratio(Lane::kChain), {}},
      {"calibration error, in the chain", calibration_error(Lane::kChain), calibration},
      {"Brier / base rate, published method", brier_ratio(Lane::kPublished), {}}};
}

/// All drives together, with 95 % intervals over the drives, and the median over the drives.
Table figures_table(const std::string& profile, const std::string& conditions, const Drives& drives, bool is_of_others,
                    Findings& findings) {
  Table table{(is_of_others ? "others_" : "profile_") + profile,
              fmt::format("{}, {} drives{}; {}", profile, drives.size(),
                          is_of_others ? ", weights fitted on the other scenarios" : "", conditions),
              {"figure", "all drives", "95 % interval", "median drive", "bar", "result"},
              {}};
  for (const JudgedFigure& each : judged_figures(is_of_others)) {
    const auto [all, interval, of_single] = estimate(each.figure, drives);
    table.rows.push_back({each.what, fixed(all, 3),
                          std::isnan(interval.low) ? "—" : fixed(interval.low, 3) + "–" + fixed(interval.high, 3),
                          fixed(of_single, 3), text_of(each.limits), findings.judge(interval, each.limits)});
  }
  return table;
}

Table scenarios_table(const Setup& setup, const std::string& profile, const Drives& drives, Findings& findings) {
  Table table{"scenarios_" + profile,
              profile + ": moving detections of each scenario, and Brier score over that of the base rate",
              {"scenario", "detections", "real, %", "without tracks", "perfect tracks", "chain", "published"},
              {}};
  for (std::size_t s = 0; s < setup.scenarios.size(); ++s) {
    const auto first = drives.begin() + static_cast<std::ptrdiff_t>(s * setup.seeds);
    const Drives mine(first, first + static_cast<std::ptrdiff_t>(setup.seeds));
    double all = 0.0, real = 0.0;
    for (const DriveResult* drive : mine) {
      for (const JudgedDetection& d : drive->detections) {
        all += 1.0;
        real += d.is_real ? 1.0 : 0.0;
      }
    }
    const std::string name = std::filesystem::path(setup.scenarios[s]).stem().string();
    table.rows.push_back({name, fixed(all, 0), fixed(100.0 * real / all, 0)});
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double ratio = brier_ratio(static_cast<Lane>(lane))(mine);
      table.rows.back().push_back(fixed(ratio, 3));
      findings.add(Curve{"brier", profile, name + "|" + std::string(kLaneNames[lane]), {{0.0, ratio}}});
    }
  }
  return table;
}

void add_origins(const std::string& profile, const Drives& drives, Table& table) {
  constexpr std::array kFalse = {Provenance::kUnknown,    Provenance::kStationary, Provenance::kGhostType1,
                                 Provenance::kGhostType2, Provenance::kClutter,    Provenance::kAmbiguity};
  for (const Provenance origin : kFalse) {
    const bool is_all = origin == Provenance::kUnknown;
    const double share = is_all ? 1.0 : share_of_false(origin)(drives);
    constexpr double kShown = 0.001;
    if (!(share >= kShown)) continue;
    table.rows.push_back(
        {is_all ? profile : "", is_all ? "all" : std::string(name_of(origin)), fixed(100.0 * share, 1)});
    for (std::size_t lane = 0; lane < kEvidenceLanes; ++lane) {
      table.rows.back().push_back(fixed(100.0 * recognised_at_90(static_cast<Lane>(lane), origin)(drives), 0));
    }
  }
}

void add_reliability(const std::string& profile, const Drives& drives, Findings& findings) {
  for (std::size_t lane = 0; lane < kEvidenceLanes; ++lane) {
    Curve curve{"reliability", profile, std::string(kLaneNames[lane]), {}};
    for (const ReliabilityBin& bin : reliability(drives, static_cast<Lane>(lane))) {
      if (bin.detections > 0.0) {
        curve.points.emplace_back(100.0 * bin.stated / bin.detections, 100.0 * bin.real / bin.detections);
      }
    }
    findings.add(std::move(curve));
  }
}

void write_weights(const Setup& setup, ProfileDrives& profile) {
  const std::filesystem::path file = std::filesystem::path(setup.weights_folder) / (profile.name() + ".toml");
  std::filesystem::create_directories(setup.weights_folder);
  std::ofstream out(file);
  out << fit_evidence::weights_text(fit_evidence::fit_weights(evidence_of(profile.judged()), {}),
                                    fmt::format("{} drives, seeds {} … {}, {} s", profile.judged().size(),
                                                setup.first_seed, setup.last_seed(), setup.longest_s));
  out.flush();
  if (!out) throw std::runtime_error("cannot write " + file.string());
  fmt::print("weights: {}\n", file.string());
}

}  // namespace

void probabilities(const Setup& setup, std::vector<ProfileDrives>& profiles, Findings& findings) {
  Table origins{"origins",
                "false moving detections by their origin: share, and % recognised with the threshold of the "
                "probability that keeps 90 % of the real ones of the profile",
                {"profile", "origin", "% of the false ones", "without tracks", "perfect tracks", "chain"},
                {}};
  for (ProfileDrives& profile : profiles) {
    if (setup.fits_others) {
      const std::vector<DriveResult> results = profile.judged_by_others();
      findings.add(figures_table(profile.name(), setup.drives_text(), pointers(results), true, findings));
      continue;
    }
    const Drives drives = pointers(profile.judged());
    findings.add(figures_table(profile.name(), setup.drives_text(), drives, false, findings));
    findings.add(scenarios_table(setup, profile.name(), drives, findings));
    add_origins(profile.name(), drives, origins);
    add_reliability(profile.name(), drives, findings);
    if (!setup.weights_folder.empty()) write_weights(setup, profile);
  }
  if (!origins.rows.empty()) findings.add(std::move(origins));
}

}  // namespace boresight::bench::ghosts_drives
