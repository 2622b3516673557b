#include "executor/monitor/recording.h"

#include <system_error>

#include "shared/base/error.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

std::filesystem::path unfinished(const std::filesystem::path& file) {
  return file.string() + ".part";
}

std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stamp) {
  const auto taken = [](const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::exists(std::filesystem::symlink_status(file, ignored)) ||
           std::filesystem::exists(std::filesystem::symlink_status(unfinished(file), ignored));
  };
  std::filesystem::path file = folder / ("tenon-" + stamp + ".lcmlog");
  for (int i = 2; taken(file); ++i) file = folder / format("tenon-%s-%d.lcmlog", stamp.c_str(), i);
  return file;
}

}  // namespace

Recording::Said Recording::begin(const std::string& stamp) {
  if (log_) return {};
  try {
    std::error_code failed;
    file_ = free_name(std::filesystem::absolute(folder_, failed), stamp).lexically_normal();
    messages_ = 0;
    log_.emplace(unfinished(file_));
  } catch (const InputError& error) {
    return {std::string("not recorded: ") + error.what(), true};
  }
  return {};
}

Recording::Said Recording::add(std::int64_t time_us, std::string_view channel,
                               std::span<const std::uint8_t> message) {
  if (!log_) return {};
  log_->add(time_us, channel, message);
  ++messages_;
  return log_->report().whole() ? Said{} : end();
}

Recording::Said Recording::end() {
  if (!log_) return {};
  log_->close();
  const RecordReport report = log_->report();
  log_.reset();
  std::error_code failed;
  std::filesystem::rename(unfinished(file_), file_, failed);
  const std::string where =
      failed ? unfinished(file_).string() + " (" + failed.message() + ")" : file_.string();
  if (report.whole()) {
    return {
        format("recorded %llu messages: ", static_cast<unsigned long long>(report.written)) + where,
        static_cast<bool>(failed)};
  }
  return {format("RECORDING ENDED: %s; %llu of %llu messages are in ", report.reason.c_str(),
                 static_cast<unsigned long long>(report.written),
                 static_cast<unsigned long long>(report.written + report.lost)) +
              where,
          true};
}

}  // namespace tenon::executor
