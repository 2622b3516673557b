#include "sim/evaluation/summary.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/task/spread.h"

namespace tenon::sim {
namespace {

Quantiles quantiles(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.95), quantile(values, 0.99),
          quantile(values, 1.0)};
}

int dimensions(const Start& start) { return static_cast<int>((start.sigma.array() > 0.0).count()); }

std::string text_of(const Rate& rate) {
  const Interval interval = rate.interval();
  return format("%zu of %zu = %.2f %% [%.2f, %.2f]", rate.successes, rate.count, 1e2 * rate.value(),
                1e2 * interval.low, 1e2 * interval.high);
}

/// A line for each axis, and one for the distance. One run has no deviation.
std::string errors_text(const Summary& summary) {
  if (summary.done == 0) return "  no run was done: there is no end to tell of\n";
  std::string text;
  for (const AxisError& error : summary.errors) {
    const int axis = error.axis;
    const char* unit = axis < 3 ? "mm" : "deg";
    text += format("  %s: off by ", axis_name(axis));
    if (summary.done == 1) {
      text += format("%.3f at first, then %.3f %s\n", shown(error.initial.mean, axis),
                     shown(error.final.mean, axis), unit);
      continue;
    }
    text += format("%.3f at first, then %.3f on average with deviation %.4f %s",
                   shown(error.initial.deviation, axis), shown(error.final.mean, axis),
                   shown(error.final.deviation, axis), unit);
    const std::string ratio = ratio_text(error);
    text += ratio.empty() ? "\n" : " (" + ratio + ")\n";
  }
  return text + format("  distance from the goal where done: mean %.3f, p99 %.3f, max %.3f mm\n",
                       1e3 * summary.error_norm_m.mean, 1e3 * summary.error_norms_m.p99,
                       1e3 * summary.error_norms_m.max);
}

std::string describe(const Task& task, const Candidate& candidate) {
  const Summary s = summarise(task, candidate);
  std::string text = candidate.file + " (" + to_string(candidate.plan.method) + ", start " +
                     candidate.plan.start_name + ")\n";
  if (!made_for(candidate, task)) text += std::string("  ") + kOtherTask + "\n";
  text += "  succeeded " + text_of(s.success) +
          format("; stopped %zu, done but wrong %zu\n", s.stopped, s.done_but_wrong);
  for (const RateWithin& within : s.within) {
    text += "  " + within_text(task, within.distance) +
            format(" (%.2f %% of all draws) ", 1e2 * within.mass) + text_of(within.rate) + "\n";
  }
  if (s.tilts) {
    text += format("  of these tilted by at most %.2f degrees, as the task has it: ",
                   shown(task.tilt_rad, 3)) +
            text_of(s.promised) + "\n";
  }
  text += errors_text(s);
  if (s.begun == 0) return text;
  text +=
      format("  largest contact force: p50 %.1f, p95 %.1f, p99 %.1f, max %.1f N; %.1f s a run\n",
             s.contact_force_N.p50, s.contact_force_N.p95, s.contact_force_N.p99,
             s.contact_force_N.max, s.duration_s.p50);
  return text;
}

}  // namespace

std::string ratio_text(const AxisError& error) {
  const double ratio = error.ratio();
  if (ratio <= 0.0) return "";
  return ratio < 1.0 ? format("1/%.0f", 1.0 / ratio) : format("%.1f times", ratio);
}

Summary summarise(const Task& task, const Candidate& candidate) {
  Summary summary;
  if (task.errors == Distribution::kUniform) {
    summary.within.push_back({task.particle_sigmas, 1.0, {}});
  } else {
    for (const double distance : std::set<double>{2.0, 3.0, task.particle_sigmas}) {
      summary.within.push_back({distance, mass_within(distance, dimensions(candidate.start)), {}});
    }
  }
  std::array<std::vector<double>, 6> initial;
  std::array<std::vector<double>, 6> final;
  std::vector<double> norms_m;
  std::vector<double> forces_N;
  std::vector<double> durations_s;
  for (const auto& [number, run] : candidate.runs) {
    const TrialResult& result = run.result;
    const TrialClass trial_class = classify(result);
    const bool succeeded = trial_class == TrialClass::kSucceeded;
    ++summary.success.count;
    summary.success.successes += succeeded;
    summary.stopped += trial_class == TrialClass::kStopped;
    summary.done_but_wrong += trial_class == TrialClass::kDoneButWrong;
    ++summary.endings[result.ending];
    for (RateWithin& within : summary.within) {
      if (run.trial.distance > within.distance) continue;
      ++within.rate.count;
      within.rate.successes += succeeded;
    }
    summary.tilts = summary.tilts || run.trial.tilt_rad > 0.0;
    if (within_promise(run.trial, task)) {
      ++summary.promised.count;
      summary.promised.successes += succeeded;
    }
    if (!result.error) continue;
    ++summary.begun;
    forces_N.push_back(result.contact_force_N_max);
    durations_s.push_back(result.duration_s);
    if (!result.done) continue;
    ++summary.done;
    norms_m.push_back(result.error->head<3>().norm());
    for (std::size_t axis = 0; axis < 6; ++axis) {
      initial[axis].push_back(run.trial.offset[static_cast<int>(axis)]);
      final[axis].push_back((*result.error)[static_cast<int>(axis)]);
    }
  }
  for (std::size_t axis = 0; axis < 6; ++axis) {
    if ((task.coordinates >> axis & 1U) == 0) continue;
    summary.errors.push_back(
        {static_cast<int>(axis), moments(final[axis]), moments(initial[axis])});
  }
  summary.error_norm_m = moments(norms_m);
  summary.error_norms_m = quantiles(norms_m);
  summary.contact_force_N = quantiles(forces_N);
  summary.duration_s = quantiles(durations_s);
  return summary;
}

std::vector<std::vector<Rate>> break_down(const std::vector<Bins>& by, const Candidate& candidate) {
  if (by.empty()) return {};
  const std::size_t rows = by.size() > 1 ? by[1].count : 1;
  std::vector<std::vector<Rate>> rates(rows, std::vector<Rate>(by[0].count));
  for (const auto& [number, run] : candidate.runs) {
    const auto column = by[0].bin_of(run.trial);
    const auto row = by.size() > 1 ? by[1].bin_of(run.trial) : std::optional<std::size_t>(0);
    if (!column || !row) continue;
    Rate& rate = rates[*row][*column];
    ++rate.count;
    rate.successes += classify(run.result) == TrialClass::kSucceeded;
  }
  return rates;
}

std::vector<const Run*> failures(const Candidate& candidate) {
  std::vector<const Run*> failed;
  for (const TrialClass wanted : {TrialClass::kDoneButWrong, TrialClass::kStopped}) {
    for (const auto& [number, run] : candidate.runs) {
      if (classify(run.result) == wanted) failed.push_back(&run);
    }
  }
  return failed;
}

std::vector<FailureKind> kinds_of_failure(const Candidate& candidate) {
  std::vector<FailureKind> kinds;
  const auto key = [](const Run& run) {
    const TrialResult& result = run.result;
    return std::tie(result.done, result.ending, result.step, result.outcome);
  };
  for (const Run* run : failures(candidate)) {
    const auto alike = std::find_if(kinds.begin(), kinds.end(), [&](const FailureKind& kind) {
      return key(kind.first()) == key(*run);
    });
    if (alike == kinds.end()) {
      kinds.push_back({{run}, 1});
      continue;
    }
    ++alike->count;
    if (alike->examples.size() < FailureKind::kExamplesMax) alike->examples.push_back(run);
  }
  std::stable_sort(kinds.begin(), kinds.end(), [](const FailureKind& a, const FailureKind& b) {
    return std::pair(a.first().result.done, a.count) > std::pair(b.first().result.done, b.count);
  });
  return kinds;
}

std::vector<const Run*> examples(const Candidate& candidate, std::size_t most) {
  std::vector<const Run*> runs;
  for (const auto& [number, run] : candidate.runs) {
    if (classify(run.result) != TrialClass::kSucceeded) continue;
    runs.push_back(&run);
    break;
  }
  const std::vector<FailureKind> kinds = kinds_of_failure(candidate);
  for (std::size_t i = 0; i < FailureKind::kExamplesMax; ++i) {
    for (const FailureKind& kind : kinds) {
      const bool began = kind.first().result.ending != kNoWorld;
      if (began && i < kind.examples.size() && runs.size() < most) runs.push_back(kind.examples[i]);
    }
  }
  return runs;
}

std::string shortfall(const Evaluation& evaluation, double min_success) {
  std::string text;
  for (const Candidate& candidate : evaluation.candidates) {
    const Rate success = summarise(evaluation.task, candidate).success;
    if (success.value() >= min_success) continue;
    text += (text.empty() ? "" : "; ") + candidate.file +
            format(": %zu of %zu runs succeeded, which is %g and less than %g", success.successes,
                   success.count, success.value(), min_success);
  }
  return text;
}

std::string replay_command(const Evaluation& evaluation, const Candidate& candidate,
                           std::size_t number) {
  return evaluation.replay + " --plan " + shell_word(candidate.file) + " --only " +
         std::to_string(number);
}

std::string describe(const Evaluation& evaluation) {
  constexpr std::size_t kShown = 10;
  std::string text;
  for (const Candidate& candidate : evaluation.candidates) {
    text += describe(evaluation.task, candidate);
    const std::vector<const Run*> failed = failures(candidate);
    for (std::size_t i = 0; i < std::min(failed.size(), kShown); ++i) {
      const TrialResult& result = failed[i]->result;
      text += format("  run %zu, ", failed[i]->trial.number) +
              out_text(evaluation.task, failed[i]->trial.distance) + tilt_text(failed[i]->trial) +
              ", " + to_string(classify(result)) + ": " + result.reason + "\n    " +
              replay_command(evaluation, candidate, failed[i]->trial.number) + "\n";
    }
    if (failed.size() > kShown) {
      text += format("  and %zu more (--json and --report have all)\n", failed.size() - kShown);
    }
  }
  return text;
}

}  // namespace tenon::sim
