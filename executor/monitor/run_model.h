#pragma once
// What is known of a run by the messages that came: the last of each kind with the time of its
// coming, and what follows from how they went on. Whatever arrives, it takes what it can and counts
// the rest. Pure but for allocation; time is an argument. Not for real time; one thread.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_setup_t.hpp"
#include "lcmtypes/tenon/run_status_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"
#include "shared/math/pose.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

/// A message, and when it came, monotonic.
template <typename Message>
struct Received {
  Message message{};
  std::int64_t at_ns = 0;
};

/// The guarded move under way.
struct MoveSeen {
  int step = -1;       ///< the last one, where none runs any more
  bool whole = false;  ///< seen from its first cycle; else way and time are not known
  Pose start;
  double elapsed_s = 0.0;  ///< by its own clock, which a pause stops
};

/// The largest of the last ten seconds.
class RecentWorst {
 public:
  void add(std::int64_t time_ns, double value);
  [[nodiscard]] double value() const;

 private:
  static constexpr std::size_t kSeconds = 10;
  std::array<double, kSeconds> worst_{};
  std::int64_t second_ = -1;
};

struct RunModel {
  /// @param now_ns monotonic
  void take(std::string_view channel, std::span<const std::uint8_t> bytes, std::int64_t now_ns);

  /// Seconds since a message came; meaningful where there is one.
  template <typename Message>
  [[nodiscard]] static double age_s(const Received<Message>& received, std::int64_t now_ns) {
    return 1e-9 * static_cast<double>(now_ns - received.at_ns);
  }

  std::optional<Received<tenon::run_setup_t>> setup;
  std::optional<Received<tenon::run_status_t>> status;
  std::optional<Received<tenon::cycle_state_t>> cycle;
  std::optional<Received<tenon::run_summary_t>> summary;
  std::deque<tenon::step_event_t> steps;  ///< the last finished, the newest first

  MoveSeen move;
  double wrench_age_s = 0.0;                        ///< of the last new sample, by cycles
  std::array<double, kMaxJoints> joint_silent_s{};  ///< since its last answer, by cycles
  RecentWorst wakeup_late_s;
  RecentWorst compute_s;
  std::uint64_t malformed = 0;  ///< what no decoder could make sense of; never forgotten

 private:
  template <typename Message>
  [[nodiscard]] std::optional<Message> received(std::span<const std::uint8_t> bytes);
  void forget_run();
  void take(const tenon::cycle_state_t& message, std::int64_t now_ns);
  void follow_move(const tenon::cycle_state_t& message, double since_s);
};

/// "none", "-x +z" of a message's contact bits.
[[nodiscard]] std::string signature_text(std::int16_t bits);

/// By what the setup says, else its number.
[[nodiscard]] std::string joint_name(const RunModel& model, int joint);

/// The tool's pose in a cycle.
[[nodiscard]] Pose pose_of(const tenon::cycle_state_t& message);

/// How far a tool has come along a step's displacement, m, rad where the step only turns; signed.
/// @param displacement six values
[[nodiscard]] double way_along(std::span<const double> displacement, const Pose& start,
                               const Pose& pose);

}  // namespace tenon::executor
