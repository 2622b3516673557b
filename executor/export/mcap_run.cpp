#include "executor/export/mcap_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "executor/recorded/known.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
// Of a 3D view; the cycles' own channel has every pose.
constexpr std::int64_t kFramePeriod_ns = 20'000'000;
constexpr std::int64_t kThousand = 1000;

// The parts of Foxglove's schemas (docs.foxglove.dev) that readers know by their names.
constexpr const char* kTimestamp =
    R"("timestamp":{"type":"object","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}})";
constexpr const char* kLogRest =
    R"("level":{"oneOf":[{"title":"UNKNOWN","const":0},{"title":"DEBUG","const":1},)"
    R"({"title":"INFO","const":2},{"title":"WARNING","const":3},{"title":"ERROR","const":4},)"
    R"({"title":"FATAL","const":5}]},"message":{"type":"string"},"name":{"type":"string"},)"
    R"("file":{"type":"string"},"line":{"type":"integer"})";
constexpr const char* kFrameRest =
    R"("parent_frame_id":{"type":"string"},"child_frame_id":{"type":"string"},)"
    R"("translation":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},)"
    R"("z":{"type":"number"}}},"rotation":{"type":"object","properties":{"x":{"type":"number"},)"
    R"("y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}})";

std::string foxglove_schema(const char* name, const char* rest) {
  return std::string(R"({"title":")") + name + R"(","type":"object","properties":{)" + kTimestamp +
         "," + rest + "}}";
}

McapChannel log_channel() {
  return {"/tenon/events", "foxglove.Log", foxglove_schema("foxglove.Log", kLogRest)};
}

McapChannel frame_channel(const char* topic) {
  return {topic, "foxglove.FrameTransform", foxglove_schema("foxglove.FrameTransform", kFrameRest)};
}

std::string timestamp(std::int64_t time_ns) {
  return format(R"("timestamp":{"sec":%lld,"nsec":%lld})",
                static_cast<long long>(time_ns / kSecond_ns),
                static_cast<long long>(time_ns % kSecond_ns));
}

/// {"x":0.5,"y":0.25,"z":-1}
template <std::size_t kCount>
std::string object(const char (&names)[kCount], const double* values) {
  std::string text = "{";
  for (std::size_t i = 0; i + 1 < kCount; ++i) {
    text += (i == 0 ? "\"" : ",\"") + std::string(1, names[i]) + "\":";
    add_json(values[i], text);
  }
  return text + "}";
}

bool is_pose(const double (&position_m)[3], const double (&orientation_wxyz)[4]) {
  double sum = 0.0;
  for (const double value : position_m) sum += std::abs(value);
  for (const double value : orientation_wxyz) sum += std::abs(value);
  return std::isfinite(sum);
}

}  // namespace

template <typename Message>
McapRun::Topic<Message> McapRun::topic(const char* name, const char* type,
                                       Columns<Message> columns) {
  const std::uint16_t channel = writer_.add_channel({name, type, columns.json_schema(type)});
  return {std::move(columns), channel};
}

McapRun::McapRun(McapWriter::Sink sink, const std::string& version, const LoggedRun& run)
    : writer_(std::move(sink), "tenon " + version),
      run_(run),
      version_(version),
      cycles_(topic("/tenon/cycle", "tenon.Cycle", cycle_columns(run.joints(), run.setup))),
      steps_(topic("/tenon/step", "tenon.Step", step_columns())),
      statuses_(topic("/tenon/status", "tenon.Status", status_columns())),
      setups_(topic("/tenon/setup", "tenon.Setup", setup_columns(run.joints()))),
      summaries_(topic("/tenon/run", "tenon.Run", summary_columns())),
      events_(writer_.add_channel(log_channel())),
      tool_(writer_.add_channel(frame_channel("/tenon/frames/tool"))),
      commanded_(writer_.add_channel(frame_channel("/tenon/frames/commanded"))) {}

std::int64_t McapRun::time_ns(std::int64_t since_ns) const {
  // Of a log of anybody's, the clock may say anything.
  constexpr std::int64_t kMost_us = std::numeric_limits<std::int64_t>::max() / 2 / kThousand;
  const std::int64_t start_us = std::clamp<std::int64_t>(run_.start_us, 0, kMost_us);
  return kThousand * start_us + std::min(since_ns, kThousand * kMost_us);
}

void McapRun::take(const Timed<tenon::cycle_state_t>& told) {
  put(cycles_, told);
  if (framed_ns_ && told.since_ns - *framed_ns_ < kFramePeriod_ns) return;
  framed_ns_ = told.since_ns;
  const tenon::cycle_state_t& m = told.message;
  const auto state = static_cast<State>(m.state);
  const std::int64_t now_ns = time_ns(told.since_ns);
  if (knows_joints(state)) {
    put_frame(tool_, "tool", now_ns, m.pose_position_m, m.pose_orientation_wxyz);
  }
  if (commands(state)) {
    put_frame(commanded_, "commanded", now_ns, m.commanded_position_m,
              m.commanded_orientation_wxyz);
  }
}

void McapRun::put_frame(std::uint16_t channel, const char* name, std::int64_t now_ns,
                        const double (&position_m)[3], const double (&orientation_wxyz)[4]) {
  if (!is_pose(position_m, orientation_wxyz)) return;
  writer_.add(channel, now_ns,
              "{" + timestamp(now_ns) + R"(,"parent_frame_id":"task","child_frame_id":")" + name +
                  R"(","translation":)" + object("xyz", position_m) + R"(,"rotation":)" +
                  object("wxyz", orientation_wxyz) + "}");
}

void McapRun::take(const RunEvent& event, std::int64_t since_ns) {
  const std::int64_t now_ns = time_ns(since_ns);
  writer_.add(events_, now_ns,
              "{" + timestamp(now_ns) +
                  format(R"(,"level":%d,"message":)", int{static_cast<std::uint8_t>(event.level)}) +
                  json_text(event.text) + R"(,"name":"tenon","file":"","line":0})");
}

void McapRun::finish(const std::string& log, const std::string& notes) {
  McapWriter::Texts texts = {{"version", version_}, {"log", log}};
  if (!notes.empty()) texts["notes"] = notes;
  writer_.finish("tenon", texts);
}

}  // namespace tenon::executor
