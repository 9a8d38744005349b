// The exit codes of every program of the product.
#pragma once

namespace boresight::exit_code {

inline constexpr int kSuccess = 0;
/// The work was done, and its result is a finding: a check failed, or a recording is damaged. In a service: any failure
/// at run time.
inline constexpr int kFinding = 1;
/// Command line or configuration.
inline constexpr int kUsage = 2;
/// Input that cannot be read, output that cannot be written, or a resource of the system that is missing.
inline constexpr int kInputOutput = 3;
/// A service: an error of the middleware after which it cannot continue. As EX_SOFTWARE of sysexits.h.
inline constexpr int kMiddleware = 70;
/// Added to the number of the signal that ended the program: 130 for Ctrl-C (SIGINT), 143 for SIGTERM.
inline constexpr int kSignalBase = 128;

}  // namespace boresight::exit_code
