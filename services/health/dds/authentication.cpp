#include "services/health/dds/authentication.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

namespace boresight::dds {

namespace {

constexpr std::size_t kShortestKey = 32;
constexpr std::size_t kLongestKey = 4096;

/// Why the file is not taken as a secret; empty if it is.
std::string refusal_of(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) return std::strerror(errno);
  if (!S_ISREG(status.st_mode)) return "no regular file";
  if ((status.st_mode & S_IRWXO) != 0) return "others have access to it; chmod o= FILE";
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size < kShortestKey || size > kLongestKey) {
    return "it has " + std::to_string(size) + " bytes; " + std::to_string(kShortestKey) + " to " +
           std::to_string(kLongestKey) + " are allowed";
  }
  return {};
}

}  // namespace

CommandKey read_command_key(const std::filesystem::path& file, std::string& problem) {
  problem.clear();
  const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    problem = file.string() + ": " + std::strerror(errno);
    return {};
  }
  problem = refusal_of(descriptor);
  CommandKey key(kLongestKey);
  const ssize_t size = problem.empty() ? read(descriptor, key.data(), key.size()) : -1;
  if (size < 0 && problem.empty()) problem = std::strerror(errno);
  close(descriptor);
  if (!problem.empty()) {
    problem = file.string() + ": " + problem;
    return {};
  }
  key.resize(static_cast<std::size_t>(size));
  return key;
}

Challenge new_challenge() {
  Challenge challenge{};
  if (RAND_bytes(challenge.data(), static_cast<int>(challenge.size())) != 1) {
    throw std::runtime_error("no random numbers for a challenge");
  }
  return challenge;
}

Authentication authentication_of(const CommandKey& key, const Challenge& challenge, std::uint64_t number,
                                 std::uint32_t dtc) {
  std::array<std::uint8_t, std::tuple_size_v<Challenge> + 12> message{};
  std::copy(challenge.begin(), challenge.end(), message.begin());
  for (std::size_t i = 0; i < 8; ++i) message[challenge.size() + i] = static_cast<std::uint8_t>(number >> (56 - 8 * i));
  for (std::size_t i = 0; i < 4; ++i)
    message[challenge.size() + 8 + i] = static_cast<std::uint8_t>(dtc >> (24 - 8 * i));
  Authentication result{};
  unsigned size = 0;
  const auto* const made = HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), message.data(), message.size(),
                                result.data(), &size);
  if (made == nullptr || size != result.size()) throw std::runtime_error("HMAC-SHA-256 is not available");
  return result;
}

bool is_authentic(const CommandKey& key, const Challenge& challenge, std::uint64_t number, std::uint32_t dtc,
                  const Authentication& given) {
  if (key.empty()) return false;
  const Authentication expected = authentication_of(key, challenge, number, dtc);
  return CRYPTO_memcmp(expected.data(), given.data(), expected.size()) == 0;
}

}  // namespace boresight::dds
