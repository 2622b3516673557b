#pragma once
// The last second of cycles, kept in memory and written as CSV after a run that ended badly.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "executor/record/cycle_record.h"

namespace tenon {
struct RecordReport;
}

namespace tenon::executor {

class BlackBox {
 public:
  /// Allocates everything it will ever need. @param cycles >= 1
  explicit BlackBox(std::size_t cycles) : records_(cycles) {}

  /// Real-time.
  void record(const CycleRecord& record) {
    records_[count_ % records_.size()] = record;
    ++count_;
  }

  [[nodiscard]] std::size_t size() const;
  /// @param i 0 is the oldest that is kept
  [[nodiscard]] const CycleRecord& at(std::size_t i) const;

  /// One line a cycle under a line of column names with units. Not for real time; throws nothing
  /// about the file: what was lost stands in the report.
  [[nodiscard]] RecordReport write_csv(const std::filesystem::path& file) const;

 private:
  std::vector<CycleRecord> records_;
  std::size_t count_ = 0;
};

}  // namespace tenon::executor
