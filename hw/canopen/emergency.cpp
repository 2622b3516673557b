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
    case tenon::canopen::kEmergencySyncLength:
      return "SYNC of wrong length";
    case tenon::canopen::kEmergencyRpdoTimeout:
      return "RPDO timeout";
    case tenon::canopen::kEmergencyFollowingError:
      return "following error";
  }
  // Of drives (CiA 402-2, error codes).
  switch (code) {
    case 0x2310:
      return "continuous over-current";
    case 0x2320:
      return "short circuit or earth leakage at the motor";
    case 0x2330:
      return "earth leakage at the motor";
    case 0x2340:
      return "short circuit at the motor";
    case 0x3210:
      return "DC link over-voltage";
    case 0x3220:
      return "DC link under-voltage";
    case 0x4210:
      return "device too hot";
    case 0x4310:
      return "drive too hot";
    case 0x6320:
      return "parameter error";
    case 0x7121:
      return "motor blocked";
    case 0x7300:
      return "sensor";
    case 0x7305:
      return "incremental sensor 1";
    case 0x8612:
      return "reference limit";
  }
  return nullptr;
}

}  // namespace tenon::hw::canopen
