// Counts heap allocations of the calling thread by replacing malloc, so that every heartbeat reports the allocations on
// the data path. Without effect (always 0) in builds with sanitizers, which replace malloc themselves.
#pragma once

#include <cstdint>

namespace boresight::runtime {

/// Allocations on this thread during the life of a CountAllocations, except during that of an AllowAllocations.
[[nodiscard]] std::uint64_t counted_allocations();

/// Counts this thread's allocations during its life.
class CountAllocations {
 public:
  explicit CountAllocations(bool enabled = true);
  ~CountAllocations();
  CountAllocations(const CountAllocations&) = delete;
  CountAllocations& operator=(const CountAllocations&) = delete;

 private:
  bool before_;
};

/// For work inside the data path that may allocate, such as re-opening a link.
class AllowAllocations {
 public:
  AllowAllocations();
  ~AllowAllocations();
  AllowAllocations(const AllowAllocations&) = delete;
  AllowAllocations& operator=(const AllowAllocations&) = delete;

 private:
  bool before_;
};

}  // namespace boresight::runtime
