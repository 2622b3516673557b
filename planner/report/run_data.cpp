#include "planner/report/run_data.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "planner/report/moments.h"
#include "planner/report/page_data.h"
#include "planner/report/run_path.h"
#include "shared/drawing/scene_json.h"
#include "shared/drawing/step_words.h"

namespace tenon::planner {
namespace {

using Json = nlohmann::ordered_json;

/// What is not known is null.
Json number(double value, double unit) {
  if (!std::isfinite(value)) return nullptr;
  // Integers times a power of ten would print as long as they are; this prints the shortest.
  return std::round(value / unit) / std::round(1.0 / unit);
}

constexpr double kLength = 1e-6;  // m, rad
constexpr double kForce = 1e-3;   // N, Nm
constexpr double kTime = 1e-4;    // s
constexpr double kMicro = 0.1;    // us

Json row(const std::vector<double>& values, double unit) {
  Json json = Json::array();
  for (const double value : values) json.push_back(number(value, unit));
  return json;
}

/// Of a tool along an axis: m, and rad as it has turned since the plan's start.
double coordinate(const std::array<float, 7>& tool, int axis, const Plan& plan) {
  if (axis < 3) return tool.at(static_cast<std::size_t>(axis));
  if (std::isnan(tool[3])) return tool[3];
  const Eigen::AngleAxisd turned(pose_of(tool).orientation * plan.start.orientation.conjugate());
  return turned.angle() * turned.axis()[axis - 3];
}

Json motion_json(const Plan& plan, const RecordedRun& run, const Moments& moments,
                 std::array<float, 7> RecordedCycle::*which) {
  Json rows = Json::array();
  for (int axis = 0; axis < 6; ++axis) {
    rows.push_back(row(
        moments.peaks([&](std::size_t i) { return coordinate(run.samples[i].*which, axis, plan); }),
        kLength));
  }
  return rows;
}

double norm(const std::array<float, 6>& wrench, std::size_t from) {
  return std::hypot(wrench.at(from), wrench.at(from + 1), wrench.at(from + 2));
}

Json wrench_json(const RecordedRun& run, const Moments& moments) {
  Json rows = Json::array();
  for (std::size_t axis = 0; axis < 6; ++axis) {
    rows.push_back(
        row(moments.peaks([&](std::size_t i) { return run.samples[i].wrench.at(axis); }), kForce));
  }
  for (const std::size_t from : {0U, 3U}) {
    rows.push_back(row(
        moments.peaks([&](std::size_t i) { return norm(run.samples[i].wrench, from); }), kForce));
  }
  return rows;
}

Json joints_json(const RecordedRun& run, const Moments& moments) {
  Json joints = Json::array();
  for (std::size_t j = 0; j < run.joints.size(); ++j) {
    const RecordedJoint& joint = run.joints[j];
    const auto values = [&](std::array<float, kMaxJoints> RecordedCycle::*which) {
      return row(moments.peaks([&](std::size_t i) { return (run.samples[i].*which).at(j); }),
                 kLength);
    };
    const auto off = [&](std::size_t i) {
      return double{run.samples[i].joints.at(j)} - run.samples[i].commanded_joints.at(j);
    };
    joints.push_back({{"name", joint.name},
                      {"linear", joint.linear},
                      {"lower", number(joint.lower, kLength)},
                      {"upper", number(joint.upper, kLength)},
                      {"measured", values(&RecordedCycle::joints)},
                      {"commanded", values(&RecordedCycle::commanded_joints)},
                      {"off", row(moments.peaks(off), kLength)}});
  }
  return joints;
}

/// Cycles that were skipped within each moment. A damaged log may count anything.
Json late_json(const RecordedRun& run, const Moments& moments) {
  Json late = Json::array();
  std::int64_t before = 0;
  for (const std::size_t sample : moments.samples()) {
    const std::int64_t now = run.samples[sample].late_cycles;
    late.push_back(now - before);
    before = now;
  }
  return late;
}

Json curves_json(const Plan& plan, const RecordedRun& run) {
  const Moments moments(run.samples.size(), kMomentsMax);
  Json json;
  json["samples"] = run.samples.size();
  json["times_s"] = row(moments.at([&](std::size_t i) { return run.samples[i].time_s; }), kTime);
  json["tools"] = Json::array();
  json["signatures"] = Json::array();
  for (const std::size_t i : moments.samples()) {
    const RecordedCycle& sample = run.samples[i];
    Json tool = nullptr;
    if (!std::isnan(sample.tool[0])) tool = Json::parse(drawing::pose_json(pose_of(sample.tool)));
    json["tools"].push_back(std::move(tool));
    json["signatures"].push_back(sample.signature);
  }
  json["measured"] = motion_json(plan, run, moments, &RecordedCycle::tool);
  json["commanded"] = motion_json(plan, run, moments, &RecordedCycle::commanded);
  json["wrench"] = wrench_json(run, moments);
  json["joints"] = joints_json(run, moments);
  const auto micro = [&](float RecordedCycle::*which) {
    return row(moments.peaks([&](std::size_t i) { return 1e6 * (run.samples[i].*which); }), kMicro);
  };
  json["wakeup_late_us"] = micro(&RecordedCycle::wakeup_late_s);
  json["compute_us"] = micro(&RecordedCycle::compute_s);
  json["late_cycles"] = late_json(run, moments);
  return json;
}

Json bus_json(const RecordedRun& run) {
  const Moments moments(run.bus.size(), kMomentsMax);
  const auto peaks = [&](double RecordedBus::*which) {
    return row(moments.peaks([&](std::size_t i) { return run.bus[i].*which; }), kTime);
  };
  return {{"times_s", row(moments.at([&](std::size_t i) { return run.bus[i].time_s; }), kTime)},
          {"load", peaks(&RecordedBus::load)},
          {"load_worst", peaks(&RecordedBus::load_worst)}};
}

/// From when to when a step ran. Without samples one follows the other.
struct Span {
  double from_s = 0.0;
  double to_s = 0.0;
  int step = -1;
};

std::vector<Span> spans_of(const RecordedRun& run) {
  std::vector<Span> spans;
  double end_s = 0.0;
  if (run.samples.empty()) {
    for (const RecordedStep& step : run.steps) {
      spans.push_back({end_s, end_s + step.duration_s, static_cast<int>(step.step)});
      end_s = spans.back().to_s;
    }
    return spans;
  }
  int running = -1;
  for (const RecordedCycle& sample : run.samples) {
    if (sample.step != running && sample.step >= 0) {
      spans.push_back({sample.time_s, sample.time_s, sample.step});
    }
    running = sample.step;
    if (running >= 0) spans.back().to_s = sample.time_s;
  }
  return spans;
}

/// Steps in the order in which they ran, the last perhaps unfinished.
Json spans_json(const RecordedRun& run) {
  Json json = Json::array();
  std::size_t finished = 0;
  for (const Span& span : spans_of(run)) {
    Json entry = {{"step", span.step},
                  {"from_s", number(span.from_s, kTime)},
                  {"to_s", number(span.to_s, kTime)}};
    const bool told =
        finished < run.steps.size() && static_cast<int>(run.steps[finished].step) == span.step;
    if (told) {
      const RecordedStep& step = run.steps[finished++];
      entry["outcome"] = to_string(step.outcome);
      entry["deviation"] = step.deviation;
      entry["signature"] = step.signature;
      entry["peak_force_N"] = number(step.peak_force_N, kForce);
      entry["tool"] = Json::parse(drawing::pose_json(step.tool));
    }
    json.push_back(std::move(entry));
  }
  return json;
}

Json fit_json(const Plan& plan, const RecordedRun& run) {
  const std::optional<Pose> fit = fit_of(plan, run);
  return fit ? Json::parse(drawing::pose_json(*fit)) : Json(nullptr);
}

Json run_of(const Plan& plan, const RecordedRun& run) {
  Json json = {{"done", run.done},           {"ended", run.ended},
               {"message", run.message},     {"duration_s", number(run.duration_s, kTime)},
               {"fit", fit_json(plan, run)}, {"spans", spans_json(run)}};
  json["limits"] = {{"force_limit_N", plan.force_limit_N},
                    {"torque_limit_Nm", plan.torque_limit_Nm}};
  if (run.limits) {
    json["limits"]["cycle_s"] = run.limits->cycle_s;
    json["limits"]["force_fault_N"] = run.limits->force_fault_N;
    json["limits"]["torque_fault_Nm"] = run.limits->torque_fault_Nm;
    json["limits"]["bus_load_most"] = run.limits->bus_load_most;
  }
  json["states"] = Json::array();
  for (const RecordedState& state : run.states) {
    json["states"].push_back({{"from_s", number(state.from_s, kTime)}, {"name", state.name}});
  }
  json["faults"] = Json::array();
  for (const RecordedFault& fault : run.faults) {
    Json entry = {{"text", fault.text}};
    if (fault.time_s) entry["time_s"] = number(*fault.time_s, kTime);
    json["faults"].push_back(std::move(entry));
  }
  if (!run.samples.empty()) json["curves"] = curves_json(plan, run);
  if (!run.bus.empty()) json["bus"] = bus_json(run);
  return json;
}

/// A small octahedron in place of a part that is not known.
Json tip_json(double size_m) {
  Json points = Json::array();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      for (int i = 0; i < 3; ++i) points.push_back(i == axis ? sign * size_m : 0.0);
    }
  }
  return {{"name", "tool tip"},
          {"points_m", std::move(points)},
          {"triangles", {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}}};
}

/// The plan's part of the page where nothing is known but the plan itself.
Json bare_plan(const Plan& plan) {
  Json json = {{"task", plan.task_name},
               {"start_name", plan.start_name},
               {"views", Json::parse(drawing::views_json(plan.coordinates))},
               {"start", Json::parse(drawing::pose_json(plan.start))},
               {"goal", Json::parse(drawing::pose_json(plan.goal))},
               {"goal_tolerance_m", plan.goal_tolerance_m}};
  const double way_m = (plan.goal.position_m - plan.start.position_m).norm();
  json["scene"] = {{"held", {tip_json(std::max(0.04 * way_m, 1e-3))}},
                   {"environment", Json::array()}};
  json["coordinates"] = Json::array();
  for (int axis = 0; axis < 6; ++axis) {
    if (has(plan.coordinates, axis)) json["coordinates"].push_back(axis);
  }
  json["steps"] = Json::array();
  for (const Step& step : plan.steps) {
    json["steps"].push_back({{"words", drawing::displacement_text(step)}});
  }
  json["nodes"] = Json::array();
  json["particles"] = Json::array();
  return json;
}

}  // namespace

std::string run_json(const Plan& plan, const RecordedRun& run, const ReportData* data) {
  Json json = data == nullptr ? bare_plan(plan) : Json::parse(page_json(*data));
  json["kind"] = "run";
  json["draws"] = Json::array();
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const ContactThresholds& set = plan.parameter_sets[plan.steps[i].parameter_set].thresholds;
    json["steps"][i]["force_on_N"] = set.force_on_N;
    json["steps"][i]["force_off_N"] = set.force_off_N;
    json["steps"][i]["torque_on_Nm"] = set.torque_on_Nm;
    json["steps"][i]["torque_off_Nm"] = set.torque_off_Nm;
  }
  json["run"] = run_of(plan, run);
  return json.dump();
}

}  // namespace tenon::planner
