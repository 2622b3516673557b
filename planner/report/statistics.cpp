#include "planner/report/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "planner/report/summary.h"
#include "shared/base/crc32c.h"
#include "shared/base/error.h"
#include "shared/base/printable.h"
#include "shared/base/text.h"
#include "shared/base/wilson.h"

namespace tenon::planner {
namespace {

using Json = nlohmann::ordered_json;
// Finds a key without looking through all others, of which a file may hold a million.
using ReadJson = nlohmann::json;

constexpr std::size_t kCourseMax = 200;  // expansions of a course that are told
constexpr const char* kPhases[] = {"attractors", "search", "certification", "corners",
                                   "validation"};

Json moves_json(const SuccessorEngine::Counters& c) {
  return {{"simulated", c.rollouts}, {"memo_hits", c.memo_hits}, {"failures", c.failures}};
}

Json rounds_json(const PlanReport& report) {
  Json rounds = Json::array();
  for (const SearchRound& round : report.rounds) {
    rounds.push_back({{"w1", round.parameters.w1},
                      {"w2", round.parameters.w2},
                      {"expansions", round.expansions},
                      {"steps", round.steps},
                      {"cost", round.cost},
                      {"lower_bound", round.lower_bound},
                      {"outcome", round.outcome}});
  }
  return rounds;
}

/// Evenly, the last of them always.
Json course_json(const SearchResult& search) {
  Json course = {{"expansions", Json::array()}, {"lower_bound", Json::array()}};
  course["cost"] = Json::array();
  const auto add = [&](std::size_t expansions, double lower_bound, double cost) {
    course["expansions"].push_back(expansions);
    course["lower_bound"].push_back(lower_bound);
    course["cost"].push_back(std::isfinite(cost) ? Json(cost) : Json(nullptr));
  };
  const std::size_t count = search.costs.size();
  if (!search.has_path || count == 0) return course;
  const std::size_t every = (count + kCourseMax - 2) / (kCourseMax - 1);
  for (std::size_t i = 0; i < count; i += every) {
    add(i, search.lower_bounds[i], search.costs[i]);
  }
  add(count, search.lower_bound, search.cost);
  return course;
}

void add_plan(Json& json, const PlanReport& report, const Task& task) {
  json["start"] = report.plan->start_name;
  json["steps"] = report.plan->steps.size();
  json["bytes"] = report.bytes.size();
  json["crc32c"] = crc32c(report.bytes);
  json["cost"] = report.plan->cost;
  json["bound"] = report.plan->bound;
  json["search_cost"] = report.search.cost;
  json["search_lower_bound"] = report.search.lower_bound;
  json["draws"] = report.plan->draws;
  json["draws_at_goal"] = report.plan->draws_at_goal;
  const Interval interval = wilson_interval(report.plan->draws_at_goal, report.plan->draws);
  json["wilson95_low"] = interval.low;
  json["wilson95_high"] = interval.high;
  json["corners"] = report.validation.corners.size();
  json["corners_at_goal"] = arrived(report.validation.corners);
  json["corners_tilt_rad"] = report.validation.held.tilt_rad;
  json["corners_sensor_error_m"] = report.validation.held.sensor_error_m;
  json["beyond"] = report.validation.rim.size();
  json["beyond_at_goal"] = arrived(report.validation.rim);
  json["particle_sigmas"] = task.particle_sigmas;
  json["draws_within_particles"] = report.validation.within(task.particle_sigmas);
  json["draws_within_particles_at_goal"] = report.validation.at_goal_within(task.particle_sigmas);
  json["missed"] = missed(report, task);
  json["peak_force_N"] = peak_force_N(report);
}

/// What is wrong with a file's contents, other than that it is no such file.
struct Wrong {
  std::string what;
};

double number(const ReadJson& json, double least = 0.0) {
  const double value = json.get<double>();
  if (!json.is_number() || !(value >= least)) {
    throw Wrong{format("a number is %g, must be at least %g", value, least)};
  }
  return value;
}

/// Of lists and objects no more than that they are: printing them takes as many calls as they are
/// deep.
std::string written(const ReadJson& json) {
  return json.is_structured() ? std::string(json.type_name()) : json.dump();
}

std::uint64_t count(const ReadJson& json) {
  if (!json.is_number_unsigned()) throw Wrong{"a count is none: " + written(json)};
  return json.get<std::uint64_t>();
}

const ReadJson& list(const ReadJson& json) {
  if (!json.is_array()) throw Wrong{"a list is none: " + written(json)};
  return json;
}

std::string words(const ReadJson& json) { return printable(json.get<std::string>()); }

SearchRound round_of(const ReadJson& json, std::size_t heuristics) {
  SearchRound round;
  round.parameters.w1 = number(json.at("w1"), 1.0);
  round.parameters.w2 = number(json.at("w2"), 1.0);
  for (const ReadJson& expansions : list(json.at("expansions"))) {
    round.expansions.push_back(count(expansions));
  }
  if (round.expansions.size() != heuristics) {
    throw Wrong{format("a search has %zu queues of %zu", round.expansions.size(), heuristics)};
  }
  round.steps = count(json.at("steps"));
  round.cost = number(json.at("cost"));
  round.lower_bound = number(json.at("lower_bound"));
  round.outcome = words(json.at("outcome"));
  return round;
}

void take_course(const ReadJson& json, SearchStory& story) {
  const ReadJson& expansions = list(json.at("expansions"));
  const ReadJson& lower_bounds = list(json.at("lower_bound"));
  const ReadJson& costs = list(json.at("cost"));
  const std::size_t size = expansions.size();
  if (lower_bounds.size() != size || costs.size() != size || size == 1 || size > kCourseMax + 1) {
    throw Wrong{format("the course of the search has %zu, %zu and %zu values", size,
                       lower_bounds.size(), costs.size())};
  }
  for (std::size_t i = 0; i < size; ++i) {
    story.expansions.push_back(count(expansions[i]));
    story.lower_bounds.push_back(number(lower_bounds[i]));
    story.costs.push_back(costs[i].is_null() ? std::numeric_limits<double>::infinity()
                                             : number(costs[i]));
  }
  if (!std::is_sorted(story.expansions.begin(), story.expansions.end())) {
    throw Wrong{"the course of the search goes back"};
  }
}

SearchStory story_of(const ReadJson& json, std::span<const std::uint8_t> plan) {
  if (json.at("status") != to_string(PlanStatus::kPlanned)) {
    throw Wrong{"there is no plan that it could be of: " + words(json.at("status"))};
  }
  if (count(json.at("bytes")) != plan.size() || count(json.at("crc32c")) != crc32c(plan)) {
    throw Wrong{"it is of another plan"};
  }
  SearchStory story;
  for (const ReadJson& name : list(json.at("heuristics"))) story.heuristics.push_back(words(name));
  story.guide = words(json.at("guide"));
  story.bound = number(json.at("bound"));
  story.states = count(json.at("states"));
  for (const ReadJson& round : list(json.at("searches"))) {
    story.rounds.push_back(round_of(round, story.heuristics.size()));
  }
  take_course(json.at("course"), story);
  for (const char* phase : kPhases) {
    const ReadJson& moves = json.at("moves").at(phase);
    story.phases.push_back({phase, number(json.at("time_s").at(phase)),
                            count(moves.is_object() ? moves.at("simulated") : moves)});
  }
  return story;
}

}  // namespace

std::string statistics_json(const PlanReport& report, const Task& task) {
  Json json;
  json["status"] = to_string(report.status);
  json["reason"] = report.reason;
  json["method"] = to_string(report.method);
  json["guides"] = report.guides;
  json["guide"] = report.guide;
  json["states"] = report.states;
  json["expansions"] = report.expansions;
  json["expansions_first"] = report.expansions_first;
  json["refusals"] = report.refusals;
  json["adapted"] = report.adapted;
  json["moves"] = {{"attractors", moves_json(report.attractor_moves)},
                   {"search", moves_json(report.search_moves)},
                   {"certification", report.judging.certification.moves},
                   {"corners", report.judging.corners.moves},
                   {"validation", report.judging.validation.moves}};
  json["time_s"] = {{"attractors", report.times.attractors_s},
                    {"search", report.times.search_s},
                    {"certification", report.judging.certification.time_s},
                    {"corners", report.judging.corners.time_s},
                    {"validation", report.judging.validation.time_s}};
  json["heuristics"] = report.heuristics;
  json["searches"] = rounds_json(report);
  json["course"] = course_json(report.search);
  if (report.plan) add_plan(json, report, task);
  return json.dump(2) + "\n";
}

SearchStory read_statistics(const std::string& file, const std::string& text,
                            std::span<const std::uint8_t> plan) {
  const auto refused = [&](const std::string& what) {
    return InputError(file + ": " + shortened(what, 300) +
                      "; give the file that tenon-plan wrote with --json when it wrote the plan");
  };
  try {
    return story_of(ReadJson::parse(text), plan);
  } catch (const ReadJson::exception& error) {
    throw refused(printable(error.what()));
  } catch (const Wrong& wrong) {
    throw refused(wrong.what);
  }
}

}  // namespace tenon::planner
