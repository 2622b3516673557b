#include "hw/canopen/emergency.h"

namespace tenon::hw::canopen {

const char* emergency_text(std::uint32_t code) {
  switch (code) {
    case tenon::canopen::kEmergencyReset:
      return "no error";
    case tenon::canopen::kEmergencyOverrun:
      return "CAN overrun, frames lost";
    case tenon::canopen::kEmergencyErrorPassive:
      return "CAN error passive";
    case tenon::canopen::kEmergencyHeartbeat:
      return "heartbeat of the master lost";
    case tenon::canopen::kEmergencyBusOffRecovered:
      return "recovered from bus-off";
    case tenon::canopen::kEmergencyPdoLength:
      return "PDO of wrong length";
    case tenon::canopen::kEmergencyRpdoTimeout:
      return "RPDO timeout";
    case tenon::canopen::kEmergencyFollowingError:
      return "following error";
  }
  // Classes by the high byte (CiA 301, table 26).
  switch (code >> 8) {
    case 0x10:
      return "generic error";
    case 0x20:
    case 0x21:
    case 0x22:
    case 0x23:
      return "over-current";
    case 0x30:
    case 0x31:
    case 0x32:
    case 0x33:
      return "voltage";
    case 0x40:
    case 0x41:
    case 0x42:
    case 0x43:
      return "temperature";
    case 0x50:
      return "device hardware";
    case 0x73:
      return "sensor";
    case 0x81:
      return "communication";
    case 0x84:
      return "velocity control";
    case 0x86:
      return "position control";
  }
  return "error of the device";
}

}  // namespace tenon::hw::canopen
