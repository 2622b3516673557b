#include "sim/evaluation/evaluation.h"

#include "shared/base/error.h"

namespace tenon::sim {

void check_bins(const Evaluation& evaluation, std::size_t count) {
  for (const Bins& bins : evaluation.by) {
    bool any = false;
    for (std::size_t number = 0; number < count && !any; ++number) {
      any = bins.bin_of(evaluation.trial(0, number)).has_value();
    }
    if (!any) {
      throw InputError("--by " + bins.quantity +
                       ": no draw of the experiment falls in the given range");
    }
  }
}

}  // namespace tenon::sim
