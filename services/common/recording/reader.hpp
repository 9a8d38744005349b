// Recordings as streams of frames: candump logs and pcap/pcapng captures, one or several merged by time stamp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/common/recording/frame.hpp"

namespace boresight::recording {

/// A recording that cannot be opened at all; what() names the file and the cause.
class OpenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Called for each line or packet that cannot be understood: "file:line: problem". The rest is read on.
using OnProblem = std::function<void(const std::string&)>;

class Reader {
 public:
  virtual ~Reader() = default;
  /// The next frame; false at the end. The payload is valid until the next call.
  [[nodiscard]] virtual bool next(Frame& frame) = 0;
  [[nodiscard]] virtual std::uint64_t problems() const = 0;
};

/// Opens a recording by its content (pcap, pcapng, else candump). Throws OpenError.
[[nodiscard]] std::unique_ptr<Reader> open_recording(const std::filesystem::path& file, OnProblem on_problem);

/// Several recordings as one, ordered by stamp (equal stamps: by position in `files`). Recordings of one drive must
/// share a clock. Throws OpenError, also for an empty list.
[[nodiscard]] std::unique_ptr<Reader> open_recordings(const std::vector<std::filesystem::path>& files,
                                                      const OnProblem& on_problem);

}  // namespace boresight::recording
