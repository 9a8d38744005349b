// An interface that cannot be recorded.
#pragma once

#include <stdexcept>

namespace boresight::record {

/// what() names the interface, the cause and, if there is one, the remedy.
class CaptureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace boresight::record
