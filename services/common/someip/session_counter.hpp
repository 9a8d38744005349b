// Session ids of SOME/IP, for events and for service discovery.
#pragma once

#include <cstdint>

namespace boresight::someip {

/// SOME/IP session ids: 1, 2, … 0xFFFF, 1, …
class SessionCounter {
 public:
  /// The next id to send.
  std::uint16_t take() {
    const std::uint16_t session = next_;
    next_ = next_ == 0xFFFF ? std::uint16_t{1} : static_cast<std::uint16_t>(next_ + 1);
    wrapped_ = wrapped_ || (started_ && session == 1);
    started_ = true;
    return session;
  }
  /// True after the first wrap of the id: service discovery's reboot flag is then clear.
  [[nodiscard]] bool wrapped() const { return wrapped_; }

 private:
  std::uint16_t next_ = 1;
  bool started_ = false;
  bool wrapped_ = false;
};

}  // namespace boresight::someip
