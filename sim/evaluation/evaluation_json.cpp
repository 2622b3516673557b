#include "sim/evaluation/evaluation_json.h"

#include <nlohmann/json.hpp>

#include "shared/base/text.h"
#include "sim/evaluation/run_line.h"
#include "sim/evaluation/summary.h"

namespace tenon::sim {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Rate& rate) {
  const Interval interval = rate.interval();
  return {{"runs", rate.count},
          {"succeeded", rate.successes},
          {"rate", rate.value()},
          {"wilson95_low", interval.low},
          {"wilson95_high", interval.high}};
}

Json json_of(const Quantiles& quantiles) {
  return {{"p50", quantiles.p50},
          {"p95", quantiles.p95},
          {"p99", quantiles.p99},
          {"max", quantiles.max}};
}

Json json_of(const AxisError& error) {
  return {{"axis", std::string(axis_name(error.axis)) + (error.axis < 3 ? "_m" : "_rad")},
          {"mean", error.final.mean},
          {"deviation", error.final.deviation},
          {"initial_deviation", error.initial.deviation},
          {"ratio", error.ratio()}};
}

Json json_of(const Summary& summary) {
  Json json;
  json["success"] = json_of(summary.success);
  json["stopped"] = summary.stopped;
  json["done_but_wrong"] = summary.done_but_wrong;
  json["within"] = Json::array();
  for (const RateWithin& within : summary.within) {
    Json part = {{"distance", within.distance}, {"mass", within.mass}};
    part.update(json_of(within.rate));
    json["within"].push_back(part);
  }
  json["promised"] = json_of(summary.promised);
  json["endings"] = summary.endings;
  json["error"] = Json::array();
  for (const AxisError& error : summary.errors) json["error"].push_back(json_of(error));
  json["error_norm_m"] = {{"mean", summary.error_norm_m.mean},
                          {"deviation", summary.error_norm_m.deviation}};
  json["error_norm_m"].update(json_of(summary.error_norms_m));
  json["contact_force_N_max"] = json_of(summary.contact_force_N);
  json["duration_s"] = json_of(summary.duration_s);
  return json;
}

Json json_of(const std::vector<Bins>& by, const Candidate& candidate) {
  Json cells = Json::array();
  const std::vector<std::vector<Rate>> rates = break_down(by, candidate);
  for (std::size_t row = 0; row < rates.size(); ++row) {
    for (std::size_t column = 0; column < rates[row].size(); ++column) {
      Json cell;
      const auto edges = [&](const Bins& bins, std::size_t bin) {
        cell[bins.quantity] = {bins.edges(bin).low, bins.edges(bin).high};
      };
      edges(by[0], column);
      if (by.size() > 1) edges(by[1], row);
      cell.update(json_of(rates[row][column]));
      cells.push_back(cell);
    }
  }
  return cells;
}

Json failures_json(const Candidate& candidate) {
  Json kinds = Json::array();
  for (const FailureKind& kind : kinds_of_failure(candidate)) {
    const TrialResult& result = kind.first().result;
    kinds.push_back({{"class", to_string(classify(result))},
                     {"ending", result.ending},
                     {"step", result.step},
                     {"outcome", result.outcome},
                     {"runs", kind.count},
                     {"first_run", kind.first().trial.number},
                     {"first_reason", result.reason}});
  }
  return kinds;
}

Json json_of(const Evaluation& evaluation, const Candidate& candidate, bool with_runs) {
  const Plan& plan = candidate.plan;
  Json json = {{"file", candidate.file},
               {"hash", candidate.hash},
               {"method", to_string(plan.method)},
               {"start", plan.start_name},
               {"steps", plan.steps.size()},
               {"check_envelopes", plan.check_envelopes},
               {"made_for_this_task", plan.task_hash == evaluation.task.hash}};
  json["summary"] = json_of(summarise(evaluation.task, candidate));
  json["failures"] = failures_json(candidate);
  if (!evaluation.by.empty()) json["by"] = json_of(evaluation.by, candidate);
  if (!with_runs) return json;
  json["runs"] = Json::array();
  for (const auto& [number, run] : candidate.runs) {
    Json line = Json::parse(run_line(candidate.hash, run, evaluation.ranges.has_value()));
    line.erase("plan");
    json["runs"].push_back(std::move(line));
  }
  return json;
}

std::string text_of(const Evaluation& evaluation, bool with_runs) {
  Json json = {{"task", evaluation.task.name},
               {"cell", evaluation.cell.name},
               {"experiment", evaluation.ranges ? Json(evaluation.ranges->name) : Json()},
               {"seed", evaluation.seed},
               {"goal_tolerance_m", evaluation.task.goal_tolerance_m},
               {"particle_sigmas", evaluation.task.particle_sigmas}};
  json["plans"] = Json::array();
  for (const Candidate& candidate : evaluation.candidates) {
    json["plans"].push_back(json_of(evaluation, candidate, with_runs));
  }
  return json.dump(1) + "\n";
}

}  // namespace

std::string evaluation_json(const Evaluation& evaluation) { return text_of(evaluation, true); }

std::string summary_json(const Evaluation& evaluation) { return text_of(evaluation, false); }

}  // namespace tenon::sim
