#include "hw/canopen/sdo_client.h"

#include <algorithm>
#include <cassert>

#include "shared/base/bytes.h"
#include "shared/canopen/constants.h"

namespace tenon::hw::canopen {
namespace {

constexpr std::uint32_t kAbortOutOfMemory = 0x05040005;

}  // namespace

CanFrame SdoClient::start_upload(const SdoAddress& address, std::int64_t now_ns) {
  size_ = 0;
  begin(address, Phase::kUpload, now_ns);
  return sdo_upload(address);
}

CanFrame SdoClient::start_download(const SdoAddress& address, std::span<const std::uint8_t> data,
                                   std::int64_t now_ns) {
  assert(!data.empty() && data.size() <= kMaxBytes);
  std::copy(data.begin(), data.end(), buffer_.begin());
  size_ = data.size();
  begin(address, Phase::kDownload, now_ns);
  if (size_ <= 4) {
    sent_ = size_;
    return sdo_download_expedited(address, data);
  }
  return sdo_download_segmented(address, static_cast<std::uint32_t>(size_));
}

std::optional<CanFrame> SdoClient::process(const CanFrame& frame, std::int64_t now_ns) {
  if (state_ != State::kBusy || !concerns(frame)) {
    return std::nullopt;
  }
  deadline_ns_ = std::min(now_ns + timeout_ns_, end_ns_);
  const unsigned command = frame.data[0];
  if (command == 0x80) {
    abort_code_ = load_le<std::uint32_t>(std::span(frame.data).subspan(4));
    state_ = State::kAborted;
    return std::nullopt;
  }
  switch (phase_) {
    case Phase::kUpload:
      return on_upload(frame);
    case Phase::kUploadSegment:
      return on_upload_segment(frame);
    case Phase::kDownload:
      if (command != 0x60) {
        return abort(tenon::canopen::kAbortCommand);
      }
      toggle_ = false;
      return on_download_accepted();
    case Phase::kDownloadSegment:
      if ((command & 0xE0) != 0x20) {
        return abort(tenon::canopen::kAbortCommand);
      }
      if (((command & 0x10) != 0) != toggle_) {
        return abort(tenon::canopen::kAbortToggle);
      }
      toggle_ = !toggle_;
      return on_download_accepted();
  }
  return std::nullopt;
}

std::optional<CanFrame> SdoClient::update(std::int64_t now_ns) {
  if (state_ != State::kBusy || now_ns < deadline_ns_) {
    return std::nullopt;
  }
  state_ = State::kTimedOut;
  return sdo_abort(address_, tenon::canopen::kAbortTimeout);
}

std::uint32_t SdoClient::value() const {
  std::array<std::uint8_t, 4> bytes{};
  std::copy_n(buffer_.begin(), std::min<std::size_t>(size_, 4), bytes.begin());
  return load_le<std::uint32_t>(bytes);
}

void SdoClient::begin(const SdoAddress& address, Phase phase, std::int64_t now_ns) {
  address_ = address;
  phase_ = phase;
  state_ = State::kBusy;
  deadline_ns_ = now_ns + timeout_ns_;
  end_ns_ = now_ns + kTimeoutsMost * timeout_ns_;
  abort_code_ = 0;
  toggle_ = false;
  sent_ = 0;
}

CanFrame SdoClient::abort(std::uint32_t code) {
  state_ = State::kAborted;
  abort_code_ = code;
  return sdo_abort(address_, code);
}

std::optional<CanFrame> SdoClient::on_upload(const CanFrame& frame) {
  const unsigned command = frame.data[0];
  if ((command & 0xE0) != 0x40) {
    return abort(tenon::canopen::kAbortCommand);
  }
  if ((command & 0x02) != 0) {  // expedited
    size_ = (command & 0x01) != 0 ? 4 - ((command >> 2) & 3) : 4;
    std::copy_n(frame.data.begin() + 4, size_, buffer_.begin());
    state_ = State::kDone;
    return std::nullopt;
  }
  phase_ = Phase::kUploadSegment;
  return sdo_upload_segment(address_.node, toggle_);
}

std::optional<CanFrame> SdoClient::on_upload_segment(const CanFrame& frame) {
  const unsigned command = frame.data[0];
  if ((command & 0xE0) != 0x00) {
    return abort(tenon::canopen::kAbortCommand);
  }
  if (((command & 0x10) != 0) != toggle_) {
    return abort(tenon::canopen::kAbortToggle);
  }
  const std::size_t count = 7 - ((command >> 1) & 7);
  const bool last = (command & 0x01) != 0;
  if (count == 0 && !last) {
    return abort(tenon::canopen::kAbortCommand);
  }
  if (size_ + count > kMaxBytes) {
    return abort(kAbortOutOfMemory);
  }
  std::copy_n(frame.data.begin() + 1, count, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += count;
  if (last) {
    state_ = State::kDone;
    return std::nullopt;
  }
  toggle_ = !toggle_;
  return sdo_upload_segment(address_.node, toggle_);
}

std::optional<CanFrame> SdoClient::on_download_accepted() {
  if (sent_ == size_) {
    state_ = State::kDone;
    return std::nullopt;
  }
  phase_ = Phase::kDownloadSegment;
  return next_segment();
}

CanFrame SdoClient::next_segment() {
  const std::size_t count = std::min<std::size_t>(size_ - sent_, 7);
  const auto segment = std::span(buffer_).subspan(sent_, count);
  sent_ += count;
  return sdo_download_segment(address_.node, toggle_, sent_ == size_, segment);
}

bool SdoClient::concerns(const CanFrame& frame) const {
  if (frame.extended || frame.remote || frame.length != 8 ||
      frame.id != tenon::canopen::kSdoResponse + address_.node) {
    return false;
  }
  // Segments do not repeat the address; everything else does.
  const bool segment = (phase_ == Phase::kUploadSegment || phase_ == Phase::kDownloadSegment) &&
                       frame.data[0] != 0x80;
  return segment || (load_le<std::uint16_t>(std::span(frame.data).subspan(1)) == address_.index &&
                     frame.data[3] == address_.sub);
}

}  // namespace tenon::hw::canopen
