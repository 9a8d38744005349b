// A monitor that records all topics, for checks at the end of a test.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "interfaces/catalogue/catalogue.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::harness {

/// One received message. Fields that a topic does not have are zero.
struct Sample {
  catalogue::TopicId topic;
  std::int64_t received_ns;
  MessageHeader header;
  std::uint32_t count;  ///< valid detections, tracks, or valid sensors
  std::uint32_t confirmed_tracks;
  std::uint32_t flags;                                     ///< pipeline_flag bits
  std::array<std::uint32_t, kNumberOfProvenances> labels;  ///< ClassifiedScan: detections by Provenance
  std::uint32_t segments;                                  ///< ClassifiedScan: reflectors
  std::uint64_t alignment_sequence;
  /// CorrectedScan and ClassifiedScan: 1 if it corresponds index by index to its radar scan, 2 if not, 0 if that scan
  /// was not received in time.
  std::uint8_t correspondence;
  bool in_shared_memory;                       ///< read in place in a mapping of /dev/shm
  std::array<float, 2> values;                 ///< EgoMotion: speed, yaw rate; AlignmentEstimate: k_v, yaw
  ServiceStatus status;                        ///< of ServiceStatus only
  std::array<std::uint32_t, 5> sensor;         ///< HealthReport: data qualifier of radar 1…4 (index = id)
  std::array<std::uint32_t, 5> sensor_reason;  ///< extended qualifier
  DataQualifier overall;                       ///< HealthReport, as is the next
  PipelineHealth pipeline;
  std::array<ServiceCondition, catalogue::kNumberOfSupervisedServices> services;
  std::array<std::uint64_t, catalogue::kNumberOfSupervisedServices> dropped_inputs;  ///< HealthReport, as is the next
  std::array<float, catalogue::kNumberOfSupervisedServices> latency_max_us;
};

inline constexpr std::size_t kMaxSamples = 60'000;

class Observer {
 public:
  /// `pause_s` is slept in each radar scan. Several observers need different names.
  explicit Observer(const std::string& name, double pause_s = 0.0);
  [[nodiscard]] Child& process() { return *process_; }
  [[nodiscard]] bool is_attached() const { return log_->attached; }

  /// Samples so far, in the order of arrival.
  [[nodiscard]] std::size_t size() const { return log_->size; }
  [[nodiscard]] const Sample& operator[](std::size_t i) const { return log_->samples[i]; }
  [[nodiscard]] std::vector<const Sample*> of(catalogue::TopicId topic, std::size_t from = 0) const;

 private:
  struct Log {
    volatile bool attached;
    volatile std::size_t size;
    std::array<Sample, kMaxSamples> samples;
  };
  int observe(const std::string& name, double pause_s);

  Shared<Log> log_;
  std::unique_ptr<Child> process_;
};

}  // namespace boresight::harness
