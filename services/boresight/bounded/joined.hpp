// A participant of a DDS domain that joins and leaves within limits. A middleware whose network interface vanishes may
// wait for ever in both.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "services/boresight/bounded/step.hpp"

namespace boresight::bounded {

struct Limits {
  std::chrono::milliseconds join{10'000};  ///< choice: it takes 20 ms, and 3 s in a secured domain on a busy machine
  std::chrono::milliseconds leave{3'000};  ///< choice: it takes 10 ms; the result is known before
};

template <typename Participant>
class Joined {
 public:
  using Make = std::function<std::unique_ptr<Participant>()>;

  /// `make` joins `domain`; it must own what it uses, and so must the participant. Throws what `make` throws, and
  /// std::runtime_error if it does not return in time or `is_cancelled` becomes true.
  Joined(const std::string& domain, Make make, const std::function<bool()>& is_cancelled, const Limits& limits = {})
      : limits_(limits) {
    const auto made = std::make_shared<std::unique_ptr<Participant>>();
    if (!ends_within(
            limits.join, [made, make = std::move(make)] { *made = make(); }, is_cancelled)) {
      throw std::runtime_error(domain + " was not joined within " + std::to_string(limits.join.count() / 1000) + " s");
    }
    participant_ = std::move(*made);
  }
  ~Joined() { leave(); }
  Joined(const Joined&) = delete;
  Joined& operator=(const Joined&) = delete;

  /// Leaves the domain, or gives the participant up: then its callbacks may come as long as the process runs.
  void leave() {
    if (participant_ == nullptr) return;
    // A std::function must be able to copy what it owns.
    const auto last = std::make_shared<std::unique_ptr<Participant>>(std::move(participant_));
    static_cast<void>(ends_within(limits_.leave, [last] { last->reset(); }));
  }

  Participant& operator*() const { return *participant_; }
  Participant* operator->() const { return participant_.get(); }

 private:
  Limits limits_;
  std::unique_ptr<Participant> participant_;
};

}  // namespace boresight::bounded
