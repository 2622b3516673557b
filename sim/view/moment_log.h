#pragma once
// What viewers are sent: events as text/event-stream has them, the newest few kept, and the path of
// the part so far for who comes late. One thread adds and ends; any number of others take. A viewer
// that takes too slowly loses events, which are counted; it is waited for by nobody.

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "shared/math/pose.h"

namespace tenon::sim {

/// "event: NAME", where there is a name, and its data, of one line.
[[nodiscard]] std::string stream_event(const char* name, const std::string& data);

class MomentLog {
 public:
  static constexpr std::size_t kKept = 16;
  static constexpr std::size_t kPathMax = 4000;

  /// @param run_id tells viewers whether it is still the run that they know
  explicit MomentLog(std::string run_id) : run_id_(std::move(run_id)) {}

  struct Counts {
    std::uint64_t viewers = 0;  ///< that there have been
    std::uint64_t taken = 0;    ///< events, all viewers together
    std::uint64_t dropped = 0;  ///< events that viewers were too slow for
  };

  /// A moment as JSON, and where the part was in it.
  void add(const std::string& json, const Vector3& position_m);
  /// The last event. Whoever waits gets it, and then the end.
  void end(const std::string& json);

  /// Of one viewer, who owns it.
  struct Viewer {
    std::uint64_t next = 0;
    bool greeted = false;
  };
  void join();
  void leave();
  [[nodiscard]] std::size_t present() const;
  /// Waits for what the viewer has not had; the first is the path so far. False at the end.
  [[nodiscard]] bool take(Viewer& viewer, std::string& text);
  /// Until nobody is present, or the time is over.
  void wait_for_empty(std::int64_t at_most_ns);
  [[nodiscard]] Counts counts() const;

 private:
  void append(std::string event);
  void remember(const Vector3& position_m);
  [[nodiscard]] std::string greeting() const;

  std::string run_id_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::array<std::string, kKept> events_;
  std::uint64_t added_ = 0;
  std::vector<Vector3> path_m_;
  bool ended_ = false;
  std::size_t present_ = 0;
  Counts counts_;
};

}  // namespace tenon::sim
