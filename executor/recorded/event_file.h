#pragma once
// The events of an LCM log, one after the other; telemetry/event_log.h has the format. Whatever is
// in the file, it is read to where it makes sense. Offline; one thread.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tenon::executor {

struct LoggedEvent {
  std::int64_t time_us = 0;  ///< when it was logged, since 1970
  std::string channel;
  std::vector<std::uint8_t> message;  ///< empty where it is longer than any of Tenon's
};

class EventFile {
 public:
  /// @throws InputError where the file cannot be read, or does not begin as a log does
  explicit EventFile(std::filesystem::path file);

  /// @return the next event; none at the end of the file
  /// @throws InputError where something else than an event begins
  [[nodiscard]] std::optional<LoggedEvent> next();
  /// Whether the file ends within an event, which next() has then not returned.
  [[nodiscard]] bool breaks_off() const { return breaks_off_; }

 private:
  struct Heading {
    std::int64_t time_us;
    std::uint32_t name_size;
    std::uint32_t data_size;
  };
  [[nodiscard]] Heading heading();
  [[nodiscard]] bool left(std::uint64_t size_bytes) const { return size_bytes <= size_ - at_; }
  void skip(std::uint64_t size_bytes);

  std::filesystem::path file_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t at_ = 0;
  bool breaks_off_ = false;
};

}  // namespace tenon::executor
