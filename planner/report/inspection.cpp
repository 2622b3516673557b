#include "planner/report/inspection.h"

#include <nlohmann/json.hpp>

#include "planner/report/summary.h"
#include "shared/base/text.h"

namespace tenon::planner {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vector6& v) { return {v[0], v[1], v[2], v[3], v[4], v[5]}; }

Json json_of(const Pose& pose) {
  const Vector3& p = pose.position_m;
  const Vector3 r = rotation_vector(pose.orientation);
  return {{"position_m", {p.x(), p.y(), p.z()}}, {"rotation_rad", {r.x(), r.y(), r.z()}}};
}

Json json_of(const OutcomeRule& rule) {
  Json json;
  if (rule.successor == kSuccessorDone) {
    json["successor"] = "done";
  } else {
    json["successor"] = rule.successor;
  }
  json["travelled_min"] = json_of(rule.envelope.travelled_min);
  json["travelled_max"] = json_of(rule.envelope.travelled_max);
  json["place_min"] = json_of(rule.envelope.place_min);
  json["place_max"] = json_of(rule.envelope.place_max);
  json["always"] = to_string(rule.envelope.always);
  json["possible"] = to_string(rule.envelope.possible);
  return json;
}

Json json_of(const Step& step) {
  Json json;
  json["displacement"] = json_of(step.displacement);
  json["slow_from_m"] = step.slow_from_m;
  json["parameter_set"] = step.parameter_set;
  json["outcomes"] = Json::object();
  for (const Outcome outcome : kOutcomes) {
    const OutcomeRule& rule = step.rule(outcome);
    if (rule.successor != kSuccessorFail) json["outcomes"][to_string(outcome)] = json_of(rule);
  }
  return json;
}

Json json_of(const ParameterSet& set) {
  const SpeedLimits& v = set.speeds;
  const ContactThresholds& t = set.thresholds;
  return {{"approach_mps", v.approach_mps},
          {"contact_mps", v.contact_mps},
          {"acceleration_mps2", v.acceleration_mps2},
          {"jerk_mps3", v.jerk_mps3},
          {"force_on_N", t.force_on_N},
          {"force_keep_N", t.force_keep_N},
          {"force_off_N", t.force_off_N},
          {"torque_on_Nm", t.torque_on_Nm},
          {"torque_keep_Nm", t.torque_keep_Nm},
          {"torque_off_Nm", t.torque_off_Nm},
          {"debounce_us", t.debounce_us},
          {"timeout_us", set.timeout_us},
          {"trigger_mask", to_string(set.trigger_mask)},
          {"sensed_axes", axis_list(set.sensed_axes)},
          {"carried_axes", set.carried_axes},
          {"aligns", set.aligns}};
}

}  // namespace

std::string header_text(const Plan& plan, std::size_t bytes) {
  const Compliance& c = plan.compliance;
  std::string text;
  text += format("task %s (hash %016llx), start %s, method %s%s\n", plan.task_name.c_str(),
                 static_cast<unsigned long long>(plan.task_hash), plan.start_name.c_str(),
                 to_string(plan.method),
                 plan.check_envelopes ? "" : "; no envelopes are checked in execution");
  text += format("%zu bytes, %zu step%s, %zu parameter set%s, coordinates %s\n", bytes,
                 plan.steps.size(), plural(plan.steps.size()), plan.parameter_sets.size(),
                 plural(plan.parameter_sets.size()), axis_list(plan.coordinates).c_str());
  text += format("start (%.4f, %.4f, %.4f) m, goal (%.4f, %.4f, %.4f) m within ",
                 plan.start.position_m.x(), plan.start.position_m.y(), plan.start.position_m.z(),
                 plan.goal.position_m.x(), plan.goal.position_m.y(), plan.goal.position_m.z()) +
          tolerance_text(plan.goal_tolerance_m, plan.goal_axes) + "\n";
  text += format("compliance M %g kg, D %g Ns/m, K %g N/m on %s; force limit %g N\n", c.mass_kg,
                 c.damping_Nspm, c.stiffness_Npm, axis_list(c.compliant_axes).c_str(),
                 plan.force_limit_N);
  text += format("made for contact stiffness %g N/m, latency up to %.1f ms\n",
                 plan.contact_stiffness_Npm, 1e3 * plan.latency_max_s);
  text += cost_text(plan);
  return text +
         format("validation: %u of %u draws ended at the goal\n", plan.draws_at_goal, plan.draws);
}

std::string plan_json(const Plan& plan, std::size_t bytes) {
  const Compliance& c = plan.compliance;
  Json json;
  json["task"] = plan.task_name;
  json["task_hash"] = format("%016llx", static_cast<unsigned long long>(plan.task_hash));
  json["start_name"] = plan.start_name;
  json["method"] = to_string(plan.method);
  json["bytes"] = bytes;
  json["coordinates"] = axis_list(plan.coordinates);
  json["start"] = json_of(plan.start);
  json["goal"] = json_of(plan.goal);
  json["goal_tolerance_m"] = plan.goal_tolerance_m;
  if (plan.goal_axes.any()) {
    json["goal_axis_tolerances"] = json_of(plan.goal_axes.tolerance);
    json["goal_free_axes"] = axis_list(plan.goal_axes.free);
  }
  json["compliance"] = {{"mass_kg", c.mass_kg},
                        {"damping_Nspm", c.damping_Nspm},
                        {"stiffness_Npm", c.stiffness_Npm},
                        {"inertia_kgm2", c.inertia_kgm2},
                        {"damping_Nmspr", c.damping_Nmspr},
                        {"stiffness_Nmpr", c.stiffness_Nmpr},
                        {"axes", axis_list(c.compliant_axes)}};
  json["force_limit_N"] = plan.force_limit_N;
  json["torque_limit_Nm"] = plan.torque_limit_Nm;
  json["contact_stiffness_Npm"] = plan.contact_stiffness_Npm;
  json["latency_max_s"] = plan.latency_max_s;
  json["cost"] = plan.cost;
  json["bound"] = plan.bound;
  json["draws"] = plan.draws;
  json["draws_at_goal"] = plan.draws_at_goal;
  json["check_envelopes"] = plan.check_envelopes;
  json["parameter_sets"] = Json::array();
  for (const ParameterSet& set : plan.parameter_sets)
    json["parameter_sets"].push_back(json_of(set));
  json["steps"] = Json::array();
  for (const Step& step : plan.steps) json["steps"].push_back(json_of(step));
  return json.dump(2) + "\n";
}

}  // namespace tenon::planner
