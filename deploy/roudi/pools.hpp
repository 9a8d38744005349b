// RouDi's shared memory. The catalogue's queue depths and histories determine its size, so that no pool can run empty.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace boresight::roudi {

/// Chunks of one size. RouDi adds its own chunk header to `chunk_bytes`.
struct Pool {
  std::size_t chunk_bytes;
  std::size_t count;
};

/// One shared memory. An empty group means the group of the user that runs RouDi, with all rights.
struct Segment {
  std::string writer_group;
  std::string reader_group;
  std::vector<Pool> pools;  ///< ascending in size
};

/// Loans that one publisher may hold at the same time; iceoryx's own limit.
inline constexpr std::size_t kLoansPerPublisher = 8;
/// Group of all users that may read the deployed system's topics, and of RouDi.
inline constexpr std::string_view kDeployedReaderGroup = "boresight";

/// Size of the chunk for a message, including its alignment to a cache line. Sizes are rounded up so that small
/// messages share a pool.
[[nodiscard]] std::size_t chunk_bytes_for(std::size_t payload_bytes);

/// One segment for all services: for the demo and the tests, which run as one user.
[[nodiscard]] std::vector<Segment> single_segment();
/// One segment per writing service, which only that service can write to: group `boresight-<service>`.
[[nodiscard]] std::vector<Segment> segment_per_writer();

/// Shared memory of all segments and of RouDi's own management data.
[[nodiscard]] std::size_t total_bytes(const std::vector<Segment>& segments);

/// The file that `iox-roudi -c` takes.
[[nodiscard]] std::string to_toml(const std::vector<Segment>& segments);

}  // namespace boresight::roudi
