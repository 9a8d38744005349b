// A diagnosis tool built on Cyclone DDS, which requests a deadline and a lease of two seconds.
//   cyclone_peer DOMAIN SECONDS        prints every status, sensor and system that it receives, one line each, and ends
//                                      after a sample of each topic has come, with 0, or after the time, with 1.
//   cyclone_peer DOMAIN SECONDS plain  the same without requests.
//   cyclone_peer DOMAIN SECONDS watch  then prints what it learns of silence, and ends after it has learnt it of each
//                                      topic, with 0.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <thread>

#include <dds/dds.h>

#include "diagnostic_array.h"
#include "sensor_health.h"
#include "system_health.h"

namespace {

dds_entity_t reader_of(dds_entity_t participant, const dds_topic_descriptor_t& type, const char* name, bool is_plain) {
  const dds_entity_t topic = dds_create_topic(participant, &type, name, nullptr, nullptr);
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  if (!is_plain) {
    dds_qset_deadline(qos, DDS_SECS(2));
    dds_qset_liveliness(qos, DDS_LIVELINESS_AUTOMATIC, DDS_SECS(2));
  }
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, nullptr);
  dds_delete_qos(qos);
  return reader;
}

/// Prints what the reader has learnt since the last call; true if that is silence.
bool has_fallen_silent(dds_entity_t reader, const char* name) {
  bool silent = false;
  dds_liveliness_changed_status_t liveliness;
  if (dds_get_liveliness_changed_status(reader, &liveliness) == DDS_RETCODE_OK &&
      liveliness.not_alive_count_change > 0) {
    std::printf("%s: liveliness lost\n", name);
    silent = true;
  }
  dds_requested_deadline_missed_status_t deadline;
  if (dds_get_requested_deadline_missed_status(reader, &deadline) == DDS_RETCODE_OK &&
      deadline.total_count_change > 0) {
    std::printf("%s: deadline missed\n", name);
    silent = true;
  }
  dds_subscription_matched_status_t matched;
  if (dds_get_subscription_matched_status(reader, &matched) == DDS_RETCODE_OK && matched.current_count == 0) {
    std::printf("%s: no writer\n", name);
    silent = true;
  }
  return silent;
}

template <typename Sample, typename Print>
bool take(dds_entity_t reader, Print print) {
  constexpr std::size_t kMost = 16;
  void* samples[kMost] = {};
  dds_sample_info_t infos[kMost];
  const dds_return_t count = dds_take(reader, samples, infos, kMost, kMost);
  bool any = false;
  for (dds_return_t i = 0; i < count; ++i) {
    if (!infos[i].valid_data) {
      const bool is_disposed = infos[i].instance_state == DDS_IST_NOT_ALIVE_DISPOSED;
      std::printf("%s\n", is_disposed ? "disposed" : "no writers");
      continue;
    }
    print(*static_cast<const Sample*>(samples[i]));
    any = true;
  }
  if (count > 0) dds_return_loan(reader, samples, count);
  return any;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::string_view mode = argc > 3 ? argv[3] : "";
  const bool is_plain = mode == "plain";
  const dds_entity_t participant =
      dds_create_participant(static_cast<dds_domainid_t>(std::atoi(argv[1])), nullptr, nullptr);
  if (participant < 0) return 2;
  const dds_entity_t arrays =
      reader_of(participant, diagnostic_msgs_msg_dds__DiagnosticArray__desc, "rt/diagnostics", is_plain);
  const dds_entity_t sensors =
      reader_of(participant, boresight_diagnostics_SensorHealth_desc, "boresight/sensor_health", is_plain);
  const dds_entity_t systems =
      reader_of(participant, boresight_diagnostics_SystemHealth_desc, "boresight/system_health", is_plain);
  bool array_came = false, sensor_came = false, system_came = false;
  const auto read = [&] {
    array_came |= take<diagnostic_msgs_msg_dds__DiagnosticArray_>(arrays, [](const auto& array) {
      for (std::uint32_t i = 0; i < array.status_._length; ++i) {
        const auto& status = array.status_._buffer[i];
        std::printf("status %u %s: %s (%u values)\n", status.level_, status.name_, status.message_,
                    status.values_._length);
      }
    });
    sensor_came |= take<boresight_diagnostics_SensorHealth>(sensors, [](const auto& s) {
      std::printf("sensor %u %s %d %d yaw %.4f suspect %llu conditions %u\n", s.radar_id, s.radar_name,
                  static_cast<int>(s.data_qualifier), static_cast<int>(s.extended_qualifier),
                  static_cast<double>(s.yaw.error_rad), static_cast<unsigned long long>(s.suspect_scans), s.conditions);
    });
    system_came |= take<boresight_diagnostics_SystemHealth>(systems, [](const auto& s) {
      std::printf("system %s %d pipeline %d %s lost %u\n", s.vehicle_name, static_cast<int>(s.overall),
                  static_cast<int>(s.pipeline.data_qualifier), s.pipeline.trouble_codes, s.pipeline.lost_scans);
    });
  };
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(argv[2]));
  const auto until = [&](auto condition) {
    while (std::chrono::steady_clock::now() < end) {
      read();
      if (condition()) return true;
      std::fflush(stdout);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  };
  bool done = until([&] { return array_came && sensor_came && system_came; });
  if (done && mode == "watch") {
    std::printf("complete\n");
    std::fflush(stdout);
    bool array_silent = false, sensor_silent = false, system_silent = false;
    done = until([&] {
      array_silent |= has_fallen_silent(arrays, "arrays");
      sensor_silent |= has_fallen_silent(sensors, "sensors");
      system_silent |= has_fallen_silent(systems, "systems");
      return array_silent && sensor_silent && system_silent;
    });
    read();
  }
  dds_delete(participant);
  return done ? 0 : 1;
}
