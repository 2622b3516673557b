#include "sim/cell/canopen/sdo_server.h"

#include <algorithm>

#include "shared/canopen/constants.h"

namespace tenon::sim {
namespace {

constexpr std::uint8_t kToggle = 0x10;
constexpr std::uint8_t kSegmentBytes = 7;

std::uint32_t load_u32(const SdoServer::Message& message, std::size_t at) {
  return static_cast<std::uint32_t>(message[at]) |
         static_cast<std::uint32_t>(message[at + 1]) << 8 |
         static_cast<std::uint32_t>(message[at + 2]) << 16 |
         static_cast<std::uint32_t>(message[at + 3]) << 24;
}

void store_u32(SdoServer::Message& message, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) message[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

}  // namespace

std::size_t SdoServer::size_max(const ObjectEntry& entry) {
  return entry.type == DataType::kText ? entry.text_bytes_max : size_bytes(entry.type);
}

std::optional<SdoServer::Message> SdoServer::answer(const Message& request) {
  switch (request[0] >> 5) {
    case 0:
      return download_segment(request);
    case 1:
      return initiate_download(request);
    case 2:
      id_ = object_id(static_cast<std::uint16_t>(request[1] | request[2] << 8), request[3]);
      return initiate_upload();
    case 3:
      return upload_segment(request);
    case 4:
      transfer_ = Transfer::kNone;
      return std::nullopt;
    default:  // block transfers and the unassigned service
      id_ = object_id(static_cast<std::uint16_t>(request[1] | request[2] << 8), request[3]);
      return abort(canopen::kAbortCommand);
  }
}

SdoServer::Message SdoServer::initiate_download(const Message& request) {
  id_ = object_id(static_cast<std::uint16_t>(request[1] | request[2] << 8), request[3]);
  const bool expedited = (request[0] & 0x02) != 0;
  const bool sized = (request[0] & 0x01) != 0;
  const ObjectEntry* entry = dictionary_.find(id_);
  if (entry == nullptr) return abort(dictionary_.why_missing(id_));
  if (entry->access == Access::kReadOnly) return abort(canopen::kAbortReadOnly);

  if (expedited) {
    const std::size_t own = std::min<std::size_t>(size_max(*entry), 4);
    const std::size_t length = sized ? 4U - (request[0] >> 2 & 3U) : own;
    const std::uint32_t refusal =
        store({request.begin() + 4, request.begin() + 4 + static_cast<std::ptrdiff_t>(length)});
    return refusal != 0 ? abort(refusal) : reply(0x60);
  }
  announced_.reset();
  if (sized) announced_ = load_u32(request, 4);
  if (announced_ && *announced_ > size_max(*entry)) return abort(canopen::kAbortLengthHigh);
  if (announced_ && *announced_ < size_bytes(entry->type)) return abort(canopen::kAbortLengthLow);
  transfer_ = Transfer::kDownload;
  toggle_ = 0;
  bytes_.clear();
  return reply(0x60);
}

SdoServer::Message SdoServer::download_segment(const Message& request) {
  if (transfer_ != Transfer::kDownload) return abort_stray();
  if ((request[0] & kToggle) != toggle_) return abort(canopen::kAbortToggle);
  const std::size_t length = kSegmentBytes - (request[0] >> 1 & 7U);
  bytes_.insert(bytes_.end(), request.begin() + 1,
                request.begin() + 1 + static_cast<std::ptrdiff_t>(length));
  if (bytes_.size() > size_max(*dictionary_.find(id_))) return abort(canopen::kAbortLengthHigh);
  const std::uint8_t answered = static_cast<std::uint8_t>(0x20 | toggle_);
  toggle_ ^= kToggle;
  if ((request[0] & 0x01) != 0) {
    if (announced_ && *announced_ != bytes_.size()) return abort(canopen::kAbortLength);
    if (const std::uint32_t refusal = store(bytes_); refusal != 0) return abort(refusal);
    transfer_ = Transfer::kNone;
  }
  return Message{answered};
}

SdoServer::Message SdoServer::initiate_upload() {
  const ObjectEntry* entry = dictionary_.find(id_);
  if (entry == nullptr) return abort(dictionary_.why_missing(id_));
  if (entry->access == Access::kWriteOnly) return abort(canopen::kAbortWriteOnly);
  if (entry->on_read) {
    if (const std::uint32_t refusal = entry->on_read(); refusal != 0) return abort(refusal);
  }
  bytes_ = to_bytes(*entry);
  const std::size_t size = bytes_.size();
  if (size >= 1 && size <= 4) {
    transfer_ = Transfer::kNone;
    Message message = reply(static_cast<std::uint8_t>(0x43 | (4 - size) << 2));
    std::copy(bytes_.begin(), bytes_.end(), message.begin() + 4);
    return message;
  }
  transfer_ = Transfer::kUpload;
  toggle_ = 0;
  offset_ = 0;
  Message message = reply(0x41);
  store_u32(message, 4, static_cast<std::uint32_t>(size));
  return message;
}

SdoServer::Message SdoServer::upload_segment(const Message& request) {
  if (transfer_ != Transfer::kUpload) return abort_stray();
  if ((request[0] & kToggle) != toggle_) return abort(canopen::kAbortToggle);
  const std::size_t length = std::min<std::size_t>(kSegmentBytes, bytes_.size() - offset_);
  const bool last = offset_ + length == bytes_.size();
  Message message{
      static_cast<std::uint8_t>(toggle_ | (kSegmentBytes - length) << 1 | (last ? 1U : 0U))};
  std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset_), length, message.begin() + 1);
  offset_ += length;
  toggle_ ^= kToggle;
  if (last) transfer_ = Transfer::kNone;
  return message;
}

std::uint32_t SdoServer::store(const std::vector<std::uint8_t>& bytes) {
  const ObjectEntry* entry = dictionary_.find(id_);
  if (bytes.size() > size_max(*entry)) return canopen::kAbortLengthHigh;
  if (bytes.size() < size_bytes(entry->type)) return canopen::kAbortLengthLow;
  if (entry->type == DataType::kText)
    return dictionary_.write_text(id_, {bytes.begin(), bytes.end()});
  return dictionary_.write(id_, from_bytes(entry->type, bytes.data()));
}

SdoServer::Message SdoServer::abort_stray() {
  if (transfer_ == Transfer::kNone) id_ = 0;
  return abort(canopen::kAbortCommand);
}

SdoServer::Message SdoServer::abort(std::uint32_t code) {
  transfer_ = Transfer::kNone;
  Message message = reply(0x80);
  store_u32(message, 4, code);
  return message;
}

SdoServer::Message SdoServer::reply(std::uint8_t command) const {
  return {command, static_cast<std::uint8_t>(id_ >> 8), static_cast<std::uint8_t>(id_ >> 16),
          static_cast<std::uint8_t>(id_)};
}

}  // namespace tenon::sim
