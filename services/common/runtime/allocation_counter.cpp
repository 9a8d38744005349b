#include "services/common/runtime/allocation_counter.hpp"

#include <cerrno>
#include <cstddef>

namespace boresight::runtime {

namespace {

thread_local bool counting = false;
thread_local std::uint64_t allocations = 0;

}  // namespace

std::uint64_t counted_allocations() {
  return allocations;
}

CountAllocations::CountAllocations(bool enabled) : before_(counting) {
  counting = enabled;
}
CountAllocations::~CountAllocations() {
  counting = before_;
}
AllowAllocations::AllowAllocations() : before_(counting) {
  counting = false;
}
AllowAllocations::~AllowAllocations() {
  counting = before_;
}

namespace detail {
void note_allocation() {
  if (counting) ++allocations;
}
}  // namespace detail

}  // namespace boresight::runtime

#ifndef BORESIGHT_SANITIZED

extern "C" {

// glibc's own entry points, exported for replacements of malloc.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* pointer, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  boresight::runtime::detail::note_allocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  boresight::runtime::detail::note_allocation();
  return __libc_calloc(count, size);
}

void* realloc(void* pointer, std::size_t size) {
  boresight::runtime::detail::note_allocation();
  return __libc_realloc(pointer, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  boresight::runtime::detail::note_allocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  boresight::runtime::detail::note_allocation();
  void* const pointer = __libc_memalign(alignment, size);
  if (pointer == nullptr) return ENOMEM;
  *result = pointer;
  return 0;
}

}  // extern "C"

#endif
