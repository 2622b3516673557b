#pragma once
// Carries cycle records from the real-time thread to everything that writes or publishes: a ring,
// and a thread that empties it. record() is real-time and belongs to the control loop; the rest is
// not. A full ring drops records and counts them.

#include <atomic>
#include <thread>
#include <vector>

#include "executor/record/cycle_sink.h"
#include "shared/base/spsc_ring.h"

namespace tenon::executor {

/// Gets every record in order, on the recorder's thread. Must not throw.
class RecordConsumer {
 public:
  RecordConsumer() = default;
  RecordConsumer(const RecordConsumer&) = delete;
  RecordConsumer& operator=(const RecordConsumer&) = delete;
  virtual ~RecordConsumer() = default;
  virtual void consume(const CycleRecord& record) = 0;
};

/// Large (about 4 MB): keep it on the heap.
class Recorder : public CycleSink {
 public:
  Recorder() = default;
  ~Recorder() override { stop(); }

  /// Before start(). The consumer must outlive stop().
  void add(RecordConsumer& consumer) { consumers_.push_back(&consumer); }

  /// Starts the thread. Without it the caller empties the ring by drain().
  void start();
  /// Empties the ring for the last time and ends the thread.
  void stop();
  void drain();

  void record(const CycleRecord& record) noexcept override { (void)ring_.push(record); }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return ring_.dropped(); }

 private:
  static constexpr std::size_t kCapacity = 4096;
  SpscRing<CycleRecord, kCapacity> ring_;
  std::vector<RecordConsumer*> consumers_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace tenon::executor
