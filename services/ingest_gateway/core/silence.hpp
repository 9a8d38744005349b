// When time may pass by the clock instead of by the stamps of frames.
#pragma once

#include <cstdint>
#include <utility>

namespace boresight::ingest {

/// While frames come, their stamps tell the time: after a pause of the process, frames that waited are older than the
/// clock says, and what they complete must not be given up before they have been read.
class Silence {
 public:
  void frame_came() { heard_ = true; }
  /// To be asked every 5 ms or so; true if nothing came since it was asked last. False after a pause of the process,
  /// too, as what came meanwhile may not have been read yet.
  [[nodiscard]] bool reigns(std::int64_t now_ns) {
    constexpr std::int64_t kPaused_ns = 25'000'000;
    const bool paused = now_ns - std::exchange(asked_ns_, now_ns) > kPaused_ns;
    return !std::exchange(heard_, false) && !paused;
  }

 private:
  bool heard_ = false;
  std::int64_t asked_ns_ = 0;
};

}  // namespace boresight::ingest
