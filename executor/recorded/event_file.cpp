#include "executor/recorded/event_file.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <span>
#include <system_error>
#include <utility>

#include "lcmtypes/received/received.h"
#include "shared/base/bytes.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/system/regular_file.h"

namespace tenon::executor {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kHeading_bytes = 28;
constexpr std::size_t kTimeAt = 12;
constexpr std::size_t kNameSizeAt = 20;
constexpr std::size_t kDataSizeAt = 24;
constexpr std::uint32_t kNameMax_bytes = 255;

}  // namespace

EventFile::EventFile(std::filesystem::path file) : file_(std::move(file)) {
  if (is_other_than_a_file(file_)) {
    throw InputError(file_.string() + ": cannot be read: " + kNoRegularFile);
  }
  stream_.open(file_, std::ios::binary);
  std::error_code failed;
  size_ = std::filesystem::file_size(file_, failed);
  if (!stream_ || failed) {
    const std::string why = failed ? failed.message() : std::string(std::strerror(errno));
    throw InputError(file_.string() + ": cannot be read: " + why);
  }
  std::array<char, sizeof kSync> first{};
  stream_.read(first.data(), first.size());
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(first.data());
  if (!stream_ || load_be<std::uint32_t>({bytes, first.size()}) != kSync) {
    throw InputError(file_.string() +
                     ": is no LCM log; give the file that tenon-exec wrote with --log");
  }
  stream_.seekg(0);
}

void EventFile::skip(std::uint64_t size_bytes) {
  at_ += size_bytes;
  stream_.seekg(static_cast<std::streamoff>(at_));
}

EventFile::Heading EventFile::heading() {
  std::array<char, kHeading_bytes> read{};
  stream_.read(read.data(), read.size());
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(read.data()),
                                            read.size());
  const Heading heading{load_be<std::int64_t>(bytes.subspan(kTimeAt)),
                        load_be<std::uint32_t>(bytes.subspan(kNameSizeAt)),
                        load_be<std::uint32_t>(bytes.subspan(kDataSizeAt))};
  constexpr std::uint32_t kDataMax_bytes = std::numeric_limits<std::int32_t>::max();
  if (!stream_ || load_be<std::uint32_t>(bytes) != kSync || heading.name_size > kNameMax_bytes ||
      heading.data_size > kDataMax_bytes) {
    throw InputError(
        format("%s: byte %llu: no event of an LCM log begins here; the file is damaged",
               file_.c_str(), static_cast<unsigned long long>(at_)));
  }
  at_ += kHeading_bytes;
  return heading;
}

std::optional<LoggedEvent> EventFile::next() {
  if (breaks_off_ || at_ == size_) return std::nullopt;
  breaks_off_ = !left(kHeading_bytes);
  if (breaks_off_) return std::nullopt;
  const Heading sizes = heading();
  breaks_off_ = !left(std::uint64_t{sizes.name_size} + sizes.data_size);
  if (breaks_off_) return std::nullopt;
  LoggedEvent event;
  event.time_us = sizes.time_us;
  event.channel.resize(sizes.name_size);
  stream_.read(event.channel.data(), sizes.name_size);
  at_ += sizes.name_size;
  if (sizes.data_size > kMessageMax_bytes) {
    skip(sizes.data_size);
    return event;
  }
  event.message.resize(sizes.data_size);
  stream_.read(reinterpret_cast<char*>(event.message.data()), sizes.data_size);
  at_ += sizes.data_size;
  if (!stream_) throw InputError(file_.string() + ": cannot be read to its end");
  return event;
}

}  // namespace tenon::executor
