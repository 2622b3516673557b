#include "shared/system/record_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "shared/base/error.h"
#include "shared/system/regular_file.h"

namespace tenon {
namespace {

constexpr std::size_t kFlush_bytes = 4096;

std::FILE* opened(const std::filesystem::path& file) {
  if (is_other_than_a_file(file)) {
    throw InputError(file.string() + ": cannot be written: " + kNoRegularFile);
  }
  std::FILE* stream = std::fopen(file.c_str(), "we");
  if (stream == nullptr) {
    throw InputError(file.string() + ": cannot be written: " + std::strerror(errno));
  }
  // What the system did not take must not be taken for written.
  (void)std::setvbuf(stream, nullptr, _IONBF, 0);
  return stream;
}

}  // namespace

void RecordReport::lose(std::uint64_t records, const std::string& why) {
  lost += records;
  if (reason.empty()) reason = why;
}

std::string loss_text(const RecordReport& report) {
  std::string option = report.name;
  std::replace(option.begin(), option.end(), '_', '-');
  return "--" + option + " " + report.file + ": " + std::to_string(report.lost) + " of " +
         std::to_string(report.written + report.lost) + " records lost (" + report.reason + ")";
}

RecordFile::RecordFile(std::string name, const std::filesystem::path& file)
    : stream_(opened(file)) {
  report_.name = std::move(name);
  report_.file = file.string();
}

void RecordFile::add(std::string_view bytes, std::uint64_t records) {
  if (stream_ == nullptr || !report_.whole()) return report_.lose(records, "the file is closed");
  buffer_ += bytes;
  pending_.push_back({buffer_.size(), records});
  if (buffer_.size() >= kFlush_bytes) flush();
}

void RecordFile::flush() {
  if (stream_ == nullptr || buffer_.empty()) return;
  std::size_t taken = 0;
  int error = 0;
  while (taken < buffer_.size() && error == 0) {
    errno = 0;
    const std::size_t left = buffer_.size() - taken;
    const std::size_t now = std::fwrite(buffer_.data() + taken, 1, left, stream_);
    taken += now;
    if (now < left && errno != EINTR) error = errno != 0 ? errno : EIO;
  }
  for (const Pending& record : pending_) {
    if (record.end <= taken) {
      report_.written += record.records;
    } else {
      report_.lose(record.records, std::strerror(error));
    }
  }
  buffer_.clear();
  pending_.clear();
}

void RecordFile::close() {
  flush();
  if (stream_ == nullptr) return;
  // A network's disk may refuse only now, and does not say what of it.
  if (std::fclose(std::exchange(stream_, nullptr)) != 0) {
    const int error = errno;
    report_.lose(std::exchange(report_.written, 0), std::strerror(error));
  }
}

}  // namespace tenon
