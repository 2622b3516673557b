#pragma once
// Where the loop puts the records of its cycles.

#include "executor/record/cycle_record.h"

namespace tenon::executor {

/// Real-time; called from the control loop's thread.
class CycleSink {
 public:
  CycleSink() = default;
  CycleSink(const CycleSink&) = delete;
  CycleSink& operator=(const CycleSink&) = delete;
  virtual ~CycleSink() = default;
  virtual void record(const CycleRecord& record) noexcept = 0;
};

}  // namespace tenon::executor
