#pragma once
// One identification from its option to its finding: which motion, and what came of it. tenon-exec
// runs the motion. Set-up code; allocates.

#include <memory>
#include <string>

#include "executor/identification/finding.h"
#include "executor/identification/identification_motion.h"
#include "executor/identification/identify_contact_motion.h"
#include "executor/identification/identify_friction_motion.h"
#include "executor/identification/identify_payload_motion.h"
#include "shared/cell/cell.h"

namespace tenon::executor {

class Identification {
 public:
  virtual ~Identification() = default;
  Identification() = default;
  Identification(const Identification&) = delete;
  Identification& operator=(const Identification&) = delete;

  [[nodiscard]] virtual IdentificationMotion& motion() = 0;
  /// Once the motion has ended with kMeasured.
  [[nodiscard]] virtual Finding finding() const = 0;
};

/// @throws InputError for a cell without joint_torque
[[nodiscard]] std::unique_ptr<Identification> make_friction_identification(const Cell& cell);

[[nodiscard]] std::unique_ptr<Identification> make_payload_identification(const Cell& cell);

/// @param direction x, +x or -x, likewise y and z: the way to the contact, in the task frame
/// @throws InputError for any other
[[nodiscard]] std::unique_ptr<Identification> make_contact_identification(
    const Cell& cell, const std::string& direction);

}  // namespace tenon::executor
