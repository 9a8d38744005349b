// A wall clock that a test can step, for processes that preload this library. The file $BORESIGHT_TEST_WALL_CLOCK holds
// the offset in nanoseconds. As with a real step, a wait that ends at a time of the wall clock lasts longer after a
// step back; a wait for a duration does not.
#include <cerrno>
#include <cstdint>
#include <cstdlib>

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kLook_ns = 2'000'000;
// Earlier times are of a clock that starts with the machine.
constexpr std::int64_t kYear2001_ns = 1'000'000'000 * kSecond_ns;

const volatile std::int64_t* open_offset() {
  static const std::int64_t none = 0;
  const char* const path = std::getenv("BORESIGHT_TEST_WALL_CLOCK");
  const int file = path == nullptr ? -1 : open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return &none;
  void* const memory = mmap(nullptr, sizeof(std::int64_t), PROT_READ, MAP_SHARED, file, 0);
  close(file);
  return memory == MAP_FAILED ? &none : static_cast<const std::int64_t*>(memory);
}

std::int64_t offset_ns() {
  static const volatile std::int64_t* const offset = open_offset();
  return *offset;
}

std::int64_t to_ns(const timespec& time) {
  return time.tv_sec * kSecond_ns + time.tv_nsec;
}

timespec to_timespec(std::int64_t time_ns) {
  return {.tv_sec = time_ns / kSecond_ns, .tv_nsec = time_ns % kSecond_ns};
}

std::int64_t read_ns(clockid_t clock) {
  timespec now{};
  syscall(SYS_clock_gettime, clock, &now);
  return to_ns(now);
}

std::int64_t wall_now_ns() {
  return read_ns(CLOCK_REALTIME) + offset_ns();
}

/// Calls `wait(end)` with an end soon on the monotonic clock until it returns something else than ETIMEDOUT, or the
/// stepped wall clock reaches `end_ns`.
template <typename Wait>
int wait_in_parts(std::int64_t end_ns, const Wait& wait) {
  for (;;) {
    const timespec soon = to_timespec(read_ns(CLOCK_MONOTONIC) + kLook_ns);
    const int result = wait(soon);
    if (result != ETIMEDOUT) return result;
    if (wall_now_ns() >= end_ns) return ETIMEDOUT;
  }
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const auto result = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
    *time = to_timespec(to_ns(*time) + offset_ns());
  return result;
}

int gettimeofday(timeval* time, void*) noexcept {
  const std::int64_t now_ns = wall_now_ns();
  *time = {.tv_sec = now_ns / kSecond_ns, .tv_usec = now_ns % kSecond_ns / 1000};
  return 0;
}

time_t time(time_t* time) noexcept {
  const time_t now = wall_now_ns() / kSecond_ns;
  if (time != nullptr) *time = now;
  return now;
}

int sem_timedwait(sem_t* semaphore, const timespec* end) {
  if (sem_trywait(semaphore) == 0) return 0;
  const int result = wait_in_parts(to_ns(*end), [&](const timespec& soon) {
    return sem_clockwait(semaphore, CLOCK_MONOTONIC, &soon) == 0 ? 0 : errno;
  });
  errno = result;
  return result == 0 ? 0 : -1;
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* end) {
  if (to_ns(*end) < kYear2001_ns) {
    using Original = int (*)(pthread_cond_t*, pthread_mutex_t*, const timespec*);
    static const auto original = next<Original>("pthread_cond_timedwait");
    return original(condition, mutex, end);
  }
  return wait_in_parts(to_ns(*end), [&](const timespec& soon) {
    return pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, &soon);
  });
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* rest) {
  using Original = int (*)(clockid_t, int, const timespec*, timespec*);
  static const auto original = next<Original>("clock_nanosleep");
  if (clock != CLOCK_REALTIME || (flags & TIMER_ABSTIME) == 0) return original(clock, flags, time, rest);
  const int result = wait_in_parts(to_ns(*time), [&](const timespec& soon) {
    const int slept = original(CLOCK_MONOTONIC, TIMER_ABSTIME, &soon, nullptr);
    return slept == 0 ? ETIMEDOUT : slept;
  });
  return result == ETIMEDOUT ? 0 : result;
}

}  // extern "C"
