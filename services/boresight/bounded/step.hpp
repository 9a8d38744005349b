// Steps of a middleware that has no time limit of its own: each is done in another thread, and left to itself after a
// limit.
#pragma once

#include <chrono>
#include <functional>

namespace boresight::bounded {

/// Runs `step` in a thread of its own and waits for its end; rethrows what it throws. False if the limit passes or
/// `is_cancelled` becomes true before. Then the thread runs on until the process ends, so `step` must own what it uses.
[[nodiscard]] bool ends_within(
    std::chrono::milliseconds limit, std::function<void()> step,
    const std::function<bool()>& is_cancelled = [] { return false; });

/// Ends the process without the destructors of static objects, which wait for the middleware's threads without a limit,
/// if ends_within() was called; else returns. Output that the standard library holds is written.
void end_process_of_steps(int exit_code);

}  // namespace boresight::bounded
