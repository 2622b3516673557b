#pragma once
// The drawn quantities that success may be broken down by. Pure.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/statistics.h"
#include "sim/evaluation/trial.h"

namespace tenon::sim {

/// Bins of equal width of one drawn quantity. Of a quantity with several axes it is the norm.
struct Bins {
  std::string quantity;
  double low = 0.0;
  double high = 0.0;
  std::size_t count = 1;

  /// From its lower edge up to its upper one; that of the last one belongs to it.
  [[nodiscard]] Interval edges(std::size_t bin) const;
  /// Unset: outside of all, or not drawn.
  [[nodiscard]] std::optional<std::size_t> bin_of(const Trial& trial) const;
};

/// "friction=0.1:0.8:7": from 0.1 to 0.8 in 7 bins. @throws InputError for anything else
[[nodiscard]] Bins parse_bins(const std::string& text);

/// The names that parse_bins() knows.
[[nodiscard]] std::vector<std::string> quantity_names();

}  // namespace tenon::sim
