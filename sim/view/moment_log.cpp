#include "sim/view/moment_log.h"

#include <chrono>
#include <utility>

#include "shared/base/text.h"

namespace tenon::sim {
namespace {

constexpr double kPathStep_m = 2e-4;

}  // namespace

std::string stream_event(const char* name, const std::string& data) {
  const std::string head = *name == '\0' ? std::string() : std::string("event: ") + name + "\n";
  return head + "data: " + data + "\n\n";
}

void MomentLog::add(const std::string& json, const Vector3& position_m) {
  const std::lock_guard lock(mutex_);
  remember(position_m);
  append(stream_event("", json));
}

void MomentLog::end(const std::string& json) {
  const std::lock_guard lock(mutex_);
  append(stream_event("end", json));
  ended_ = true;
}

void MomentLog::append(std::string event) {
  events_[added_ % kKept] = std::move(event);
  ++added_;
  changed_.notify_all();
}

/// Where it has moved; a path that grows too long loses every other point.
void MomentLog::remember(const Vector3& position_m) {
  if (!path_m_.empty() && (position_m - path_m_.back()).norm() < kPathStep_m) return;
  if (path_m_.size() == kPathMax) {
    for (std::size_t i = 0; 2 * i < kPathMax; ++i) path_m_[i] = path_m_[2 * i];
    path_m_.resize(kPathMax / 2);
  }
  path_m_.push_back(position_m);
}

void MomentLog::join() {
  const std::lock_guard lock(mutex_);
  ++present_;
  ++counts_.viewers;
}

void MomentLog::leave() {
  const std::lock_guard lock(mutex_);
  --present_;
  changed_.notify_all();
}

std::size_t MomentLog::present() const {
  const std::lock_guard lock(mutex_);
  return present_;
}

std::string MomentLog::greeting() const {
  std::string path;
  for (const Vector3& p : path_m_) {
    path += format("%s%.5f,%.5f,%.5f", path.empty() ? "" : ",", p.x(), p.y(), p.z());
  }
  return "retry: 1000\n" +
         stream_event("path", R"({"run_id":")" + run_id_ + R"(","path":[)" + path + "]}");
}

bool MomentLog::take(Viewer& viewer, std::string& text) {
  std::unique_lock lock(mutex_);
  if (!viewer.greeted) {
    viewer.greeted = true;
    // What is under way now comes next: the newest event, or the one after it.
    viewer.next = added_ == 0 ? 0 : added_ - 1;
    text = greeting();
    return true;
  }
  changed_.wait(lock, [&] { return ended_ || viewer.next < added_; });
  if (viewer.next == added_) return false;
  if (added_ - viewer.next > kKept) {
    counts_.dropped += added_ - 1 - viewer.next;
    viewer.next = added_ - 1;
  }
  text = events_[viewer.next % kKept];
  ++viewer.next;
  ++counts_.taken;
  return true;
}

void MomentLog::wait_for_empty(std::int64_t at_most_ns) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::nanoseconds(at_most_ns), [&] { return present_ == 0; });
}

MomentLog::Counts MomentLog::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace tenon::sim
