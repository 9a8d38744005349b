// A RouDi for tests without a supervised domain.
#pragma once

#include <memory>
#include <vector>

#include "deploy/roudi/pools.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::harness {

class Roudi {
 public:
  /// Starts it and waits until applications can register.
  explicit Roudi(const std::vector<roudi::Segment>& segments = roudi::single_segment());
  ~Roudi();
  [[nodiscard]] Child& process() { return *process_; }

 private:
  std::unique_ptr<Child> process_;
};

}  // namespace boresight::harness
