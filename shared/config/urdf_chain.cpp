#include "shared/config/urdf_chain.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <exception>
#include <string>

#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/config/files.h"
#include "shared/config/xml_extent.h"
#include "shared/ports/arm.h"

namespace tenon::config {
namespace {

constexpr double kTravelMax = 100.0;  // m or rad
constexpr double kSpeedMax = 100.0;
constexpr double kEffortMax = 1e5;
constexpr double kMassMax_kg = 1e3;
// The parser descends by recursion, and looks for each attribute among all others of its tag.
constexpr std::size_t kNestingMax = 64;
constexpr std::size_t kTagMax_bytes = 4096;
constexpr std::size_t kUrdfMax_bytes = 1U << 20U;

/// The parser reports to a global console instead of its caller, and goes on after some errors: the
/// first is the cause.
class FirstError final : public console_bridge::OutputHandler {
 public:
  FirstError() { console_bridge::useOutputHandler(this); }
  FirstError(const FirstError&) = delete;
  FirstError& operator=(const FirstError&) = delete;
  ~FirstError() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level == console_bridge::CONSOLE_BRIDGE_LOG_ERROR && text_.empty()) text_ = text;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

urdf::ModelInterfaceSharedPtr parse(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  if (text.size() > kUrdfMax_bytes) {
    throw InputError(file.string() + format(": is %zu bytes long, must be at most %zu", text.size(),
                                            kUrdfMax_bytes));
  }
  const XmlExtent extent = xml_extent(text);
  if (extent.depth > kNestingMax) {
    throw InputError(file.string() + format(": has elements %zu deep in each other, must be at "
                                            "most %zu",
                                            extent.depth, kNestingMax));
  }
  if (extent.tag_bytes > kTagMax_bytes) {
    throw InputError(file.string() + format(": has a tag of %zu bytes, must be at most %zu",
                                            extent.tag_bytes, kTagMax_bytes));
  }
  const FirstError error;
  std::string what;
  try {
    urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
    if (model && error.text().empty()) return model;
    what = error.text();
  } catch (const std::exception& exception) {
    what = exception.what();
  }
  throw InputError(file.string() + ": is not URDF: " + what);
}

Pose pose_of(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {{pose.position.x, pose.position.y, pose.position.z},
          Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized()};
}

/// Both as one rigid body, in the same frame.
LinkInertia combined(const LinkInertia& a, const LinkInertia& b) {
  LinkInertia both;
  both.mass_kg = a.mass_kg + b.mass_kg;
  both.com_m = (a.mass_kg * a.com_m + b.mass_kg * b.com_m) / both.mass_kg;
  for (const LinkInertia* part : {&a, &b}) {
    const Vector3 off_m = part->com_m - both.com_m;
    both.inertia_kgm2 +=
        part->inertia_kgm2 + part->mass_kg * (off_m.squaredNorm() * Eigen::Matrix3d::Identity() -
                                              off_m * off_m.transpose());
  }
  return both;
}

/// Walks from the root to the last link.
class ChainReader {
 public:
  explicit ChainReader(const std::filesystem::path& file) : file_(file), model_(parse(file)) {}

  UrdfChain read() {
    const urdf::Link* link = model_->getRoot().get();
    while (!link->child_joints.empty()) {
      if (link->child_joints.size() > 1) {
        refuse("link", link->name,
               "branches into joints \"" + link->child_joints[0]->name + "\" and \"" +
                   link->child_joints[1]->name + "\", must be one chain from base to flange");
      }
      const urdf::Joint& joint = *link->child_joints.front();
      link = model_->getLink(joint.child_link_name).get();
      take(joint, *link);
    }
    if (chain_.joints.empty() || chain_.joints.size() > kMaxJoints) {
      throw InputError(file_.string() +
                       format(": has %u revolute and prismatic joints, must have 1 to %u",
                              static_cast<unsigned>(chain_.joints.size()),
                              static_cast<unsigned>(kMaxJoints)));
    }
    chain_.flange = X_ML_;
    return chain_;
  }

 private:
  [[noreturn]] void refuse(const char* element, const std::string& name,
                           const std::string& what) const {
    throw InputError(file_.string() + ": " + element + " \"" + name + "\": " + what);
  }

  void take(const urdf::Joint& joint, const urdf::Link& link) {
    X_ML_ = compose(X_ML_, pose_of(joint.parent_to_joint_origin_transform));
    switch (joint.type) {
      case urdf::Joint::FIXED:
        if (link.inertial && !chain_.joints.empty()) {
          LinkInertia& moving = chain_.joints.back().link;
          moving = combined(moving, inertia_of(link));
        }
        return;
      case urdf::Joint::REVOLUTE:
        return take_moving(joint, link, Joint::Kind::kRevolute);
      case urdf::Joint::PRISMATIC:
        return take_moving(joint, link, Joint::Kind::kPrismatic);
      case urdf::Joint::CONTINUOUS:
      case urdf::Joint::FLOATING:
      case urdf::Joint::PLANAR:
      case urdf::Joint::UNKNOWN:
        refuse("joint", joint.name,
               "its type must be revolute or prismatic (with limits) or fixed");
    }
  }

  void take_moving(const urdf::Joint& joint, const urdf::Link& link, Joint::Kind kind) {
    Joint moving;
    moving.name = joint.name;
    moving.kind = kind;
    moving.origin = X_ML_;
    X_ML_ = {};
    moving.axis = {joint.axis.x, joint.axis.y, joint.axis.z};
    if (std::abs(moving.axis.norm() - 1.0) > 1e-6) {
      refuse("joint", joint.name, format("axis of length %g, must be 1", moving.axis.norm()));
    }
    moving.axis.normalize();
    if (joint.mimic) {
      refuse("joint", joint.name,
             "mimics joint \"" + joint.mimic->joint_name + "\", must move by itself");
    }
    take_limits(joint, moving);
    if (!link.inertial) refuse("link", link.name, "has no <inertial>: every moving link needs one");
    moving.link = inertia_of(link);
    chain_.joints.push_back(moving);
  }

  void take_limits(const urdf::Joint& joint, Joint& moving) const {
    // The parser sees to it that revolute and prismatic joints have them.
    const urdf::JointLimits& limits = *joint.limits;
    const auto check = [&](const char* key, double value, double above, double most) {
      if (value > above && value <= most) return;
      refuse("joint", joint.name,
             format("limit %s = %g, must be in (%g, %g]", key, value, above, most));
    };
    check("lower", limits.lower, -kTravelMax, kTravelMax);
    check("upper", limits.upper, limits.lower, kTravelMax);
    check("velocity", limits.velocity, 0.0, kSpeedMax);
    check("effort", limits.effort, 0.0, kEffortMax);
    moving.lower = limits.lower;
    moving.upper = limits.upper;
    moving.speed_max = limits.velocity;
    moving.effort_max = limits.effort;
  }

  /// In the frame of the moving link that carries it.
  [[nodiscard]] LinkInertia inertia_of(const urdf::Link& link) const {
    const urdf::Inertial& in = *link.inertial;
    if (!(in.mass > 0.0 && in.mass <= kMassMax_kg)) {
      refuse("link", link.name, format("mass %g kg, must be in (0, %g]", in.mass, kMassMax_kg));
    }
    Eigen::Matrix3d tensor;
    tensor << in.ixx, in.ixy, in.ixz, in.ixy, in.iyy, in.iyz, in.ixz, in.iyz, in.izz;
    const Vector3 principal = tensor.selfadjointView<Eigen::Lower>().eigenvalues();  // ascending
    if (!(principal[0] > 0.0)) {
      refuse("link", link.name,
             format("inertia has the principal moments %g, %g, %g kg m^2, all must be positive",
                    principal[0], principal[1], principal[2]));
    }
    // A file has few digits: a thin plate, where both sides are equal, is none too many.
    constexpr double kRounding = 1.0 + 1e-3;
    if (principal[2] > (principal[0] + principal[1]) * kRounding) {
      refuse("link", link.name,
             format("inertia has the principal moments %g, %g, %g kg m^2, none may exceed the sum "
                    "of the other two",
                    principal[0], principal[1], principal[2]));
    }
    const Pose X_MI = compose(X_ML_, pose_of(in.origin));
    const Eigen::Matrix3d R_MI = X_MI.orientation.toRotationMatrix();
    return {in.mass, X_MI.position_m, R_MI * tensor * R_MI.transpose()};
  }

  std::filesystem::path file_;
  urdf::ModelInterfaceSharedPtr model_;
  UrdfChain chain_;
  Pose X_ML_;  ///< the link that was read last, in the last moving link (at first the root)
};

}  // namespace

UrdfChain read_urdf(const std::filesystem::path& file) { return ChainReader(file).read(); }

}  // namespace tenon::config
