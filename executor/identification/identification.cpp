#include "executor/identification/identification.h"

#include "shared/base/error.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

class PayloadIdentificationRun : public Identification {
 public:
  explicit PayloadIdentificationRun(const Cell& cell) : motion_(cell, {}) {}
  IdentificationMotion& motion() override { return motion_; }
  [[nodiscard]] std::string report() const override { return describe(result()); }
  [[nodiscard]] bool found() const override {
    return result().status == PayloadIdentification::Status::kIdentified;
  }

 private:
  [[nodiscard]] PayloadIdentification result() const {
    return identify_payload(motion_.readings());
  }
  IdentifyPayloadMotion motion_;
};

class ContactIdentificationRun : public Identification {
 public:
  ContactIdentificationRun(const Cell& cell, const IdentifyContactMotion::Parameters& parameters)
      : parameters_(parameters), cycle_s_(1e-6 * cell.robot.cycle_us), motion_(cell, parameters) {}
  IdentificationMotion& motion() override { return motion_; }
  [[nodiscard]] std::string report() const override {
    if (motion_.met()) return describe(result());
    return format("contact: nothing was met within %g m along %c%s\n", parameters_.reach_m,
                  parameters_.sign > 0 ? '+' : '-', axis_name(parameters_.axis));
  }
  [[nodiscard]] bool found() const override {
    return motion_.met() && result().status == ContactIdentification::Status::kIdentified;
  }

 private:
  [[nodiscard]] ContactIdentification result() const {
    return identify_contact(motion_.samples(), cycle_s_);
  }
  IdentifyContactMotion::Parameters parameters_;
  double cycle_s_;
  IdentifyContactMotion motion_;
};

}  // namespace

std::unique_ptr<Identification> make_payload_identification(const Cell& cell) {
  return std::make_unique<PayloadIdentificationRun>(cell);
}

std::unique_ptr<Identification> make_contact_identification(const Cell& cell,
                                                            const std::string& direction) {
  IdentifyContactMotion::Parameters parameters;
  const bool signed_axis = direction.starts_with('+') || direction.starts_with('-');
  const std::string axis = signed_axis ? direction.substr(1) : direction;
  if (axis != "x" && axis != "y" && axis != "z") {
    throw InputError("--identify-contact = " + direction + ", must be x, y or z, or with + or -");
  }
  parameters.axis = axis[0] - 'x';
  parameters.sign = direction.starts_with('-') ? -1 : 1;
  return std::make_unique<ContactIdentificationRun>(cell, parameters);
}

}  // namespace tenon::executor
