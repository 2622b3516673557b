#include "sim/evaluation/evaluation_junit.h"

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/task/spread.h"
#include "sim/evaluation/summary.h"

namespace tenon::sim {
namespace {

/// How many tests of a suite came to what.
struct Counts {
  std::size_t tests = 0;
  std::size_t failures = 0;
  std::size_t errors = 0;
  std::size_t skipped = 0;
  double time_s = 0.0;
};

/// XML knows no other control characters, not even escaped.
std::string in_xml(const std::string& text) {
  std::string safe = drawing::escaped(text);
  for (char& c : safe) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') c = ' ';
  }
  return safe;
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "='" + in_xml(value) + "'";
}

std::string attributes_of(const Counts& counts, bool of_suite) {
  std::string text = attribute("tests", std::to_string(counts.tests)) +
                     attribute("failures", std::to_string(counts.failures)) +
                     attribute("errors", std::to_string(counts.errors));
  if (of_suite) text += attribute("skipped", std::to_string(counts.skipped));
  return text + attribute("time", format("%.3f", counts.time_s));
}

std::string properties_of(const Evaluation& evaluation, const Candidate& candidate,
                          const Rate& success, std::optional<double> min_success) {
  const Interval interval = success.interval();
  std::vector<std::pair<const char*, std::string>> properties = {
      {"task", evaluation.task.name},
      {"cell", evaluation.cell.name},
      {"experiment", evaluation.ranges ? evaluation.ranges->name : ""},
      {"seed", std::to_string(evaluation.seed)},
      {"plan", candidate.file},
      {"plan_hash", candidate.hash},
      {"start", candidate.plan.start_name},
      {"runs", std::to_string(success.count)},
      {"succeeded", std::to_string(success.successes)},
      {"success_rate", format("%.6f", success.value())},
      {"wilson95_low", format("%.6f", interval.low)},
      {"wilson95_high", format("%.6f", interval.high)}};
  if (min_success) properties.emplace_back("min_success", format("%.6f", *min_success));
  std::string xml = "<properties>\n";
  for (const auto& [name, value] : properties) {
    xml += "<property" + attribute("name", name) + attribute("value", value) + "/>\n";
  }
  return xml + "</properties>\n";
}

/// Empty for a run that succeeded.
std::string verdict_of(const Evaluation& evaluation, const Candidate& candidate, const Run& run,
                       bool tolerated, Counts& counts) {
  const TrialResult& result = run.result;
  const TrialClass kind = classify(result);
  if (kind == TrialClass::kSucceeded) return "";
  if (tolerated) {
    ++counts.skipped;
    return "<skipped" + attribute("message", result.ending + ": " + result.reason) + "/>";
  }
  const bool no_run = result.ending == kNoWorld || result.ending == kNoPhysics;
  ++(no_run ? counts.errors : counts.failures);
  const std::string element = no_run ? "error" : "failure";
  const std::string type = kind == TrialClass::kDoneButWrong ? to_string(kind) : result.ending;
  return "<" + element + attribute("message", result.reason) + attribute("type", type) + ">" +
         in_xml(out_text(evaluation.task, run.trial.distance) + tilt_text(run.trial) +
                "; made again by\n" + replay_command(evaluation, candidate, run.trial.number)) +
         "</" + element + ">";
}

std::string suite_of(const Evaluation& evaluation, const Candidate& candidate,
                     std::optional<double> min_success, Counts& all) {
  const Rate success = summarise(evaluation.task, candidate).success;
  const bool tolerated = min_success && success.value() >= *min_success;
  const std::string stem = std::filesystem::path(candidate.file).stem();
  const std::string where = attribute("classname", evaluation.task.name + "." + stem);
  Counts counts;
  std::string cases;
  for (const auto& [number, run] : candidate.runs) {
    ++counts.tests;
    counts.time_s += run.result.duration_s;
    const std::string verdict = verdict_of(evaluation, candidate, run, tolerated, counts);
    cases += "<testcase" + where + attribute("name", "run " + std::to_string(number)) +
             attribute("time", format("%.3f", run.result.duration_s)) +
             (verdict.empty() ? "/>\n" : ">" + verdict + "</testcase>\n");
  }
  all.tests += counts.tests;
  all.failures += counts.failures;
  all.errors += counts.errors;
  all.time_s += counts.time_s;
  return "<testsuite" + attribute("name", evaluation.task.name + ", " + candidate.file) +
         attributes_of(counts, true) + ">\n" +
         properties_of(evaluation, candidate, success, min_success) + cases + "</testsuite>\n";
}

}  // namespace

std::string evaluation_junit(const Evaluation& evaluation, std::optional<double> min_success) {
  Counts all;
  std::string suites;
  for (const Candidate& candidate : evaluation.candidates) {
    suites += suite_of(evaluation, candidate, min_success, all);
  }
  return "<?xml version='1.0' encoding='UTF-8'?>\n<testsuites" +
         attribute("name", "tenon-evaluate") + attributes_of(all, false) + ">\n" + suites +
         "</testsuites>\n";
}

}  // namespace tenon::sim
