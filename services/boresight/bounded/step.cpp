#include "services/boresight/bounded/step.hpp"

#include <atomic>
#include <cstdio>
#include <future>
#include <thread>
#include <utility>

#include <unistd.h>

namespace boresight::bounded {

namespace {

std::atomic<bool> a_step_was_begun{false};

}  // namespace

bool ends_within(std::chrono::milliseconds limit, std::function<void()> step,
                 const std::function<bool()>& is_cancelled) {
  constexpr std::chrono::milliseconds kLook{20};
  a_step_was_begun = true;
  std::packaged_task<void()> task(std::move(step));
  std::future<void> end = task.get_future();
  std::thread(std::move(task)).detach();
  const auto latest = std::chrono::steady_clock::now() + limit;
  while (end.wait_for(kLook) != std::future_status::ready) {
    if (is_cancelled() || std::chrono::steady_clock::now() >= latest) return false;
  }
  end.get();
  return true;
}

void end_process_of_steps(int exit_code) {
  if (!a_step_was_begun) return;
  std::fflush(nullptr);
  _exit(exit_code);
}

}  // namespace boresight::bounded
