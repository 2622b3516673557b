// The ring between the real-time thread and the one that writes, with a thread at either end.

#include "shared/base/spsc_ring.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace tenon {
namespace {

TEST(SpscRing, TwoThreadsLoseNothingUncountedAndTearNothing) {
  struct Element {
    std::uint64_t number;
    std::array<std::uint64_t, 15> copies;
  };
  constexpr std::uint64_t kElements = 200'000;
  SpscRing<Element, 64> ring;

  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  std::thread producer([&] {
    const auto push = [&](std::uint64_t number) {
      Element element{number, {}};
      element.copies.fill(number);
      const bool pushed = ring.push(element);
      ++(pushed ? accepted : refused);
      return pushed;
    };
    for (std::uint64_t i = 0; i < kElements; ++i) (void)push(i);
    while (!push(kElements)) std::this_thread::yield();
  });

  std::uint64_t received = 0;
  std::uint64_t torn = 0;
  std::uint64_t out_of_order = 0;
  std::uint64_t next = 0;
  for (Element element{}; next <= kElements;) {
    if (!ring.pop(element)) {
      std::this_thread::yield();
      continue;
    }
    ++received;
    if (element.number < next) ++out_of_order;
    for (const std::uint64_t copy : element.copies) torn += copy != element.number ? 1U : 0U;
    next = element.number + 1;
  }
  producer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(out_of_order, 0U);
  EXPECT_EQ(received, accepted);
  EXPECT_EQ(ring.dropped(), refused);
}

}  // namespace
}  // namespace tenon
