#include "planner/report/page_data.h"

#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "planner/report/drops.h"
#include "planner/report/report_words.h"
#include "planner/report/touched.h"
#include "shared/drawing/scene_json.h"
#include "shared/drawing/step_words.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

using Json = nlohmann::ordered_json;

/// To a thousandth of a millimetre or a milliradian: a page has thousands of them.
double rounded(double value) { return std::round(1e6 * value) / 1e6; }

Json rounded_json(const Vector6& v) {
  Json json = Json::array();
  for (int axis = 0; axis < 6; ++axis) json.push_back(rounded(v[axis]));
  return json;
}

Json rounded_json(const Pose& pose) { return Json::parse(drawing::pose_json(pose)); }

Json json_of(const ReportData& data, const Chain& chain) {
  Json json;
  json["poses"] = Json::array({rounded_json(chain.tool(0))});
  json["outcomes"] = Json::array();
  json["durations_s"] = Json::array();
  json["touching"] = Json::array();
  for (std::size_t i = 0; i < chain.moves.size(); ++i) {
    const GuardedMove::Result& move = chain.moves[i];
    json["poses"].push_back(rounded_json(chain.tool(i + 1)));
    json["outcomes"].push_back(to_string(move.outcome));
    json["durations_s"].push_back(1e-3 * std::round(1e-6 * static_cast<double>(move.duration_ns)));
    json["touching"].push_back(touched_by(data, chain, i));
  }
  json["steps"] = chain.steps;
  json["done"] = chain.done;
  if (!chain.failure.empty()) json["failure"] = chain.failure;
  return json;
}

Json step_json(const ReportData& data, std::size_t index) {
  const Step& step = data.plan.steps[index];
  Json json;
  json["displacement"] = rounded_json(step.displacement);
  json["carried_axes"] = data.plan.parameter_sets[step.parameter_set].carried_axes;
  json["words"] = drawing::displacement_text(step);
  if (index + 1 < data.nodes.size()) {
    json["outcomes"] = outcomes_text(data, index);
    json["touched"] = touched_after(data, index);
    json["gains"] = Json::array();
    for (const Drop& drop : drops_in(data, index)) {
      json["gains"].push_back({{"axis", drop.axis}, {"settled", drop.settled}, {"why", drop.why}});
    }
  }
  return json;
}

}  // namespace

std::string page_json(const ReportData& data) {
  const Plan& plan = data.plan;
  Json json;
  json["kind"] = "plan";
  json["task"] = plan.task_name;
  json["start_name"] = plan.start_name;
  json["method"] = to_string(plan.method);
  json["scene"] = Json::parse(drawing::scene_json(data.task));
  json["views"] = Json::parse(drawing::views_json(plan.coordinates));
  json["coordinates"] = Json::array();
  for (int axis = 0; axis < 6; ++axis) {
    if (has(plan.coordinates, axis)) json["coordinates"].push_back(axis);
  }
  json["start"] = rounded_json(plan.start);
  json["goal"] = rounded_json(plan.goal);
  json["goal_tolerance_m"] = rounded(plan.goal_tolerance_m);
  json["goal_uncertainty_m"] = rounded(std::sqrt(data.task.goal_uncertainty_m2));
  json["steps"] = Json::array();
  for (std::size_t i = 0; i < plan.steps.size(); ++i) json["steps"].push_back(step_json(data, i));
  json["nodes"] = Json::array();
  for (const BeliefNode& node : data.nodes) {
    json["nodes"].push_back({{"spread", rounded_json(node.spread)},
                             {"uncertainty_m", rounded(std::sqrt(node.uncertainty_m2))}});
  }
  json["particles"] = Json::array();
  for (const Chain& chain : data.chains) json["particles"].push_back(json_of(data, chain));
  json["draws"] = Json::array();
  for (const Draw& draw : data.validation.draws) {
    Json entry = json_of(data, draw.chain);
    entry["out"] = out_text(data.task, draw.sigmas_out);
    entry["at_goal"] = draw.at_goal;
    json["draws"].push_back(std::move(entry));
  }
  return json.dump();
}

}  // namespace tenon::planner
