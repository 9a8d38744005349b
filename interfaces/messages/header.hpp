// First part of every message: layout version, sequence numbers, origin (the radar or service that the data come from),
// time of measurement, and the time stamps of the passed stages. With these, loss and latency are measurable in
// production without a second channel. One measurement cycle of a radar is a scan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace boresight {

/// Stages that a radar scan passes; the index into `MessageHeader::stages`.
enum class Stage : std::uint8_t {
  kIngest = 0,
  kCorrector = 1,
  kGhostFilter = 2,
  kTracker = 3,
};
inline constexpr std::size_t kNumberOfStages = 4;

/// Times at which a stage began to handle the message and published its output, CLOCK_MONOTONIC, ns. The time between
/// two stages is that of the transport and of waiting in the queue. Zero for a stage that the data has not reached yet.
struct StageStamp {
  std::int64_t begin_ns;
  std::int64_t end_ns;
};

/// Source of `measurement_time_ns`. If arrival time stands for the time of measurement, the source states so.
enum class TimeSource : std::uint8_t {
  kUnknown = 0,
  kSensorSynchronised = 1,  ///< stamp of the sensor; its clock reports synchronisation and is plausible
  kSensorFreeRunning = 2,   ///< stamp of the sensor, converted to this ECU's clock by an estimated offset
  kLinkArrival = 3,         ///< kernel's (or recording's) receive stamp of the frame that completed the data
  kUserArrival = 4,         ///< clock read by the gateway after receiving; the least accurate
};

/// First member of every message. `sequence` counts the messages of one writer on one topic and `source_sequence`
/// those of one source (radar id, or service index); both start at 1, so that a reader sees a loss as a gap.
struct MessageHeader {
  std::uint32_t version;    ///< the message type's `kVersion`
  std::uint32_t source_id;  ///< radar id (1…16) for data of one radar, 0 for the vehicle, service index otherwise
  std::uint64_t sequence;
  std::uint64_t source_sequence;
  std::int64_t measurement_time_ns;  ///< CLOCK_MONOTONIC of this ECU
  TimeSource time_source;
  std::array<std::uint8_t, 7> reserved;
  std::array<StageStamp, kNumberOfStages> stages;

  [[nodiscard]] StageStamp& stage(Stage s) { return stages[static_cast<std::size_t>(s)]; }
  [[nodiscard]] const StageStamp& stage(Stage s) const { return stages[static_cast<std::size_t>(s)]; }
};

static_assert(sizeof(MessageHeader) == 104);
static_assert(alignof(MessageHeader) == 8);

/// Largest number of radars of a vehicle; radar ids are 1…kMaxRadars.
inline constexpr std::size_t kMaxRadars = 16;
/// Largest number of detections of a scan; further ones are counted in `dropped_detections`.
inline constexpr std::size_t kMaxDetections = 1024;

/// One measured quantity of all detections of a scan, contiguous and cache-line aligned, so that
/// `Eigen::Map<const Eigen::ArrayXf, Eigen::Aligned64>` reads it in place in shared memory.
template <typename T>
struct alignas(64) DetectionColumn {
  std::array<T, kMaxDetections> values;

  [[nodiscard]] T& operator[](std::size_t i) { return values[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return values[i]; }
  [[nodiscard]] T* data() { return values.data(); }
  [[nodiscard]] const T* data() const { return values.data(); }
};

/// True for types that may cross a process boundary as raw memory.
template <typename T>
inline constexpr bool kIsPlainMessage =
    std::is_trivially_copyable_v<T>&& std::is_standard_layout_v<T>&& std::is_trivially_default_constructible_v<T>;

static_assert(kIsPlainMessage<MessageHeader>);

}  // namespace boresight
