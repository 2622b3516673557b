#include "sim/view/live_view.h"

#include <nlohmann/json.hpp>

#include "shared/base/text.h"
#include "shared/system/monotonic_clock.h"
#include "sim/view/loopback.h"

namespace tenon::sim {
namespace {

constexpr std::int64_t kParting_ns = 500'000'000;

std::string ending_json(const Truth& truth) {
  return nlohmann::ordered_json{{"time_s", truth.time_s},
                                {"error_m", truth.error_norm_m},
                                {"error_rad", truth.error_norm_rad},
                                {"within_tolerance", truth.within_tolerance},
                                {"contact_force_N_max", truth.contact_force_N_max},
                                {"faults", truth.faults}}
      .dump();
}

}  // namespace

LiveView::LiveView(std::uint16_t port, const ViewedWorld& world)
    : X_BT_(world.X_BT),
      log_(world.run_id),
      server_(listen_on_loopback(port), view_page(world), log_) {
  thread_ = std::thread([this] {
    while (!stop_.load(std::memory_order_acquire)) {
      pass_on();
      wait_until_ns(monotonic_now_ns() + kPeriod_ns / 2);
    }
  });
}

LiveView::~LiveView() {
  if (thread_.joinable()) {
    stop();
    log_.end("{}");
  }
}

std::string LiveView::url() const {
  return "http://127.0.0.1:" + std::to_string(server_.port()) + "/";
}

void LiveView::look(VirtualCell& cell, std::int64_t now_ns) noexcept {
  if (now_ns < due_ns_) return;
  due_ns_ = now_ns + kPeriod_ns;
  static_cast<void>(ring_.push(cell.moment()));
}

void LiveView::pass_on() {
  CellMoment moment;
  while (ring_.pop(moment)) {
    log_.add(moment_json(moment, X_BT_, ring_.dropped()), position_m(moment, X_BT_));
  }
}

void LiveView::stop() {
  stop_.store(true, std::memory_order_release);
  thread_.join();
  pass_on();
}

void LiveView::end(const Truth& truth) {
  stop();
  log_.end(ending_json(truth));
  log_.wait_for_empty(kParting_ns);
}

std::string LiveView::describe() const {
  const MomentLog::Counts counts = log_.counts();
  return format("view: %llu looked on; %llu moments sent, %llu dropped\n",
                static_cast<unsigned long long>(counts.viewers),
                static_cast<unsigned long long>(counts.taken),
                static_cast<unsigned long long>(counts.dropped + ring_.dropped()));
}

}  // namespace tenon::sim
