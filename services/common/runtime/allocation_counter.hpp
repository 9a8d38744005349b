// Counts heap allocations of the thread that asks for it, by standing before malloc: "no allocation per scan" is then
// a number in every heartbeat instead of a promise. Without effect (always 0) in sanitized builds, which own malloc.
#pragma once

#include <cstdint>

namespace boresight::runtime {

/// Allocations on this thread while a CountAllocations was alive and no AllowAllocations.
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

/// For what is not the data path though it runs inside it, such as re-opening a link.
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
