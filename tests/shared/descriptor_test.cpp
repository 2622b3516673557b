// Who owns a file descriptor, and that it is closed once.

#include "shared/system/descriptor.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <utility>

namespace tenon {
namespace {

bool is_open(int descriptor) { return ::fcntl(descriptor, F_GETFD) >= 0; }

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    out = Descriptor(ends[0]);
    in = Descriptor(ends[1]);
  }
  Descriptor out;
  Descriptor in;
};

TEST(Descriptor, IsClosedWithItsOwner) {
  int number = -1;
  {
    const Pipe pipe;
    number = pipe.in.get();
    EXPECT_TRUE(is_open(number));
  }
  EXPECT_FALSE(is_open(number));
}

TEST(Descriptor, MovesAndIsStillClosedOnce) {
  Pipe pipe;
  const int number = pipe.in.get();
  Descriptor second(std::move(pipe.in));
  EXPECT_EQ(second.get(), number);
  pipe.in = Descriptor();
  EXPECT_TRUE(is_open(number)) << "what has been moved from owns nothing";
  const int other = pipe.out.get();
  pipe.out = std::move(second);
  EXPECT_FALSE(is_open(other)) << "what stood there before is closed";
  EXPECT_TRUE(is_open(number));
}

TEST(Descriptor, ClosingTellsTheSystemsErrorAndAsksOnlyOnce) {
  Pipe pipe;
  const int number = pipe.in.get();
  ASSERT_EQ(::close(number), 0);  // behind its back
  EXPECT_EQ(pipe.in.close(), EBADF);
  EXPECT_FALSE(pipe.in.is_open());
  EXPECT_EQ(pipe.in.close(), 0);
  EXPECT_EQ(Descriptor().close(), 0);
  EXPECT_EQ(Descriptor(-1).close(), 0);
}

TEST(Descriptor, AllBytesAreWrittenOrTheErrorIsTold) {
  Pipe pipe;
  const std::array<std::uint8_t, 5> sent{1, 2, 3, 4, 5};
  EXPECT_EQ(write_all(pipe.in, sent), 0);
  std::array<std::uint8_t, 8> got{};
  EXPECT_EQ(::read(pipe.out.get(), got.data(), got.size()), 5);
  EXPECT_EQ(got[4], 5);
  EXPECT_EQ(write_all(pipe.out, sent), EBADF) << "the end that only reads";
  EXPECT_EQ(write_all(Descriptor(), sent), EBADF);
}

}  // namespace
}  // namespace tenon
