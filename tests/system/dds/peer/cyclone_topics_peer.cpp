// A reader built on Cyclone DDS: cyclone_topics_peer DOMAIN SECONDS FILE writes the tracks, alignment estimates and
// service statuses that it receives in that time to FILE, a line each. Floats are in hexadecimal, so that no digit is
// lost.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <dds/dds.h>

#include "alignment_estimate.h"
#include "service_status.h"
#include "track_list.h"

namespace {

dds_entity_t reader_of(dds_entity_t participant, const dds_topic_descriptor_t& type, const char* name,
                       dds_reliability_kind_t reliability, dds_durability_kind_t durability) {
  const dds_entity_t topic = dds_create_topic(participant, &type, name, nullptr, nullptr);
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, reliability, DDS_SECS(1));
  dds_qset_durability(qos, durability);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, nullptr);
  dds_delete_qos(qos);
  return reader;
}

template <typename Sample, typename Print>
void take(dds_entity_t reader, Print print) {
  constexpr std::size_t kMost = 16;
  void* samples[kMost] = {};
  dds_sample_info_t infos[kMost];
  const dds_return_t count = dds_take(reader, samples, infos, kMost, kMost);
  for (dds_return_t i = 0; i < count; ++i) {
    if (infos[i].valid_data) print(*static_cast<const Sample*>(samples[i]));
  }
  if (count > 0) dds_return_loan(reader, samples, count);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  std::FILE* const file = std::fopen(argv[3], "w");
  const dds_entity_t participant =
      dds_create_participant(static_cast<dds_domainid_t>(std::atoi(argv[1])), nullptr, nullptr);
  if (participant < 0 || file == nullptr) return 2;
  const dds_entity_t tracks = reader_of(participant, boresight_perception_TrackList_desc, "boresight/track_list",
                                        DDS_RELIABILITY_BEST_EFFORT, DDS_DURABILITY_VOLATILE);
  const dds_entity_t estimates =
      reader_of(participant, boresight_diagnostics_AlignmentEstimate_desc, "boresight/alignment_estimate",
                DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t services =
      reader_of(participant, boresight_diagnostics_ServiceStatus_desc, "boresight/service_status",
                DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_TRANSIENT_LOCAL);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(argv[2]));
  while (std::chrono::steady_clock::now() < end) {
    take<boresight_perception_TrackList>(tracks, [&](const auto& list) {
      std::fprintf(file, "list %llu radar %u measured %lld tracks %u\n",
                   static_cast<unsigned long long>(list.sequence_number), list.radar_id,
                   static_cast<long long>(list.measurement_time_ns), list.tracks._length);
      for (std::uint32_t i = 0; i < list.tracks._length; ++i) {
        const boresight_perception_Track& t = list.tracks._buffer[i];
        std::fprintf(file, "track %llu %u %a %a %a %a %a\n", static_cast<unsigned long long>(list.sequence_number),
                     t.tracking_id, static_cast<double>(t.position_vehicle_m[0]),
                     static_cast<double>(t.position_vehicle_m[1]), static_cast<double>(t.velocity_over_ground_mps[0]),
                     static_cast<double>(t.existence_probability), static_cast<double>(t.covariance[48]));
      }
    });
    take<boresight_diagnostics_AlignmentEstimate>(estimates, [&](const auto& e) {
      std::fprintf(file, "estimate %llu radar %u %a %a %a\n", static_cast<unsigned long long>(e.sequence_number),
                   e.radar_id, static_cast<double>(e.speed_scale), static_cast<double>(e.alignment_yaw_rad),
                   static_cast<double>(e.covariance[5]));
    });
    take<boresight_diagnostics_ServiceStatus>(services, [&](const auto& s) {
      std::fprintf(file, "service %s %d pid %d outputs %llu\n", s.service_name, static_cast<int>(s.condition), s.pid,
                   static_cast<unsigned long long>(s.outputs));
    });
    std::fflush(file);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  dds_delete(participant);
  return std::fclose(file) == 0 ? 0 : 1;
}
