#include "planner/belief/remembered_rollout.h"

#include <array>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "shared/base/fnv.h"

namespace tenon::planner {
namespace {

// Some 50 MB, in two halves: when one is full, the other is forgotten, which is the older.
constexpr std::size_t kHalf = 50'000;

bool same(const MoveParameters& a, const MoveParameters& b) {
  const auto from = [](const MoveParameters& move) {
    return move.carried_from ? move.carried_from->coeffs() : Eigen::Vector4d::Zero().eval();
  };
  const auto rest = [](const MoveParameters& move) {
    return std::tie(move.slow_from_m, move.speeds, move.thresholds, move.compliance,
                    move.force_limit_N, move.torque_limit_Nm, move.timeout_us, move.trigger_mask,
                    move.sensed_axes, move.aligns);
  };
  return a.displacement == b.displacement && rest(a) == rest(b) && from(a) == from(b);
}

}  // namespace

class RememberedRollout::Memory {
 public:
  struct Question {
    Particle particle;
    MoveParameters move;
    std::int64_t step_us = 0;

    friend bool operator==(const Question& a, const Question& b) {
      return a.particle == b.particle && same(a.move, b.move) && a.step_us == b.step_us;
    }
  };

  /// By what mostly tells questions apart.
  struct QuestionHash {
    std::size_t operator()(const Question& question) const {
      const Particle& particle = question.particle;
      const std::array<double, 26> values = {particle.pose.position_m.x(),
                                             particle.pose.position_m.y(),
                                             particle.pose.position_m.z(),
                                             particle.pose.orientation.x(),
                                             particle.pose.orientation.y(),
                                             particle.pose.orientation.z(),
                                             particle.environment.position_m.x(),
                                             particle.environment.position_m.y(),
                                             particle.environment.position_m.z(),
                                             particle.environment.orientation.x(),
                                             particle.environment.orientation.y(),
                                             particle.environment.orientation.z(),
                                             particle.physics.friction,
                                             particle.physics.oversize_m,
                                             particle.physics.latency_s,
                                             particle.physics.sensor_error_m.x(),
                                             particle.physics.sensor_error_m.y(),
                                             particle.physics.sensor_error_m.z(),
                                             question.move.displacement[0],
                                             question.move.displacement[1],
                                             question.move.displacement[2],
                                             question.move.displacement[3],
                                             question.move.displacement[4],
                                             question.move.displacement[5],
                                             question.move.slow_from_m,
                                             static_cast<double>(question.step_us)};
      return fnv1a_64({reinterpret_cast<const char*>(values.data()), sizeof(values)});
    }
  };

  std::optional<RolloutResult> known(const Question& question) {
    const std::lock_guard lock(mutex_);
    for (const auto& half : {&known_, &older_}) {
      const auto found = half->find(question);
      if (found != half->end()) return found->second;
    }
    return std::nullopt;
  }

  void keep(Question question, const RolloutResult& result) {
    const std::lock_guard lock(mutex_);
    if (known_.size() == kHalf) older_ = std::exchange(known_, {});
    known_.emplace(std::move(question), result);
  }

 private:
  using Known = std::unordered_map<Question, RolloutResult, QuestionHash>;
  std::mutex mutex_;
  Known known_;
  Known older_;
};

RememberedRollout::RememberedRollout(const Rollout& rollout)
    : RememberedRollout(rollout, std::make_shared<Memory>()) {}

RememberedRollout::RememberedRollout(const Rollout& rollout, std::shared_ptr<Memory> memory)
    : rollout_(rollout.clone()), memory_(std::move(memory)) {}

RememberedRollout::~RememberedRollout() = default;

RolloutResult RememberedRollout::simulate(const Particle& particle, const MoveParameters& move,
                                          std::int64_t step_us, std::vector<TraceSample>* trace) {
  if (trace != nullptr) return rollout_->simulate(particle, move, step_us, trace);
  Memory::Question question{particle, move, step_us};
  if (auto known = memory_->known(question)) return *std::move(known);
  RolloutResult result = rollout_->simulate(particle, move, step_us, nullptr);
  memory_->keep(std::move(question), result);
  return result;
}

bool RememberedRollout::in_collision(const Pose& tool_pose) {
  return rollout_->in_collision(tool_pose);
}

std::unique_ptr<Rollout> RememberedRollout::clone() const {
  return std::unique_ptr<Rollout>(new RememberedRollout(*rollout_, memory_));
}

}  // namespace tenon::planner
