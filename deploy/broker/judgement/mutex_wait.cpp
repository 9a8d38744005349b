#include "deploy/broker/judgement/mutex_wait.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>

#include <linux/futex.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/uio.h>

namespace boresight::broker {

namespace {

/// The first members of pthread_mutex_t, the same for all kinds that do not inherit priorities.
struct MutexHead {
  std::int32_t lock;  ///< 0 free, 1 locked, 2 locked and waited for
  std::uint32_t count;
  std::int32_t owner;  ///< thread; 0: none
};
constexpr std::int32_t kContended = 2;

/// The next number of the text, decimal or with 0x, which is removed with the blanks before it.
std::optional<std::uint64_t> take_number(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  int base = 10;
  if (text.starts_with("0x")) {
    text.remove_prefix(2);
    base = 16;
  }
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// Also of another user's process, which this one may not signal.
bool lives(pid_t thread) {
  return kill(thread, 0) == 0 || errno != ESRCH;
}

}  // namespace

std::optional<MutexWait> parse_mutex_wait(std::string_view syscall) {
  const auto number = take_number(syscall), address = take_number(syscall), operation = take_number(syscall),
             value = take_number(syscall);
  if (!number || !address || !operation || !value || *number != SYS_futex) return std::nullopt;
  constexpr std::uint64_t kFlags = FUTEX_PRIVATE_FLAG | FUTEX_CLOCK_REALTIME;
  if ((*operation & ~kFlags) != FUTEX_WAIT || *value != kContended) return std::nullopt;
  return MutexWait{*address};
}

Wait wait_of(pid_t pid, std::string_view syscall) {
  if (syscall.empty()) return Wait::kUnknown;
  const auto mutex = parse_mutex_wait(syscall);
  if (!mutex) return Wait::kOther;
  MutexHead head{};
  const iovec here{.iov_base = &head, .iov_len = sizeof(head)};
  const iovec there{.iov_base = reinterpret_cast<void*>(mutex->address), .iov_len = sizeof(head)};
  if (process_vm_readv(pid, &here, 1, &there, 1, 0) != sizeof(head)) return Wait::kUnknown;
  // Unlocked or handed on since the first look.
  if (head.lock != kContended || head.owner <= 0) return Wait::kMutexOfAnother;
  return lives(head.owner) ? Wait::kMutexOfAnother : Wait::kMutexOfTheDead;
}

}  // namespace boresight::broker
