#include "tests/benchmarks/ghosts/drives/judge/ablation.hpp"

#include <fmt/format.h>

#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/ghosts/drives/groups/groups.hpp"

namespace boresight::bench::ghosts_drives {

namespace {

using Changes = std::array<double, kEvidenceLanes>;

std::vector<Changes> changes_of(const Setup& setup, ProfileDrives& profile, const std::vector<EvidencePart>& parts) {
  const std::vector<fit_evidence::LabelledEvidence> fit = evidence_of(profile.for_fits());
  EvidenceByLane judged;
  for (const DriveResult& drive : profile.judged()) {
    for (std::size_t lane = 0; lane < kEvidenceLanes; ++lane) {
      const auto& evidence = drive.evidence.lanes[lane];
      judged[lane].insert(judged[lane].end(), evidence.begin(), evidence.end());
    }
  }
  const ghosts::EvidenceWeights full = fit_evidence::fit_weights(fit, {});
  std::vector<Changes> changes(parts.size());
  parallel_for(parts.size(), setup.jobs,
               [&](std::size_t i) { changes[i] = brier_change_percent(parts[i], fit, judged, full); });
  return changes;
}

std::string percent(double change) {
  const std::string text = fmt::format("{:+.1f}", change);
  return text == "+0.0" || text == "-0.0" ? "0" : text;
}

}  // namespace

void ablation(const Setup& setup, std::vector<ProfileDrives>& profiles, Findings& findings) {
  constexpr double kWorth_percent = 1.0;
  const std::vector<EvidencePart> parts = evidence_parts();
  Table table{"ablation",
              fmt::format("change of the Brier score in % without a part of the evidence: without tracks / perfect "
                          "tracks / chain; {}; weights fitted on seeds {} … {}",
                          setup.drives_text(), setup.last_seed() + 1, setup.last_seed() + setup.seeds),
              {"part"},
              {}};
  for (const EvidencePart& part : parts) table.rows.push_back({part.name});
  std::vector<bool> has_worth(parts.size(), false);
  for (ProfileDrives& profile : profiles) {
    table.header.push_back(profile.name());
    const std::vector<Changes> changes = changes_of(setup, profile, parts);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      std::string cell;
      for (const double change : changes[i]) {
        cell += (cell.empty() ? "" : " / ") + percent(change);
        has_worth[i] = has_worth[i] || change >= kWorth_percent;
      }
      table.rows[i].push_back(cell);
    }
  }
  table.header.emplace_back("mark");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    table.rows[i].emplace_back(has_worth[i] ? "" : "below 1 % everywhere");
  }
  findings.add(std::move(table));
}

}  // namespace boresight::bench::ghosts_drives
