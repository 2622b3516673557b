#include "sim/evaluation/evaluation_page_data.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/drawing/scene_json.h"
#include "shared/drawing/step_words.h"
#include "shared/task/spread.h"
#include "sim/evaluation/summary.h"

namespace tenon::sim {
namespace {

using Json = nlohmann::ordered_json;

/// To so many decimals: a page has thousands of numbers.
double rounded(double value, double decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(scale * value) / scale;
}

/// What runs are told apart by, in the order of the page: success, done but wrong, then the
/// endings of those that stopped.
using OutcomeKey = std::pair<TrialClass, std::string>;

OutcomeKey key_of(const TrialResult& result) {
  const TrialClass kind = classify(result);
  return {kind, kind == TrialClass::kStopped ? result.ending : ""};
}

std::vector<OutcomeKey> outcomes_of(const Evaluation& evaluation) {
  std::map<std::string, std::size_t> stopped;
  for (const Candidate& candidate : evaluation.candidates) {
    for (const auto& [number, run] : candidate.runs) {
      const OutcomeKey key = key_of(run.result);
      if (key.first == TrialClass::kStopped) ++stopped[key.second];
    }
  }
  std::vector<OutcomeKey> keys = {{TrialClass::kSucceeded, ""}, {TrialClass::kDoneButWrong, ""}};
  for (const auto& [ending, count] : stopped) keys.emplace_back(TrialClass::kStopped, ending);
  return keys;
}

std::size_t index_of(const std::vector<OutcomeKey>& outcomes, const TrialResult& result) {
  const auto at = std::find(outcomes.begin(), outcomes.end(), key_of(result));
  return static_cast<std::size_t>(at - outcomes.begin());
}

/// What a plan promises to hold for: "3σ and 0.17°".
std::string reach_words(const Evaluation& evaluation) {
  const Task& task = evaluation.task;
  const bool tilts =
      std::any_of(evaluation.candidates.begin(), evaluation.candidates.end(),
                  [&](const Candidate& candidate) { return summarise(task, candidate).tilts; });
  return (task.errors == Distribution::kUniform ? "the bounds"
                                                : format("%g\u03c3", task.particle_sigmas)) +
         (tilts ? format(" and %.2f\u00b0", shown(task.tilt_rad, 3)) : "");
}

Json outcome_json(const OutcomeKey& key) {
  switch (key.first) {
    case TrialClass::kSucceeded:
      return {{"class", "succeeded"}, {"name", "at the goal"}};
    case TrialClass::kDoneButWrong:
      return {{"class", "wrong"}, {"name", "done but wrong"}};
    case TrialClass::kStopped:
      return {{"class", "stopped"}, {"name", "stopped: " + key.second}};
  }
  return {};
}

Json run_json(const Task& task, const std::vector<OutcomeKey>& outcomes, const Run& run) {
  Json path = Json::array();
  for (const Vector3& p : run.result.path_m) {
    for (int axis = 0; axis < 3; ++axis) path.push_back(rounded(p[axis], 5));
  }
  return {{"run", run.trial.number},
          {"outcome", index_of(outcomes, run.result)},
          {"beyond", !within_promise(run.trial, task)},
          {"path", std::move(path)}};
}

/// Column by column; what touches is told where it changes.
Json moments_json(const std::vector<Moment>& moments) {
  Json json = {{"times_s", Json::array()},
               {"steps", Json::array()},
               {"tools", Json::array()},
               {"wrench", Json::array()},
               {"touching", Json::array()}};
  for (int axis = 0; axis < 6; ++axis) json["wrench"].push_back(Json::array());
  const std::set<std::string>* touching = nullptr;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Moment& moment = moments[i];
    json["times_s"].push_back(rounded(1e-9 * static_cast<double>(moment.time_ns), 3));
    json["steps"].push_back(moment.step);
    json["tools"].push_back(Json::parse(drawing::pose_json(moment.tool)));
    for (int axis = 0; axis < 6; ++axis) {
      json["wrench"][static_cast<std::size_t>(axis)].push_back(
          rounded(moment.wrench[axis], axis < 3 ? 2 : 3));
    }
    if (touching != nullptr && *touching == moment.touching) continue;
    touching = &moment.touching;
    json["touching"].push_back({{"from", i}, {"names", moment.touching}});
  }
  return json;
}

Json recording_json(const Task& task, const std::vector<OutcomeKey>& outcomes, const Run& run,
                    const Recording& recording) {
  Json json = {{"run", run.trial.number},
               {"outcome", index_of(outcomes, run.result)},
               {"out", out_text(task, run.trial.distance) + tilt_text(run.trial)},
               {"reason", run.result.reason},
               {"step", run.result.step},
               {"step_outcome", run.result.outcome},
               {"contact_force_N_max", rounded(run.result.contact_force_N_max, 1)}};
  if (run.result.error) json["error_m"] = rounded(run.result.error->head<3>().norm(), 6);
  json.update(moments_json(recording.moments()));
  return json;
}

Json step_json(const Plan& plan, const Step& step) {
  const ContactThresholds& thresholds = plan.parameter_sets[step.parameter_set].thresholds;
  return {{"words", drawing::displacement_text(step)},
          {"force_on_N", thresholds.force_on_N},
          {"force_off_N", thresholds.force_off_N},
          {"torque_on_Nm", thresholds.torque_on_Nm},
          {"torque_off_Nm", thresholds.torque_off_Nm}};
}

Json plan_json(const Task& task, const std::vector<OutcomeKey>& outcomes,
               const Candidate& candidate, const Candidate& sample) {
  const std::size_t slash = candidate.file.rfind('/');
  Json json = {
      {"name", slash == std::string::npos ? candidate.file : candidate.file.substr(slash + 1)},
      {"start", Json::parse(drawing::pose_json(candidate.start.pose))},
      {"count", candidate.runs.size()}};
  std::vector<std::size_t> counts(outcomes.size());
  std::size_t beyond = 0;
  for (const auto& [number, run] : candidate.runs) {
    ++counts[index_of(outcomes, run.result)];
    beyond += !within_promise(run.trial, task);
  }
  json["counts"] = counts;
  json["beyond"] = beyond;
  json["steps"] = Json::array();
  for (const Step& step : candidate.plan.steps) {
    json["steps"].push_back(step_json(candidate.plan, step));
  }
  json["runs"] = Json::array();
  for (const auto& [number, run] : sample.runs) {
    if (!run.result.path_m.empty()) json["runs"].push_back(run_json(task, outcomes, run));
  }
  json["recordings"] = Json::array();
  for (const auto& [number, recording] : candidate.recordings) {
    json["recordings"].push_back(
        recording_json(task, outcomes, candidate.runs.at(number), recording));
  }
  return json;
}

}  // namespace

std::string evaluation_page_json(const Evaluation& evaluation,
                                 const std::vector<Candidate>& samples) {
  const Task& task = evaluation.task;
  const std::vector<OutcomeKey> outcomes = outcomes_of(evaluation);
  Json json = {{"kind", "evaluation"},
               {"task", task.name},
               {"scene", Json::parse(drawing::scene_json(task))},
               {"views", Json::parse(drawing::views_json(task.coordinates))},
               {"coordinates", Json::array()},
               {"goal", Json::parse(drawing::pose_json(task.goal))},
               {"goal_tolerance_m", task.goal_tolerance_m},
               {"reach", reach_words(evaluation)},
               {"outcomes", Json::array()},
               {"plans", Json::array()}};
  for (int axis = 0; axis < 6; ++axis) {
    if (has(task.coordinates, axis)) json["coordinates"].push_back(axis);
  }
  for (const OutcomeKey& key : outcomes) json["outcomes"].push_back(outcome_json(key));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    json["plans"].push_back(plan_json(task, outcomes, evaluation.candidates[i], samples[i]));
  }
  return json.dump();
}

}  // namespace tenon::sim
