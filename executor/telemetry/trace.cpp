#include "executor/telemetry/trace.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "shared/base/error.h"
#include "shared/system/regular_file.h"

namespace tenon::executor {
namespace {

constexpr const char* kFirstLine = "tenon-trace 2";

void write_double(std::ostream& out, double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::hex);
  out << ' ';
  out.write(text.data(), end.ptr - text.data());
}

template <typename Values>
void write_doubles(std::ostream& out, const Values& values) {
  for (const double value : values) write_double(out, value);
}

// In the order of the trace.
std::array<double*, 8> values_of(SpeedLimits& v) {
  return {&v.approach_mps,   &v.contact_mps,   &v.acceleration_mps2,   &v.jerk_mps3,
          &v.approach_radps, &v.contact_radps, &v.acceleration_radps2, &v.jerk_radps3};
}

void write_move(std::ostream& out, const CycleRecord& record, const Plan& plan) {
  MoveParameters move = tenon::move_parameters(plan, static_cast<std::size_t>(record.step));
  out << "m " << record.step << ' ' << record.signature_before << ' ' << move.timeout_us;
  for (const double* value : values_of(move.speeds)) write_double(out, *value);
  out << '\n';
}

void write_input(std::ostream& out, const CycleRecord& record) {
  out << "i " << record.move_ns;
  write_doubles(out, record.pose.position_m);
  write_doubles(out, record.pose.orientation_wxyz);
  write_doubles(out, record.wrench);
  out << ' ' << (record.wrench_fresh ? 1 : 0);
  write_doubles(out, record.setpoint.position_m);
  write_doubles(out, record.setpoint.orientation_wxyz);
  out << '\n';
}

// The words of one line, each read as what is asked for.
class Words {
 public:
  Words(const std::string& line, std::string where) : stream_(line), where_(std::move(where)) {}

  std::string word() {
    std::string text;
    if (!(stream_ >> text)) throw InputError(where_ + ": the line is too short");
    return text;
  }
  template <typename Number>
  Number number() {
    const std::string text = word();
    Number value{};
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    return checked(value, text, end);
  }
  double real() {
    const std::string text = word();
    double value = 0.0;
    const auto end =
        std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::hex);
    if (!std::isfinite(value)) throw InputError(where_ + ": '" + text + "' is not finite");
    return checked(value, text, end);
  }
  Pose pose() {
    PoseData data;
    for (double& value : data.position_m) value = real();
    for (double& value : data.orientation_wxyz) value = real();
    return pose_of(data);
  }

 private:
  template <typename Number>
  Number checked(Number value, const std::string& text, std::from_chars_result end) const {
    if (end.ec != std::errc() || end.ptr != text.data() + text.size()) {
      throw InputError(where_ + ": '" + text + "' is not a number");
    }
    return value;
  }
  std::istringstream stream_;
  std::string where_;
};

TracedMove read_move(Words& words) {
  TracedMove move;
  move.step = words.number<std::size_t>();
  move.signature_before.bits = words.number<std::uint16_t>();
  move.timeout_us = words.number<std::uint32_t>();
  for (double* value : values_of(move.speeds)) *value = words.real();
  return move;
}

TracedInput read_input(Words& words) {
  TracedInput traced;
  traced.input.time_ns = words.number<std::int64_t>();
  traced.input.pose = words.pose();
  for (int axis = 0; axis < 6; ++axis) traced.input.wrench[axis] = words.real();
  traced.input.wrench_fresh = words.number<int>() != 0;
  traced.setpoint = words.pose();
  return traced;
}

void read_result(Words& words, const std::string& where, std::vector<TracedMove>& moves) {
  const auto step = words.number<std::size_t>();
  for (TracedMove& move : moves) {
    if (move.step != step) continue;
    move.complete = true;
    const auto outcome = words.number<std::size_t>();
    if (outcome >= kOutcomes.size()) {
      throw InputError(where + ": outcome " + std::to_string(outcome) + ", must be in [0, " +
                       std::to_string(kOutcomes.size() - 1) + "]");
    }
    move.outcome = kOutcomes.at(outcome);
    move.signature.bits = words.number<std::uint16_t>();
    move.decided_ns = words.number<std::int64_t>();
    move.duration_ns = words.number<std::int64_t>();
    return;
  }
  throw InputError(where + ": the result of a move that never began");
}

}  // namespace

TraceWriter::TraceWriter(const std::filesystem::path& file, const PlanRunner& runner)
    : file_("trace", file), runner_(runner) {
  file_.add(std::string(kFirstLine) + '\n', 0);
}

void TraceWriter::consume(const CycleRecord& record) {
  if (last_sequence_ && record.sequence != *last_sequence_ + 1) file_.add("g\n", 0);
  last_sequence_ = record.sequence;
  if (record.moving) {
    std::ostringstream out;
    if (record.move_started) write_move(out, record, runner_.plan());
    write_input(out, record);
    file_.add(out.str());
  }
  for (; steps_written_ < record.steps_done; ++steps_written_) {
    const StepReport& report = runner_.report(steps_written_);
    std::ostringstream out;
    out << "r " << report.step << ' ' << static_cast<int>(report.result.outcome) << ' '
        << report.result.signature.bits << ' ' << report.result.decided_ns << ' '
        << report.result.duration_ns << '\n';
    file_.add(out.str());
    file_.flush();
  }
}

MoveParameters move_parameters(const Plan& plan, const TracedMove& traced) {
  MoveParameters move = tenon::move_parameters(plan, traced.step);
  move.speeds = traced.speeds;
  move.timeout_us = traced.timeout_us;
  return move;
}

std::vector<TracedMove> read_trace(const std::filesystem::path& file) {
  if (is_other_than_a_file(file)) {
    throw InputError(file.string() + ": cannot be read: " + kNoRegularFile);
  }
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read");
  std::string line;
  if (!std::getline(in, line) || line != kFirstLine) {
    throw InputError(file.string() + ":1: does not begin with '" + kFirstLine + "'");
  }
  std::vector<TracedMove> moves;
  for (int number = 2; std::getline(in, line); ++number) {
    const std::string where = file.string() + ":" + std::to_string(number);
    Words words(line, where);
    const std::string kind = words.word();
    if (kind == "m") {
      TracedMove move = read_move(words);
      if (!moves.empty() && !moves.back().inputs.empty()) {
        move.held = moves.back().inputs.back().setpoint;
      }
      moves.push_back(std::move(move));
    } else if (kind == "i" && !moves.empty()) {
      moves.back().inputs.push_back(read_input(words));
    } else if (kind == "r") {
      read_result(words, where, moves);
    } else if (kind == "g") {
      throw InputError(where + ": records were lost here, the trace cannot be replayed");
    } else {
      throw InputError(std::string(where).append(": not a line of a trace: '") + kind + "'");
    }
  }
  return moves;
}

}  // namespace tenon::executor
