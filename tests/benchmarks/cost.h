#pragma once
// What one call costs: beside the mean the 99th percentile and the worst, which are what a cycle
// has to live with. They are counters of Google Benchmark, in microseconds:
//
//   for (auto _ : state) cost.measure([&] { work(); });
//   cost.report(state);
//
// Each measurement holds one reading of the clock, some 25 ns. On a machine without real-time
// scheduling the worst case is the machine's as much as the code's.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

namespace tenon::bench {

class Cost {
 public:
  /// One call.
  template <typename Work>
  void measure(const Work& work) {
    samples_us_.push_back(0.0);
    extend(work);
  }
  /// More of the last call, where something that does not count lay between.
  template <typename Work>
  void extend(const Work& work) {
    const auto start = Clock::now();
    work();
    const auto end = Clock::now();
    samples_us_.back() += std::chrono::duration<double, std::micro>(end - start).count();
  }

  void report(benchmark::State& state) {
    if (samples_us_.empty()) return;
    std::sort(samples_us_.begin(), samples_us_.end());
    const auto count = samples_us_.size();
    const double sum_us = std::accumulate(samples_us_.begin(), samples_us_.end(), 0.0);
    state.counters["calls"] = static_cast<double>(count);
    state.counters["mean_us"] = sum_us / static_cast<double>(count);
    state.counters["p99_us"] = samples_us_[count * 99 / 100];
    state.counters["max_us"] = samples_us_.back();
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<double> samples_us_;
};

}  // namespace tenon::bench
