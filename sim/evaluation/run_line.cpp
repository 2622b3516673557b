#include "sim/evaluation/run_line.h"

#include <nlohmann/json.hpp>

#include "sim/cell/virtual_arm/world_json.h"

namespace tenon::sim {
namespace {

using Json = nlohmann::ordered_json;

Vector6 axes_of(const Json& json) {
  Vector6 value;
  int axis = 0;
  for (const Json& element : json) value[axis++] = element.get<double>();
  return value;
}

Json path_json(const std::vector<Vector3>& path_m) {
  Json json = Json::array();
  for (const Vector3& p : path_m) json.push_back({p.x(), p.y(), p.z()});
  return json;
}

Vector3 point_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

}  // namespace

std::string run_line(const std::string& plan, const Run& run, bool with_world) {
  const Trial& trial = run.trial;
  const TrialResult& result = run.result;
  Json json;
  json["plan"] = plan;
  json["run"] = trial.number;
  json["seed"] = trial.seed;
  json["class"] = to_string(classify(result));
  json["done"] = result.done;
  json["at_goal"] = result.at_goal;
  json["ending"] = result.ending;
  json["reason"] = result.reason;
  json["step"] = result.step;
  json["outcome"] = result.outcome;
  json["steps"] = result.steps;
  json["duration_s"] = result.duration_s;
  json["contact_force_N_max"] = result.contact_force_N_max;
  json["error"] = result.error ? by_axis(*result.error) : Json();
  json["error_norm_m"] = result.error ? Json(result.error->head<3>().norm()) : Json();
  json["path"] = path_json(result.path_m);
  json["distance"] = trial.distance;
  json["offset"] = by_axis(trial.offset);
  if (with_world) json["world"] = world_json(trial.world);
  return json.dump();
}

std::optional<RunRecord> parse_run_line(const std::string& line) {
  try {
    const Json json = Json::parse(line);
    RunRecord record;
    record.plan = json.at("plan").get<std::string>();
    record.number = json.at("run").get<std::size_t>();
    record.seed = json.at("seed").get<std::uint64_t>();
    TrialResult& result = record.result;
    result.done = json.at("done").get<bool>();
    result.at_goal = json.at("at_goal").get<bool>();
    result.ending = json.at("ending").get<std::string>();
    result.reason = json.at("reason").get<std::string>();
    result.step = json.at("step").get<int>();
    result.outcome = json.at("outcome").get<std::string>();
    result.steps = json.at("steps").get<std::size_t>();
    result.duration_s = json.at("duration_s").get<double>();
    result.contact_force_N_max = json.at("contact_force_N_max").get<double>();
    const Json& error = json.at("error");
    if (error.size() == 6) result.error = axes_of(error);
    for (const Json& point : json.at("path")) result.path_m.push_back(point_of(point));
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace tenon::sim
