#include "tests/system/harness/roudi.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

namespace boresight::harness {

Roudi::Roudi(const std::vector<roudi::Segment>& segments) {
  const std::filesystem::path pools = "/tmp/test_roudi.toml";
  const std::filesystem::path log = "/tmp/test_roudi.log";
  std::ofstream(pools) << roudi::to_toml(segments);
  std::filesystem::remove(log);
  process_ = std::make_unique<Child>([&] {
    const int output = open(log.c_str(), O_CREAT | O_WRONLY, 0644);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    execlp("iox-roudi", "iox-roudi", "-m", "off", "-c", pools.c_str(), nullptr);
    return 127;
  });
  const bool ready = eventually(10.0, [&] {
    std::ifstream said(log);
    const std::string text((std::istreambuf_iterator<char>(said)), std::istreambuf_iterator<char>());
    return text.find("RouDi is ready for clients") != std::string::npos;
  });
  if (!ready) throw std::runtime_error("RouDi did not become ready; see " + log.string());
}

Roudi::~Roudi() {
  static_cast<void>(process_->stop());
}

}  // namespace boresight::harness
