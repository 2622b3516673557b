#include "hw/can/slcan_stream.h"

#include <errno.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace tenon::hw {
namespace {

bool would_block(int error) { return error == EAGAIN || error == EWOULDBLOCK; }

}  // namespace

void SlcanStream::adopt(Descriptor descriptor) noexcept {
  descriptor_ = std::move(descriptor);
  int type = 0;
  socklen_t size = sizeof(type);
  is_socket_ = ::getsockopt(descriptor_.get(), SOL_SOCKET, SO_TYPE, &type, &size) == 0;
  parser_.reset();
  read_at_ = read_size_ = staged_size_ = 0;
  line_begun_ = blocked_ = false;
}

bool SlcanStream::stage(std::string_view line) noexcept {
  if (blocked_ || staged_size_ + line.size() > staged_.size()) {
    flush();
  }
  if (!is_open() || blocked_ || staged_size_ + line.size() > staged_.size()) {
    return false;
  }
  std::copy(line.begin(), line.end(), staged_.begin() + static_cast<std::ptrdiff_t>(staged_size_));
  staged_size_ += line.size();
  return true;
}

void SlcanStream::flush() noexcept {
  if (blocked_ && staged_size_ == 0) {
    // Nothing to try with: ask.
    pollfd wanted{descriptor_.get(), POLLOUT, 0};
    blocked_ = ::poll(&wanted, 1, 0) == 0;
    return;
  }
  blocked_ = false;
  std::size_t sent = 0;
  while (is_open() && sent < staged_size_) {
    const char* from = staged_.data() + sent;
    const std::size_t count = staged_size_ - sent;
    const ssize_t written = is_socket_ ? ::send(descriptor_.get(), from, count, MSG_NOSIGNAL)
                                       : ::write(descriptor_.get(), from, count);
    if (written > 0) {
      sent += static_cast<std::size_t>(written);
    } else if (written == 0 || would_block(errno)) {
      blocked_ = true;
      break;
    } else if (errno != EINTR) {
      close();
    }
  }
  discard_staged(sent);
}

/// Forgets what has been sent and, where the descriptor is blocked, every line not begun.
void SlcanStream::discard_staged(std::size_t sent) noexcept {
  char* const begin = staged_.data();
  char* const end = begin + staged_size_;
  char* const unsent = begin + sent;
  if (sent > 0) {
    line_begun_ = unsent[-1] != '\r';
  }
  char* keep_until = end;
  if (blocked_) {
    keep_until = line_begun_ ? std::find(unsent, end, '\r') + 1 : unsent;
    dropped_ += static_cast<std::uint64_t>(std::count(keep_until, end, '\r'));
  }
  std::copy(unsent, keep_until, begin);
  staged_size_ = static_cast<std::size_t>(keep_until - unsent);
}

void SlcanStream::fill() noexcept {
  if (!is_open() || has_input()) {
    return;
  }
  const ssize_t count = ::read(descriptor_.get(), read_.data(), read_.size());
  if (count > 0) {
    read_at_ = 0;
    read_size_ = static_cast<std::size_t>(count);
  } else if (count == 0 || (!would_block(errno) && errno != EINTR)) {
    close();
  }
}

std::optional<SlcanParser::Message> SlcanStream::next() noexcept {
  while (has_input()) {
    if (auto message = parser_.push(read_[read_at_++])) {
      return message;
    }
  }
  return std::nullopt;
}

}  // namespace tenon::hw
