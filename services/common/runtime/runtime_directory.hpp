// Folder of the sockets that processes of one system share.
#pragma once

#include <string>

namespace boresight::runtime {

/// $BORESIGHT_RUNTIME_DIR, else the first of $RUNTIME_DIRECTORY (set by systemd), else /tmp/boresight-<uid>.
[[nodiscard]] std::string runtime_directory();

}  // namespace boresight::runtime
