#include "hw/can/socketcan_errors.h"

#include <linux/can.h>
#include <linux/can/error.h>

namespace tenon::hw {

void apply_error_frame(std::uint32_t error_class, const std::array<std::uint8_t, 8>& data,
                       CanBusStatus& status) noexcept {
  ++status.error_frames;
  if ((error_class & CAN_ERR_BUSOFF) != 0) {
    status.bus_off = true;
  }
  if ((error_class & CAN_ERR_RESTARTED) != 0) {
    status.bus_off = false;
    status.error_passive = false;
  }
  if ((error_class & CAN_ERR_CRTL) != 0) {
    const unsigned controller = data[1];
    if ((controller & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) != 0) {
      ++status.overruns;
    }
    // Active and warning are both below passive.
    if ((controller & (CAN_ERR_CRTL_ACTIVE | CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) !=
        0) {
      status.error_passive = false;
    }
    if ((controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
      status.error_passive = true;
    }
  }
}

}  // namespace tenon::hw
