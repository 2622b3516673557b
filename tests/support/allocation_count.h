#pragma once
// How often the calling thread has allocated memory, to prove that real-time code does not. Counts
// malloc, calloc, realloc and all that is built on them, also under the sanitizers.

#include <cstdint>

namespace tenon::tests {

[[nodiscard]] std::uint64_t allocation_count();

}  // namespace tenon::tests
