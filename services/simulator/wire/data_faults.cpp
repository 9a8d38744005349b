#include "services/simulator/wire/data_faults.hpp"

#include <algorithm>
#include <utility>

#include "services/simulator/random.hpp"

namespace boresight::simulator::wire {

namespace {

/// Removes the detections beyond `reach_m`; the others keep their order.
void keep_near(RadarScan& scan, double reach_m) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < scan.number_of_valid_detections; ++i) {
    if (static_cast<double>(scan.range_m[i]) > reach_m) continue;
    for (DetectionColumn<float>* const column :
         {&scan.range_m, &scan.azimuth_rad, &scan.elevation_rad, &scan.range_rate_mps, &scan.rcs_dbsm, &scan.snr_db,
          &scan.range_std_m, &scan.azimuth_std_rad, &scan.elevation_std_rad, &scan.range_rate_std_mps,
          &scan.existence_probability}) {
      (*column)[kept] = (*column)[i];
    }
    scan.detection_flags[kept] = scan.detection_flags[i];
    ++kept;
  }
  scan.number_of_valid_detections = kept;
}

void draw_anew(RadarScan& scan, const FieldOfView& view, Stream& draws) {
  for (std::uint32_t i = 0; i < scan.number_of_valid_detections; ++i) {
    scan.range_m[i] = static_cast<float>(draws.uniform(0.0, view.range_max_m));
    scan.azimuth_rad[i] = static_cast<float>(draws.uniform(view.azimuth_min_rad, view.azimuth_max_rad));
    scan.range_rate_mps[i] = static_cast<float>(draws.uniform(scan.range_rate_min_mps, scan.range_rate_max_mps));
  }
}

}  // namespace

DataFaults::DataFaults(std::vector<RadarDataFault> faults, std::uint64_t seed)
    : faults_(std::move(faults)), seed_(seed), copy_(std::make_unique<RadarScan>()), frozen_(faults_.size()) {}

SentList DataFaults::apply(const RadarScan& scan, const RadarConfig& radar, double t_s) {
  SentList sent{&scan, 1};
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const RadarDataFault& fault = faults_[i];
    if (fault.radar != 0 && fault.radar != radar.id) continue;
    if (t_s < fault.begin_s || t_s >= fault.begin_s + fault.duration_s) continue;
    apply_one(fault, radar, i, sent);
  }
  return sent;
}

RadarScan& DataFaults::own(SentList& sent) {
  if (sent.scan != copy_.get()) *copy_ = *sent.scan;
  sent.scan = copy_.get();
  return *copy_;
}

void DataFaults::apply_one(const RadarDataFault& fault, const RadarConfig& radar, std::size_t index, SentList& sent) {
  Stream draws(seed_, "data_fault", radar.id, sent.scan->cycle_counter);
  switch (fault.kind) {
    case DataFaultKind::kFew: {
      RadarScan& list = own(sent);
      list.number_of_valid_detections = std::min(list.number_of_valid_detections, fault.detections);
      return;
    }
    case DataFaultKind::kNear:
      keep_near(own(sent), fault.reach_m);
      return;
    case DataFaultKind::kLost:
      if (draws.uniform() < fault.share) sent.times = 0;
      return;
    case DataFaultKind::kFrozen: {
      std::unique_ptr<RadarScan>& first = frozen_[index].at(radar.id);
      if (first == nullptr) first = std::make_unique<RadarScan>(*sent.scan);
      const MessageHeader header = sent.scan->header;
      const std::uint32_t counter = sent.scan->cycle_counter;
      RadarScan& list = own(sent);
      list = *first;
      list.header = header;
      list.cycle_counter = counter;
      return;
    }
    case DataFaultKind::kRepeated:
      sent.times = 2;
      return;
    case DataFaultKind::kMirroredAzimuth: {
      RadarScan& list = own(sent);
      for (std::uint32_t i = 0; i < list.number_of_valid_detections; ++i) list.azimuth_rad[i] = -list.azimuth_rad[i];
      return;
    }
    case DataFaultKind::kRandom:
      draw_anew(own(sent), radar.field_of_view, draws);
      return;
  }
}

}  // namespace boresight::simulator::wire
