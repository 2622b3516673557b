#include "hw/bus_load/response_times.h"

#include <algorithm>
#include <cmath>

#include "hw/bus_load/bus_load.h"
#include "shared/base/error.h"
#include "shared/base/text.h"

namespace tenon::hw {
namespace {

constexpr std::uint32_t kIntermissionBits = 3;  // part of nominal_frame_bits(), after a frame's end

bool can_meet(const BusFrame& a, const BusFrame& b) {
  return a.part == b.part || a.part == CyclePart::kAnytime || b.part == CyclePart::kAnytime;
}

class Analysis {
 public:
  Analysis(const Robot& robot, std::uint8_t bus)
      : robot_(robot),
        bit_us_(1e6 / static_cast<double>(bitrate_bps(robot, bus))),
        frames_(arm_frames(robot, bus)),
        waits_us_(frames_.size(), 0.0) {}

  /// Waiting times depend on one another: they only grow from round to round, until none does.
  [[nodiscard]] std::vector<ResponseTime> run() {
    std::vector<ResponseTime> times(frames_.size());
    for (bool grew = true; grew;) {
      grew = false;
      for (std::size_t m = 0; m < frames_.size(); ++m) {
        const double least_us = least_of_queue_us(m);
        const double queueing_us = queueing(m);
        grew = grew || queueing_us > waits_us_[m];
        waits_us_[m] = std::max(waits_us_[m], queueing_us);
        const double intermission_us = kIntermissionBits * bit_us_;
        times[m] = {frames_[m], nominal_us(m) - intermission_us,
                    waits_us_[m] + least_us - intermission_us};
      }
    }
    return times;
  }

  [[nodiscard]] double nominal_us(std::size_t m) const {
    return nominal_frame_bits(frames_[m].data_bytes) * bit_us_;
  }
  [[nodiscard]] double longest_us(std::size_t m) const {
    return worst_frame_bits(frames_[m].data_bytes) * bit_us_;
  }

 private:
  [[nodiscard]] bool same_queue(std::size_t m, std::size_t k) const {
    return frames_[k].node == frames_[m].node && can_meet(frames_[m], frames_[k]);
  }

  [[nodiscard]] double least_of_queue_us(std::size_t m) const {
    double least_us = longest_us(m);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (same_queue(m, k)) least_us = std::min(least_us, longest_us(k));
    }
    return least_us;
  }

  /// w of the header.
  [[nodiscard]] double queueing(std::size_t m) const {
    std::uint32_t least_urgent = 0;
    double queue_us = 0.0;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (!same_queue(m, k)) continue;
      least_urgent = std::max(least_urgent, frames_[k].id);
      queue_us += longest_us(k);
    }
    double blocking_us = 0.0;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (frames_[k].id > least_urgent && can_meet(frames_[m], frames_[k])) {
        blocking_us = std::max(blocking_us, longest_us(k));
      }
    }
    const double fixed_us = blocking_us + queue_us - least_of_queue_us(m);
    double queueing_us = fixed_us;
    while (true) {
      const double next_us = fixed_us + interference(m, least_urgent, queueing_us);
      if (next_us <= queueing_us) return queueing_us;
      queueing_us = next_us;
      if (queueing_us > kHopeless * robot_.cycle_us) refuse();
    }
  }

  [[nodiscard]] double interference(std::size_t m, std::uint32_t least_urgent,
                                    double queueing_us) const {
    double sum_us = 0.0;
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      if (frames_[k].id >= least_urgent || same_queue(m, k) || !can_meet(frames_[m], frames_[k])) {
        continue;
      }
      sum_us += instances(m, k, queueing_us + waits_us_[k] + bit_us_) * longest_us(k);
    }
    return sum_us;
  }

  /// How often frame k may come in the way of frame m in so much time.
  [[nodiscard]] double instances(std::size_t m, std::size_t k, double window_us) const {
    const BusFrame& frame = frames_[k];
    if (frame.part == frames_[m].part && frame.part != CyclePart::kAnytime) return 1.0;
    const double periodic = std::ceil(window_us / frame.period_us);
    return frame.in_a_row == 0 ? periodic : std::min<double>(periodic, frame.in_a_row);
  }

  [[noreturn]] void refuse() const {
    throw InputError("robot '" + robot_.name +
                     "': its frames have no bounded response time; take a longer cycle_us");
  }

  static constexpr double kHopeless = 100.0;

  const Robot& robot_;
  double bit_us_;
  std::vector<BusFrame> frames_;
  std::vector<double> waits_us_;  ///< f of the header, so far
};

}  // namespace

ResponseTimes response_times(const Robot& robot, std::uint8_t bus) {
  Analysis analysis(robot, bus);
  ResponseTimes times;
  times.cycle_us = robot.cycle_us;
  times.frames = analysis.run();
  double sync_worst_us = 0.0;
  for (std::size_t i = 0; i < times.frames.size(); ++i) {
    const ResponseTime& time = times.frames[i];
    switch (time.frame.part) {
      case CyclePart::kSync:
        times.feedback_nominal_us += analysis.nominal_us(i);
        sync_worst_us = time.worst_us;
        break;
      case CyclePart::kFeedback:
        times.feedback_nominal_us += analysis.nominal_us(i);
        times.feedback_worst_us = std::max(times.feedback_worst_us, sync_worst_us + time.worst_us);
        break;
      case CyclePart::kCommand:
        if (time.frame.every_cycle) times.command_nominal_us += analysis.nominal_us(i);
        times.command_worst_us = std::max(times.command_worst_us, time.worst_us);
        break;
      case CyclePart::kAnytime:
        break;
    }
  }
  return times;
}

void check_response_times(const Robot& robot) {
  for (const std::uint8_t bus : buses_of(robot)) {
    const ResponseTimes times = response_times(robot, bus);
    if (times.leaves_room()) continue;
    throw InputError(
        "robot '" + robot.name +
        "': " + (robot.sensor.has_own_bus() ? bus_title(robot, bus) + ": " : "") +
        format("the last feedback comes up to %.0f us after SYNC, and the next SYNC follows after "
               "%.0f us; take a longer cycle_us or fewer bytes",
               times.feedback_worst_us, times.cycle_us));
  }
}

std::string describe(const ResponseTimes& times) {
  std::string text = "COB-ID  frame                        bytes   nominal     worst  us\n";
  for (const ResponseTime& time : times.frames) {
    text += format("  %03X   %-28s %5u %9.0f %9.0f\n", time.frame.id, time.frame.name.c_str(),
                   time.frame.data_bytes, time.nominal_us, time.worst_us);
  }
  return text + format(
                    "SYNC to last feedback %.0f us nominal, %.0f worst; setpoints %.0f and %.0f; "
                    "of a cycle of %.0f us remain at least %.0f\n",
                    times.feedback_nominal_us, times.feedback_worst_us, times.command_nominal_us,
                    times.command_worst_us, times.cycle_us, times.room_us());
}

}  // namespace tenon::hw
