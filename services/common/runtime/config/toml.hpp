// toml++ with its assertions as exceptions. Version 3.3 asserts on some malformed documents ("[,", its pull request
// 301), which must be rejected like any other; without assertions it would accept them.
#pragma once

#include <stdexcept>

namespace boresight::config {

struct TomlAssertion : std::logic_error {
  using std::logic_error::logic_error;
};

[[noreturn]] inline void throw_toml_assertion() {
  throw TomlAssertion("malformed");
}

}  // namespace boresight::config

#undef NDEBUG
#define TOML_ASSERT(holds) ((holds) ? static_cast<void>(0) : ::boresight::config::throw_toml_assertion())
#include <toml++/toml.h>
