#include "hw/canopen/node_scan.h"

#include <algorithm>
#include <span>

#include "hw/canopen/sdo.h"
#include "shared/base/bytes.h"
#include "shared/base/text.h"
#include "shared/canopen/constants.h"

namespace tenon::hw::canopen {
namespace {

constexpr std::uint8_t kAbort = 0x80;
constexpr std::uint32_t kDriveProfile = 402;
constexpr std::uint32_t kInputOutputProfile = 401;
constexpr std::uint32_t kMeasuringProfile = 404;

const char* profile_text(std::uint32_t profile) {
  switch (profile) {
    case kDriveProfile:
      return "CiA 402 drive";
    case kInputOutputProfile:
      return "CiA 401 inputs and outputs";
    case kMeasuringProfile:
      return "CiA 404 measuring device";
    default:
      return "";
  }
}

}  // namespace

void NodeScan::update(std::int64_t now_ns, CanBus& bus) {
  if (asked_ == kNodes || (asked_ > 0 && now_ns < next_ns_)) return;
  ++asked_;
  (void)bus.send(sdo_upload({static_cast<std::uint8_t>(asked_), tenon::canopen::kDeviceType, 0}));
  next_ns_ = now_ns + (asked_ == kNodes ? kHearOut_ns : kPause_ns);
}

bool NodeScan::done(std::int64_t now_ns) const { return asked_ == kNodes && now_ns >= next_ns_; }

// Another master may ask the same devices for other things meanwhile.
void NodeScan::process(const CanFrame& frame) {
  constexpr std::uint32_t kBase = tenon::canopen::kSdoResponse;
  if (frame.extended || frame.remote || frame.length != 8 || frame.id <= kBase ||
      frame.id > kBase + kNodes) {
    return;
  }
  const std::span<const std::uint8_t> bytes(frame.data);
  const bool of_type =
      load_le<std::uint16_t>(bytes.subspan(1)) == tenon::canopen::kDeviceType && bytes[3] == 0;
  if (!of_type) return;
  Found& found = found_[frame.id - kBase];
  ++found.answers;
  if (bytes[0] != kAbort) found.device_type = load_le<std::uint32_t>(bytes.subspan(4));
}

int NodeScan::count() const {
  return static_cast<int>(std::count_if(found_.begin(), found_.end(),
                                        [](const Found& each) { return each.answers > 0; }));
}

bool NodeScan::doubled() const {
  return std::any_of(found_.begin(), found_.end(),
                     [](const Found& each) { return each.answers > 1; });
}

std::string describe(std::uint8_t node, const NodeScan::Found& found,
                     std::optional<std::uint32_t> vendor) {
  std::string text = format("node %3u  ", static_cast<unsigned>(node));
  if (found.device_type) {
    const std::uint32_t profile = *found.device_type & 0xFFFFu;
    const char* known = profile_text(profile);
    text += *known != '\0' ? std::string(known) : format("profile %u", profile);
    text += format(", device type 0x%08X", *found.device_type);
  } else {
    text += "device type refused (1000h)";
  }
  return text + (vendor ? format(", vendor 0x%08X", *vendor) : ", vendor not said (1018h:1)");
}

}  // namespace tenon::hw::canopen
