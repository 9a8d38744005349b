// Reads recordings as streams of frames: candump logs and pcap/pcapng captures, one, or several merged by time stamp.
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

/// A recording that cannot be opened; what() names the file and the cause.
class OpenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Called for each line or packet that cannot be decoded: "file:line: problem". Reading continues.
using OnProblem = std::function<void(const std::string&)>;

struct ReadOptions {
  /// The interface of CAN frames in captures without its name: all classic pcap, some pcapng.
  std::string can_interface = "can0";
};

/// Progress of reading, for a progress bar.
struct Progress {
  std::uint64_t position_bytes = 0;
  std::uint64_t total_bytes = 0;  ///< 0: unknown, because the recording is a pipe
};

struct Counts {
  std::uint64_t frames = 0;        ///< delivered
  std::uint64_t problems = 0;      ///< lines or packets that could not be decoded, each reported to OnProblem
  std::uint64_t error_frames = 0;  ///< of CAN: states of the bus, not delivered
  std::uint64_t ignored = 0;       ///< packets that are well-formed, but neither CAN nor UDP
  std::uint64_t backwards = 0;     ///< frames stamped earlier than the previous one
};

class Reader {
 public:
  virtual ~Reader() = default;
  /// The next frame; false at the end. The payload is valid until the next call.
  [[nodiscard]] virtual bool next(Frame& frame) = 0;
  [[nodiscard]] virtual Counts counts() const = 0;
  [[nodiscard]] virtual Progress progress() const = 0;
  [[nodiscard]] std::uint64_t problems() const { return counts().problems; }
};

/// Opens a recording by its content (pcap, pcapng, else candump); "-" is standard input. Memory does not depend on
/// the recording's size. Throws OpenError.
[[nodiscard]] std::unique_ptr<Reader> open_recording(const std::filesystem::path& file, OnProblem on_problem,
                                                     const ReadOptions& options = {});

/// Several recordings as one, ordered by stamp (equal stamps: by position in `files`). Recordings of one drive must
/// share a clock. Throws OpenError, also for an empty list.
[[nodiscard]] std::unique_ptr<Reader> open_recordings(const std::vector<std::filesystem::path>& files,
                                                      const OnProblem& on_problem, const ReadOptions& options = {});

}  // namespace boresight::recording
