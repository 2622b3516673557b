#include "tests/support/allocation_count.h"

#include <cstddef>

namespace {
thread_local std::uint64_t count = 0;
}

std::uint64_t tenon::tests::allocation_count() { return count; }

extern "C" {
// NOLINTBEGIN(readability-identifier-naming)
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

// Of the sanitizers' runtime; its header is not installed everywhere.
int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                              void (*on_free)(const volatile void*));
static const int kHooked = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { ++count; }, [](const volatile void*) {});

#else

// glibc's own entry points, which it exports for this; ours stand before them.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t n, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) noexcept {
  ++count;
  return __libc_calloc(n, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  ++count;
  return __libc_realloc(memory, size);
}

#endif
// NOLINTEND(readability-identifier-naming)
}
