// A participant that reports AVAILABLE for a radar, whatever the health service says, and reads along.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "tests/system/harness/child.hpp"

namespace boresight {

constexpr std::uint32_t kForgedRadar = 2;
/// Time stamp of all forged samples.
constexpr std::int64_t kForgedTime_ns = 4711;

/// A process of its own. It uses the middleware directly: an attacker does not check its files before.
class Forger {
 public:
  /// `credentials`: folder with the six files; empty: without DDS Security. Make it before any thread and participant.
  Forger(std::uint32_t domain, const std::string& credentials);
  ~Forger();

  /// Joins the domain.
  void begin() { counts_->may_begin = true; }
  /// Samples of the health service that it has read.
  [[nodiscard]] int read() const { return counts_->read; }
  [[nodiscard]] bool has_failed() const { return counts_->failed; }

 private:
  struct Counts {
    std::atomic<bool> may_begin, failed;
    std::atomic<int> read;
  };
  [[nodiscard]] static int run(Counts& counts, std::uint32_t domain, const std::string& credentials);

  harness::Shared<Counts> counts_;
  std::unique_ptr<harness::Child> child_;
};

}  // namespace boresight
