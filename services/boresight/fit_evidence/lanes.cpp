#include "services/boresight/fit_evidence/lanes.hpp"

#include <algorithm>

namespace boresight::fit_evidence {

std::size_t DriveEvidence::real_detections() const {
  const auto& all = lanes[static_cast<std::size_t>(Lane::kWithout)];
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](const LabelledEvidence& each) { return each.is_real; }));
}

void Lanes::classify(const CorrectedScan& scan) {
  for (Alone* const each : {&without_, &perfect_}) {
    if (each == &perfect_ && !has_objects_) continue;
    each->classified->header = scan.header;
    each->method->classify(scan, *each->classified);
  }
}

void Lanes::label(double t_s, std::span<const simulator::DetectionTruth> truth,
                  std::span<const ghosts::JudgedEvidence> in_chain, DriveEvidence& out) {
  const auto is_real = [&](std::uint32_t index) {
    return index < truth.size() && truth[index].provenance == Provenance::kMoving;
  };
  const auto keep = [&](Lane lane, std::span<const ghosts::JudgedEvidence> evidence) {
    for (const ghosts::JudgedEvidence& each : evidence) {
      out.lanes[static_cast<std::size_t>(lane)].push_back({each.levels, is_real(each.index)});
    }
  };
  keep(Lane::kWithout, without_.method->evidence());
  if (has_objects_) keep(Lane::kPerfect, perfect_.method->evidence());
  keep(Lane::kChain, in_chain);
  const std::uint32_t radar = without_.classified->header.source_id;
  const double base_rate = base_rate_.at(radar, t_s);
  for (const ghosts::JudgedEvidence& each : without_.method->evidence()) {
    out.base_rates.push_back(static_cast<float>(base_rate));
    base_rate_.add(radar, is_real(each.index));
  }
}

void Lanes::add_objects(double t_s, const std::vector<simulator::DetectionTruth>& truth,
                        std::vector<judge::Object> objects) {
  last_seen_.mark(t_s, truth, objects);
  tracks_->header = without_.classified->header;
  true_tracks_.write(t_s, objects, *tracks_);
  perfect_.method->add_tracks(*tracks_);
}

void append(const DriveEvidence& drive, std::vector<LabelledEvidence>& all) {
  for (const auto& lane : drive.lanes) all.insert(all.end(), lane.begin(), lane.end());
}

}  // namespace boresight::fit_evidence
