#include "executor/telemetry/recorder.h"

#include "shared/system/monotonic_clock.h"

namespace tenon::executor {
namespace {

constexpr std::int64_t kPeriod_ns = 5'000'000;

}  // namespace

void Recorder::start() {
  thread_ = std::thread([this] {
    while (!stop_.load(std::memory_order_acquire)) {
      drain();
      wait_until_ns(monotonic_now_ns() + kPeriod_ns);
    }
  });
}

void Recorder::stop() {
  stop_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
  drain();
}

void Recorder::drain() {
  CycleRecord record;
  while (ring_.pop(record)) {
    for (RecordConsumer* consumer : consumers_) consumer->consume(record);
  }
}

}  // namespace tenon::executor
