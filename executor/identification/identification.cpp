#include "executor/identification/identification.h"

#include "shared/base/error.h"

namespace tenon::executor {
namespace {

class PayloadIdentificationRun : public Identification {
 public:
  explicit PayloadIdentificationRun(const Cell& cell) : motion_(cell, {}) {}
  IdentificationMotion& motion() override { return motion_; }
  [[nodiscard]] Finding finding() const override {
    return finding_of(identify_payload(motion_.readings()));
  }

 private:
  IdentifyPayloadMotion motion_;
};

class ContactIdentificationRun : public Identification {
 public:
  ContactIdentificationRun(const Cell& cell, const IdentifyContactMotion::Parameters& parameters)
      : motion_(cell, parameters) {}
  IdentificationMotion& motion() override { return motion_; }
  [[nodiscard]] Finding finding() const override {
    return finding_of(identify_contact(motion_.samples(), motion_.cycle_s()));
  }

 private:
  IdentifyContactMotion motion_;
};

class FrictionIdentificationRun : public Identification {
 public:
  explicit FrictionIdentificationRun(const Cell& cell) : motion_(cell, {}) {}
  IdentificationMotion& motion() override { return motion_; }
  [[nodiscard]] Finding finding() const override {
    const Robot& robot = motion_.cell().robot;
    return finding_of(robot, identify_friction(robot, motion_.samples()));
  }

 private:
  IdentifyFrictionMotion motion_;
};

}  // namespace

std::unique_ptr<Identification> make_friction_identification(const Cell& cell) {
  return std::make_unique<FrictionIdentificationRun>(cell);
}

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
