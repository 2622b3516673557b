#pragma once
// One non-blocking file descriptor (socket, serial port, pty) that speaks slcan: characters in and
// out, bounded buffers. Neither allocates nor throws after construction; one thread; owns the
// descriptor.
//
// Outgoing lines are staged and leave together with flush(), so that the frames of one cycle cost
// one system call. Where the descriptor takes no more, lines that have not begun to leave are
// dropped and counted: a setpoint that is late is not worth sending.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hw/can/slcan.h"
#include "shared/system/descriptor.h"

namespace tenon::hw {

class SlcanStream {
 public:
  SlcanStream() = default;
  SlcanStream(const SlcanStream&) = delete;
  SlcanStream& operator=(const SlcanStream&) = delete;

  /// Takes over an open, non-blocking descriptor in place of the one before.
  void adopt(Descriptor descriptor) noexcept;
  void close() noexcept { (void)descriptor_.close(); }
  [[nodiscard]] bool is_open() const noexcept { return descriptor_.is_open(); }
  [[nodiscard]] int descriptor() const noexcept { return descriptor_.get(); }

  /// Stages a line (with its CR). False: the descriptor takes nothing, or the stage is full.
  [[nodiscard]] bool stage(std::string_view line) noexcept;
  /// Sends what is staged, as far as it goes. A broken connection closes the stream.
  void flush() noexcept;
  /// Reads what there is into the buffer. A broken connection closes the stream.
  void fill() noexcept;
  /// The next message out of the buffer.
  [[nodiscard]] std::optional<SlcanParser::Message> next() noexcept;
  [[nodiscard]] bool has_input() const noexcept { return read_at_ < read_size_; }

  [[nodiscard]] std::uint64_t malformed() const noexcept { return parser_.malformed(); }
  /// Lines dropped by flush().
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  void discard_staged(std::size_t sent) noexcept;

  static constexpr std::size_t kBuffer = 4096;
  Descriptor descriptor_;
  bool is_socket_ = false;
  SlcanParser parser_;
  std::array<char, kBuffer> read_{};
  std::size_t read_at_ = 0;
  std::size_t read_size_ = 0;
  std::array<char, kBuffer> staged_{};
  std::size_t staged_size_ = 0;
  bool line_begun_ = false;  ///< a part of the first staged line has left already
  bool blocked_ = false;     ///< the descriptor took no more at the last flush
  std::uint64_t dropped_ = 0;
};

}  // namespace tenon::hw
