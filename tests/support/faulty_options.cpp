#include "tests/support/faulty_options.h"

#include "sim/cell/faults/fault_spec.h"

namespace tenon::tests {

WholeRun::Options with_faults(const std::vector<std::string>& specs) {
  WholeRun::Options options;
  options.start = std::string("1");  // moved in: GCC 12 warns of an assigned literal falsely
  options.offset[0] = 0.01;
  options.offset[1] = -0.01;
  for (const std::string& spec : specs) options.faults.push_back(sim::parse_fault(spec));
  return options;
}

}  // namespace tenon::tests
