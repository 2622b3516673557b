#include "tests/support/canopen_client.h"

#include <algorithm>

namespace tenon::tests {
namespace {

constexpr std::int64_t kTimeout_ns = 500'000'000;

}  // namespace

Bytes little_endian(std::int64_t value, std::size_t size) {
  Bytes bytes;
  for (std::size_t i = 0; i < size; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }
  return bytes;
}

std::uint64_t unsigned_of(const Bytes& bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | bytes[i];
  return value;
}

std::int64_t signed_of(const Bytes& bytes) {
  const std::size_t missing_bits = 64 - 8 * bytes.size();
  return static_cast<std::int64_t>(unsigned_of(bytes) << missing_bits) >> missing_bits;
}

WireFrame CanopenClient::request(std::uint8_t command) const {
  return {0x600U + node_,
          {command, static_cast<std::uint8_t>(index_), static_cast<std::uint8_t>(index_ >> 8), sub_,
           0, 0, 0, 0}};
}

WireFrame CanopenClient::begin_read(std::uint16_t index, std::uint8_t sub, std::int64_t now_ns) {
  index_ = index;
  sub_ = sub;
  bytes_.clear();
  answer_.reset();
  asked_ns_ = now_ns;
  step_ = Step::kInitiateRead;
  return request(0x40);
}

WireFrame CanopenClient::begin_write(std::uint16_t index, std::uint8_t sub, const Bytes& bytes,
                                     Transfer transfer, std::int64_t now_ns) {
  index_ = index;
  sub_ = sub;
  bytes_ = bytes;
  offset_ = 0;
  toggle_ = 0;
  answer_.reset();
  asked_ns_ = now_ns;
  step_ = Step::kInitiateWrite;
  // 001 x nn e s: nn bytes of four without data, expedited, size told.
  WireFrame frame = request(0x20);
  if (transfer == Transfer::kExpedited || transfer == Transfer::kExpeditedUnsized) {
    frame.data[0] |= 0x02;
    if (transfer == Transfer::kExpedited) {
      frame.data[0] |= static_cast<std::uint8_t>(0x01 | (4 - bytes.size()) << 2);
    }
    std::copy(bytes.begin(), bytes.end(), frame.data.begin() + 4);
    offset_ = bytes.size();
  } else if (transfer == Transfer::kSegmented) {
    frame.data[0] |= 0x01;
    const Bytes size = little_endian(static_cast<std::int64_t>(bytes.size()), 4);
    std::copy(size.begin(), size.end(), frame.data.begin() + 4);
  }
  return frame;
}

std::optional<WireFrame> CanopenClient::receive(const WireFrame& frame, std::int64_t now_ns) {
  if (frame.remote) return std::nullopt;
  if (frame.id == 0x580U + node_) {
    expect(frame.data.size() == 8, "an SDO answer has 8 bytes");
    asked_ns_ = now_ns;
    if (frame.data.size() == 8) return on_sdo(frame.data);
  } else if (frame.id == 0x700U + node_) {
    expect(frame.data.size() == 1, "a heartbeat has 1 byte");
    heartbeats.push_back(frame.data.empty() ? 0xFF : frame.data[0]);
  } else if (frame.id == 0x080U + node_) {
    expect(frame.data.size() == 8, "an emergency has 8 bytes");
    if (frame.data.size() != 8) return std::nullopt;
    emergencies.push_back(
        {static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8), frame.data[2]});
  } else {
    others[frame.id].push_back(frame.data);
  }
  return std::nullopt;
}

std::optional<WireFrame> CanopenClient::advance(std::int64_t now_ns) {
  if (step_ == Step::kIdle || now_ns - asked_ns_ <= kTimeout_ns) return std::nullopt;
  WireFrame frame = request(0x80);
  const Bytes code = little_endian(0x05040000, 4);
  std::copy(code.begin(), code.end(), frame.data.begin() + 4);
  finish({.abort = 0x05040000});
  return frame;
}

std::optional<WireFrame> CanopenClient::on_sdo(const Bytes& data) {
  if (step_ == Step::kIdle) {
    expect(false, "an SDO answer that nobody asked for");
    return std::nullopt;
  }
  if (step_ != Step::kReadSegment && step_ != Step::kWriteSegment) {
    const bool same = data[1] == (index_ & 0xFF) && data[2] == index_ >> 8 && data[3] == sub_;
    expect(same, "an SDO answer names the object of its request");
  }
  if (data[0] == 0x80) {
    finish({.abort = static_cast<std::uint32_t>(unsigned_of({data.begin() + 4, data.end()}))});
    return std::nullopt;
  }
  switch (step_) {
    case Step::kIdle:
      return std::nullopt;
    case Step::kInitiateRead:
      return on_read_initiated(data);
    case Step::kReadSegment:
      return on_read_segment(data);
    case Step::kInitiateWrite:
      expect(data[0] == 0x60, "a download is answered by 60h");
      expect(unsigned_of({data.begin() + 4, data.end()}) == 0, "reserved bytes are 0");
      break;
    case Step::kWriteSegment:
      expect(data[0] == (0x20 | toggle_), "a segment is answered by 20h with its toggle");
      toggle_ ^= 0x10;
      break;
  }
  if (offset_ < bytes_.size()) return next_write_segment();
  finish({});
  return std::nullopt;
}

std::optional<WireFrame> CanopenClient::on_read_initiated(const Bytes& data) {
  expect((data[0] & 0xF0) == 0x40, "an upload is answered by 4xh");
  const bool expedited = (data[0] & 0x02) != 0;
  const bool sized = (data[0] & 0x01) != 0;
  if (expedited) {
    const std::size_t length = sized ? 4U - (data[0] >> 2 & 3U) : 4U;
    finish({.bytes = {data.begin() + 4, data.begin() + 4 + static_cast<std::ptrdiff_t>(length)}});
    return std::nullopt;
  }
  announced_.reset();
  if (sized) announced_ = static_cast<std::uint32_t>(unsigned_of({data.begin() + 4, data.end()}));
  toggle_ = 0;
  step_ = Step::kReadSegment;
  return WireFrame{0x600U + node_, {0x60, 0, 0, 0, 0, 0, 0, 0}};
}

std::optional<WireFrame> CanopenClient::on_read_segment(const Bytes& data) {
  expect((data[0] & 0xE0) == 0x00, "an upload segment is answered by 0xh");
  expect((data[0] & 0x10) == toggle_, "a segment carries the toggle of its request");
  const std::size_t length = 7U - (data[0] >> 1 & 7U);
  bytes_.insert(bytes_.end(), data.begin() + 1,
                data.begin() + 1 + static_cast<std::ptrdiff_t>(length));
  if ((data[0] & 0x01) != 0) {
    expect(!announced_ || *announced_ == bytes_.size(), "an upload has the size that it told");
    finish({.bytes = bytes_, .segmented = true});
    return std::nullopt;
  }
  toggle_ ^= 0x10;
  return WireFrame{0x600U + node_,
                   {static_cast<std::uint8_t>(0x60 | toggle_), 0, 0, 0, 0, 0, 0, 0}};
}

WireFrame CanopenClient::next_write_segment() {
  step_ = Step::kWriteSegment;
  const std::size_t length = std::min<std::size_t>(7, bytes_.size() - offset_);
  WireFrame frame{0x600U + node_, Bytes(8, 0)};
  std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset_), length,
              frame.data.begin() + 1);
  offset_ += length;
  // 000 t nnn c: toggle, bytes of seven without data, the last one.
  const bool last = offset_ == bytes_.size();
  frame.data[0] = static_cast<std::uint8_t>(toggle_ | (7 - length) << 1 | (last ? 1 : 0));
  return frame;
}

void CanopenClient::finish(const Answer& answer) {
  answer_ = answer;
  step_ = Step::kIdle;
}

void CanopenClient::expect(bool good, const std::string& complaint) {
  if (!good) complaints.push_back(complaint);
}

}  // namespace tenon::tests
