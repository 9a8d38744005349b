#include "deploy/roudi/pools.hpp"

#include <bit>
#include <map>

#include "interfaces/catalogue/catalogue.hpp"

namespace boresight::roudi {

namespace {

using catalogue::Service;
using catalogue::Topic;

std::size_t number_of_readers(const Topic& topic) {
  const std::size_t monitors = topic.readers.contains(Service::kMonitor) ? catalogue::kMaxMonitors : 0;
  return topic.readers.size() - (monitors > 0 ? 1 : 0) + monitors;
}

/// Σ subscribers (queue + held): the largest number of chunks that readers hold, however slow they are.
std::size_t chunks_at_readers(const Topic& topic) {
  const std::size_t readers = number_of_readers(topic);
  return readers * catalogue::queue_capacity(topic) + catalogue::held_messages(topic, readers);
}

/// History, loans, and one chunk that a publisher keeps for reuse.
std::size_t chunks_at_one_writer(const Topic& topic) {
  return topic.history + kLoansPerPublisher + 1;
}

std::vector<Pool> to_pools(const std::map<std::size_t, std::size_t>& count_by_size) {
  constexpr std::size_t kStep = 8;
  std::vector<Pool> pools;
  for (const auto& [size, count] : count_by_size) pools.push_back({size, (count + kStep - 1) / kStep * kStep});
  return pools;
}

}  // namespace

std::size_t chunk_bytes_for(std::size_t payload_bytes) {
  constexpr std::size_t kCacheLine = 64;
  constexpr std::size_t kSmall = 4096;
  // The payload starts at the first cache line after the chunk header: at most one line is lost.
  const std::size_t needed = payload_bytes + kCacheLine;
  if (needed <= kSmall) return std::bit_ceil(needed);
  return (needed + kCacheLine - 1) / kCacheLine * kCacheLine;
}

std::vector<Segment> single_segment() {
  std::map<std::size_t, std::size_t> count_by_size;
  for (const Topic& topic : catalogue::kTopics) {
    count_by_size[chunk_bytes_for(topic.payload_bytes)] +=
        chunks_at_readers(topic) + topic.writers.size() * chunks_at_one_writer(topic);
  }
  return {{.writer_group = "", .reader_group = "", .pools = to_pools(count_by_size)}};
}

std::vector<Segment> segment_per_writer() {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < catalogue::kNumberOfServices; ++i) {
    const auto service = static_cast<Service>(i);
    std::map<std::size_t, std::size_t> count_by_size;
    for (const Topic& topic : catalogue::kTopics) {
      if (!topic.writers.contains(service)) continue;
      // Even where several services write a topic, a reader's queue may hold messages of this one only.
      count_by_size[chunk_bytes_for(topic.payload_bytes)] += chunks_at_readers(topic) + chunks_at_one_writer(topic);
    }
    if (count_by_size.empty()) continue;
    segments.push_back({.writer_group = "boresight-" + std::string(catalogue::name_of(service)),
                        .reader_group = std::string(kDeployedReaderGroup),
                        .pools = to_pools(count_by_size)});
  }
  return segments;
}

std::size_t total_bytes(const std::vector<Segment>& segments) {
  // Measured for iceoryx 2.0.3 with the limits of Debian's build, and a tenth more for headers and lists.
  constexpr std::size_t kManagement = 66'000'000;
  std::size_t chunks = 0;
  for (const Segment& segment : segments) {
    for (const Pool& pool : segment.pools) chunks += pool.chunk_bytes * pool.count;
  }
  return kManagement + chunks + chunks / 10;
}

std::string to_toml(const std::vector<Segment>& segments) {
  std::string text =
      "# Generated from interfaces/catalogue by `boresight catalogue --roudi`; a test proves that it is up to date.\n"
      "[general]\nversion = 1\n";
  for (const Segment& segment : segments) {
    text += "\n[[segment]]\n";
    if (!segment.writer_group.empty()) text += "writer = \"" + segment.writer_group + "\"\n";
    if (!segment.reader_group.empty()) text += "reader = \"" + segment.reader_group + "\"\n";
    for (const Pool& pool : segment.pools) {
      text += "\n[[segment.mempool]]\nsize = " + std::to_string(pool.chunk_bytes) +
              "\ncount = " + std::to_string(pool.count) + "\n";
    }
  }
  return text;
}

}  // namespace boresight::roudi
