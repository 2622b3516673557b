#include "sim/listener/step_listener.h"

#include <cstdint>
#include <lcm/lcm-cpp.hpp>
#include <utility>

#include "lcmtypes/received/received.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "shared/base/error.h"
#include "shared/system/lcm_url.h"
#include "shared/system/whole_datagrams.h"

namespace tenon::sim {
namespace {

constexpr const char* kCycleChannel = "TENON_CYCLE";  // executor/README.md

// With the bytes as they came: LCM's own decoding lets what is malformed throw through its C code.
void take_step(const lcm::ReceiveBuffer* buffer, const std::string& /*channel*/,
               std::function<void(int)>* took) {
  const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
  const auto cycle = decoded<cycle_state_t>({bytes, buffer->data_size});
  if (cycle && cycle->step >= 0) (*took)(cycle->step);
}

}  // namespace

StepListener::StepListener(const std::string& url, std::function<void(int)> took)
    : took_(std::move(took)) {
  check_lcm_url(url);
  check_lcm_log(url);
  if (!has_multicast_route(url)) {
    throw InputError("--lcm-url " + url + ": no multicast route; " + kSetMulticastRoute);
  }
  lcm_ = std::make_unique<lcm::LCM>(url);
  if (!lcm_->good()) throw InputError("--lcm-url " + url + ": cannot be opened");
  lcm_->subscribeFunction(kCycleChannel, &take_step, &took_);
  take_whole_datagrams_only();
}

StepListener::~StepListener() = default;

void StepListener::listen() {
  while (lcm_->handleTimeout(0) > 0) {
  }
}

}  // namespace tenon::sim
