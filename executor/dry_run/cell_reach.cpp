#include "executor/dry_run/cell_reach.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/movable_axes.h"
#include "executor/dry_run/path_follower.h"
#include "executor/dry_run/plan_reach.h"
#include "executor/dry_run/start_positions.h"
#include "executor/dry_run/step_walk.h"
#include "executor/motion/tool_kinematics.h"

namespace tenon::executor {

/// What all places of one arm share.
struct CellReach::Arm {
  explicit Arm(Cell of) : cell(std::move(of)), kinematics(cell) {}

  [[nodiscard]] bool inside_limits(const JointVector& joints) const {
    for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
      const Joint& joint = cell.robot.joints[i];
      if (joints[i] < joint.lower + kJointMargin || joints[i] > joint.upper - kJointMargin)
        return false;
    }
    return true;
  }

  Cell cell;
  ToolKinematics kinematics;
};

/// And all places of one plan.
struct CellReach::Of {
  std::shared_ptr<const Arm> arm;
  Plan draft;                     ///< with envelopes; without steps
  std::vector<JointVector> held;  ///< all joint positions at its start
};

/// A box of displacements from the plan's start, and joints at its middle: of each of the arm's
/// ways to hold the tool, as far as they have been asked for.
class CellReach::Place : public ArmPlace, public std::enable_shared_from_this<Place> {
 public:
  Place(std::shared_ptr<const Of> of, ReachBox box) : of_(std::move(of)), box_(std::move(box)) {}

  [[nodiscard]] std::shared_ptr<const ArmPlace> after(const Step& step, ContactSignature contacts,
                                                      std::string& why) const override;
  [[nodiscard]] std::shared_ptr<const ArmPlace> elsewhere(const Pose& tool,
                                                          std::string& why) const override;

  [[nodiscard]] virtual std::size_t branches() const = 0;
  /// @return null where the arm does not come here in that way; why says the first reason
  [[nodiscard]] virtual const JointVector* joints(std::size_t branch, std::string& why) const = 0;
  [[nodiscard]] const ReachBox& box() const { return box_; }

 protected:
  [[nodiscard]] const Of& of() const { return *of_; }

 private:
  std::shared_ptr<const Of> of_;
  ReachBox box_;
};

class CellReach::Root final : public Place {
 public:
  Root(std::shared_ptr<const Of> of, const Vector6& at, std::vector<JointVector> held)
      : Place(std::move(of), {at, at}), held_(std::move(held)) {}

  [[nodiscard]] std::size_t branches() const override { return held_.size(); }
  [[nodiscard]] const JointVector* joints(std::size_t branch, std::string& /*why*/) const override {
    return &held_[branch];
  }

 private:
  std::vector<JointVector> held_;
};

class CellReach::Stepped final : public Place {
 public:
  Stepped(std::shared_ptr<const Of> of, const ReachBox& box, std::shared_ptr<const Place> from,
          const Step& step, ContactSignature contacts)
      : Place(std::move(of), box), from_(std::move(from)), step_(step), contacts_(contacts) {}

  [[nodiscard]] std::size_t branches() const override { return from_->branches(); }

  [[nodiscard]] const JointVector* joints(std::size_t branch, std::string& why) const override {
    while (walked_.size() <= branch) walked_.push_back(walk(walked_.size(), why));
    return walked_[branch] ? &*walked_[branch] : nullptr;
  }

 private:
  [[nodiscard]] std::optional<JointVector> walk(std::size_t branch, std::string& why) const {
    const JointVector* begin = from_->joints(branch, why);
    if (begin == nullptr) return std::nullopt;
    const StepReach reach = reach_from(from_->box(), contacts_, of().draft, step_);
    Plan plan = of().draft;
    plan.steps = {step_};
    StepWalk walk(plan, 0, reach, of().arm->cell, of().arm->kinematics);
    const auto refusal = walk.run(*begin);
    if (refusal) {
      if (why.empty()) why = *refusal;
      return std::nullopt;
    }
    JointVector end = walk.end(0);
    PathFollower follower(of().arm->kinematics, plan.start);
    const bool there = follower.follow(reach.ends.front().box.centre(), box().centre(), end,
                                       [](const JointVector& /*joints*/) {});
    return there ? std::optional(end) : std::nullopt;
  }

  std::shared_ptr<const Place> from_;
  Step step_;
  ContactSignature contacts_;
  mutable std::vector<std::optional<JointVector>> walked_;  ///< by branch
};

std::shared_ptr<const ArmPlace> CellReach::Place::after(const Step& step, ContactSignature contacts,
                                                        std::string& why) const {
  const StepReach reach = reach_from(box_, contacts, of_->draft, step);
  if (reach.ends.empty()) {
    why = "the step has no way on";
    return nullptr;
  }
  ReachBox box = reach.ends.front().box;
  for (const StepReach::End& end : reach.ends) box.include(end.box);
  auto place = std::make_shared<Stepped>(of_, box, shared_from_this(), step, contacts);
  why.clear();
  for (std::size_t branch = 0; branch < place->branches(); ++branch) {
    if (place->joints(branch, why) != nullptr) return place;
  }
  return nullptr;
}

std::shared_ptr<const ArmPlace> CellReach::Place::elsewhere(const Pose& tool,
                                                            std::string& why) const {
  const Vector6 at = displacement_between(of_->draft.start, tool);
  PathFollower follower(of_->arm->kinematics, of_->draft.start);
  std::vector<JointVector> held;
  for (JointVector joints : of_->held) {
    const bool there =
        follower.follow(Vector6::Zero(), at, joints, [](const JointVector& /*joints*/) {});
    if (there && of_->arm->inside_limits(joints)) held.push_back(joints);
  }
  if (held.empty()) {
    StartPositions found = start_positions(tool, of_->arm->cell, of_->arm->kinematics);
    held = std::move(found.found);
    why = std::move(found.refusal);
  }
  return held.empty() ? nullptr : std::make_shared<Root>(of_, at, std::move(held));
}

CellReach::CellReach(Cell cell) : arm_(std::make_shared<Arm>(std::move(cell))) {}
CellReach::~CellReach() = default;

std::shared_ptr<const ArmPlace> CellReach::start(const Plan& draft, std::string& why) const {
  StartPositions found = start_positions(draft.start, arm_->cell, arm_->kinematics);
  why = std::move(found.refusal);
  if (found.found.empty()) return nullptr;
  const std::vector<std::string> axes = check_axes(draft, arm_->kinematics, found.found.front());
  if (!axes.empty()) {
    why = axes.front();
    return nullptr;
  }
  auto of = std::make_shared<Of>(Of{arm_, draft, found.found});
  of->draft.steps.clear();
  of->draft.check_envelopes = true;
  return std::make_shared<Root>(std::move(of), Vector6::Zero(), std::move(found.found));
}

std::optional<ArmReach::Refusal> CellReach::refusal(const Plan& plan) const {
  const DryRun run = dry_run(plan, arm_->cell);
  if (run.refusals.empty()) return std::nullopt;
  return Refusal{run.steps.empty() ? 0 : run.steps.back().step, run.refusals.front()};
}

}  // namespace tenon::executor
