#pragma once
// A recording that a key begins and ends: an LCM log with another name until it is whole. A full
// disk ends it, and keeps what is there. Allocates and blocks; one thread.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "executor/telemetry/event_log.h"

namespace tenon::executor {

class Recording {
 public:
  /// What became of one, for people.
  struct Said {
    std::string text;
    bool bad = false;
  };

  /// @param folder of the logs
  explicit Recording(std::filesystem::path folder) : folder_(std::move(folder)) {}
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  /// Ends it.
  ~Recording() { (void)end(); }

  /// Begins FOLDER/tenon-STAMP.lcmlog as FOLDER/tenon-STAMP.lcmlog.part; no file is written over.
  /// @param stamp such as 20250131-235959  @return empty, or why not
  [[nodiscard]] Said begin(const std::string& stamp);
  /// Of a message that came. @return empty, or that the disk took no more, whereupon it is over
  [[nodiscard]] Said add(std::int64_t time_us, std::string_view channel,
                         std::span<const std::uint8_t> message);
  /// Gives the file its name. @return where it is, empty where there was none
  [[nodiscard]] Said end();

  [[nodiscard]] bool on() const { return log_.has_value(); }
  /// That it will have; empty where none is on.
  [[nodiscard]] std::string file() const { return log_ ? file_.string() : ""; }
  [[nodiscard]] std::uint64_t messages() const { return messages_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;
  std::optional<EventLog> log_;
  std::uint64_t messages_ = 0;
};

}  // namespace tenon::executor
