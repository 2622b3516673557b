#include "hw/arm/describe_fault.h"

#include <cstdio>
#include <optional>
#include <vector>

#include "hw/arm/arm_supervision.h"
#include "hw/arm/bring_up.h"
#include "hw/arm/cob_ids.h"
#include "hw/arm/describe_sensor.h"
#include "hw/arm/node_settings.h"
#include "hw/arm/saturation_fault.h"
#include "hw/canopen/emergency.h"
#include "hw/canopen/object_setting.h"
#include "hw/canopen/sdo.h"
#include "hw/cia402/drive_state.h"
#include "shared/base/text.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

using canopen::ObjectSetting;

std::string node_name(std::uint8_t node, const Robot& robot) {
  if (node == 0 && robot.sensor.node == 0 && !robot.sensor.absent())
    return sensor_name(robot.sensor);
  std::string owner = "not of this robot";
  for (const Joint& joint : robot.joints) {
    if (joint.node == node) owner = joint.name;
  }
  if (robot.sensor.node == node && node != 0) owner = "force/torque sensor";
  return format("node %u (", static_cast<unsigned>(node)) + owner + "): ";
}

std::string node_name(const ArmFault& fault, const Robot& robot) {
  return node_name(fault.node, robot);
}

/// " of the arm" where there are two to tell apart.
std::string whose_bus(const ArmFault& fault, const Robot& robot) {
  if (!robot.sensor.has_own_bus()) return "";
  return fault.code == kSensorBus ? " of the force/torque sensor" : " of the arm";
}

std::string object_name(std::uint32_t object) {
  return format("%04Xh:%u", object >> 8, object & 0xFFu);
}

std::string object_name(const ArmFault& fault) { return object_name(fault.object); }

/// What the object was configured to be; the last time, where it was written twice.
std::optional<ObjectSetting> setting_of(const ArmFault& fault, const Robot& robot) {
  std::vector<ObjectSetting> settings;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    if (robot.joints[i].node == fault.node) settings = joint_settings(robot, i);
  }
  if (robot.sensor.node == fault.node) settings = sensor_settings(robot);
  settings.push_back(heartbeat_setting(robot));
  std::optional<ObjectSetting> found;
  for (const ObjectSetting& setting : settings) {
    if (setting.object() == fault.object) found = setting;
  }
  return found;
}

std::string no_answer(const ArmFault& fault, const Robot& robot) {
  const unsigned node = fault.node;
  if (fault.object != 0) {
    return "no SDO answer for " + object_name(fault) +
           format(" within 0.5 s; expected 0x%03X; check that no other master talks to the node",
                  tenon::canopen::kSdoResponse + node);
  }
  const unsigned heartbeat = tenon::canopen::kHeartbeat + node;
  if (fault.code == tenon::canopen::kStateBootUp) {
    return format(
        "no boot-up within %.1f s, nor within as long after a second NMT reset; expected 0x%03X; "
        "check power, wiring, bit rate, node id, and boot_s of its drive's profile",
        boot_s(robot, fault.node), heartbeat);
  }
  return format(
      "did not become %s within %.1f s; expected 0x%03X#%02X; check the node's error register "
      "(1001h)",
      fault.code == tenon::canopen::kStateOperational ? "operational" : "pre-operational",
      static_cast<double>(BringUp::kStateTimeout_ns) * 1e-9, heartbeat, fault.code);
}

std::string configuration(const ArmFault& fault, const Robot& robot) {
  if (fault.object == 0) {
    return format(
        "%u devices answered to one request; give each its own node id (with one of them "
        "connected at a time)",
        fault.code);
  }
  const std::string object = object_name(fault);
  const unsigned index = fault.object >> 8;
  const auto setting = setting_of(fault, robot);
  if (setting && setting->action == ObjectSetting::Action::kWriteIfOther && fault.refused &&
      fault.code == tenon::canopen::kAbortReadOnly &&
      (tenon::canopen::is_rpdo_mapping(index) || tenon::canopen::is_tpdo_mapping(index))) {
    return format(
        "its PDO mapping %04Xh is fixed (abort 0x%08X) and another than hw/PROTOCOL.md lists; a "
        "joint's depends on mode and targets_per_frame",
        index, fault.code);
  }
  if (fault.refused) {
    const char* reason = canopen::sdo_abort_text(fault.code);
    std::string wanted;
    if (setting && setting->action != ObjectSetting::Action::kExpect) {
      wanted = format(" = 0x%X", setting->value);
    }
    return "refused " + object + wanted + ": " +
           (reason != nullptr ? reason : "for a reason of its maker's own") +
           format(
               " (abort 0x%08X); check the device's manual and firmware, and the profile of its "
               "drive",
               fault.code);
  }
  if (index == tenon::canopen::kSupportedModes && setting) {
    return format(
        "does not support the robot file's mode of operation (6502h = 0x%X, bit mask 0x%X is "
        "missing); set the joint's mode to 8 or 7 as the drive offers",
        fault.code, setting->value);
  }
  if (index == tenon::canopen::kDeviceType) {
    return format("is no CiA 402 drive (1000h = 0x%08X, low half must be 402); check the node id",
                  fault.code);
  }
  return "holds " + object + format(" = 0x%X", fault.code) +
         (setting ? format(" where 0x%X was asked for", setting->value) : std::string()) +
         "; check the device's limits and firmware";
}

std::string drive_state(const ArmFault& fault) {
  const auto word = static_cast<std::uint16_t>(fault.code);
  return format(
      "is in '%s' (statusword 0x%04X) where 'operation enabled' was expected; check "
      "enable inputs, supply voltage, safe torque off",
      cia402::to_string(cia402::decode_statusword(word)), fault.code);
}

/// The standard's words where it has some, else the number alone.
std::string error_code(std::uint32_t code) {
  const char* text = canopen::emergency_text(code);
  return format("0x%04X", code) + (text != nullptr ? format(" (%s)", text) : std::string());
}

std::string drive_fault(const ArmFault& fault) {
  const bool of_emergency = fault.object >> 8 == tenon::canopen::kErrorCode;
  if (of_emergency && fault.code == tenon::canopen::kEmergencyHeartbeat) {
    return "drive fault " + error_code(fault.code) +
           ": it has not heard this program for its timeout; check what else this computer runs, "
           "late cycles, and the bus";
  }
  if (of_emergency) {
    return "drive fault " + error_code(fault.code) + "; see the drive's manual for the code";
  }
  return format(
      "drive fault (statusword 0x%04X); read its error code with tenon-can read %u "
      "0x603F 0",
      fault.code, static_cast<unsigned>(fault.node));
}

std::string unexpected_reset(const ArmFault& fault) {
  if (fault.code == tenon::canopen::kStateBootUp) {
    return "has reset itself while running (boot-up message); check its supply voltage";
  }
  return format(
      "has left operational (heartbeat state 0x%02X); check for another NMT master and "
      "the node's error behaviour (1029h)",
      fault.code);
}

std::string sensor_invalid(const ArmFault& fault, const Robot& robot) {
  const unsigned place = (fault.object & 0xFFu) - 1;
  if (const auto reading = saturated_reading(fault)) {
    static constexpr const char* kAxes[] = {"fx", "fy", "fz", "tx", "ty", "tz"};
    const bool force = place < 3;
    return format(
        "%s = %.2f %s is at or beyond the range of %.2f; the load is too high or the "
        "sensor is damaged",
        place < 6 ? kAxes[place] : "?", *reading, force ? "N" : "Nm",
        force ? robot.sensor.force_range_N : robot.sensor.torque_range_Nm);
  }
  switch (fault.object >> 8) {
    case tenon::canopen::kForceInputs:
      return format(
          "its raw value %u of 6 is %d, the end of its 16 bits; the load is too high or the sensor "
          "is damaged",
          place + 1, static_cast<int>(static_cast<std::int16_t>(fault.code)));
    case tenon::canopen::kSensorStatus:
      return format("reports status 0x%04X (2002h) where 0 is good; check the sensor", fault.code);
  }
  return "reports error " + error_code(fault.code) + "; check the sensor";
}

std::string wrong_length(const ArmFault& fault) {
  return format(
      "its process data come with %u bytes where 8 are mapped; check that nobody else maps its "
      "TPDO1 and TPDO2 (1A00h, 1A01h), or sends on their identifiers",
      fault.code);
}

std::string setpoint(const ArmFault& fault) {
  if (fault.kind == ArmFaultKind::kSetpointNotFinite) {
    return "its setpoint is no number; it was not sent, and the drives stop: a fault of the "
           "program "
           "that commands";
  }
  return format(
      "%u of its setpoints (RPDO) never left, one in a hundred may: check bus load, bit rate and "
      "txqueuelen",
      fault.code);
}

std::string feedback_missing(const ArmFault& fault) {
  return format(
      "no feedback (TPDO1) in %u cycles in a row, at most %u are allowed; check bus load and "
      "wiring",
      fault.code, ArmSupervision::kMissingCycles);
}

std::string sensor_stale(const ArmFault& fault, const Robot& robot) {
  return format(
             "no new wrench in %u cycles in a row, at most %u are allowed; check that the sensor "
             "samples at least once ",
             fault.code, WrenchStaleness::cycles_max(robot.sensor)) +
         (robot.sensor.cycles_per_sample == 1
              ? format("a cycle of %u us", robot.cycle_us)
              : format("in %d cycles of %u us", robot.sensor.cycles_per_sample, robot.cycle_us));
}

std::string samples_late(const ArmFault& fault, const Robot& robot) {
  const int samples = static_cast<int>(fault.code);
  return format(
      "its samples are %d SYNCs old by their counter (2001h), and have been so, or missing, for "
      "more than %d "
      "samples; check what else is on its bus, the adapter, and whether the sensor hears every "
      "SYNC",
      samples * robot.sensor.cycles_per_sample, WrenchStaleness::kMissingSamples);
}

std::string stale(const ArmFault& fault, const Robot& robot) {
  if (fault.object == 0) return sensor_stale(fault, robot);
  const bool late = fault.object >> 8 == tenon::canopen::kSampleCounter;
  return late ? samples_late(fault, robot) : wrong_length(fault);
}

/// Of a frame that betrays another master (hw/arm/other_master.h).
const char* master_frame_name(std::uint32_t cob_id, const Robot& robot) {
  if (cob_id == tenon::canopen::kNmt) return "NMT command";
  if (cob_id == tenon::canopen::kSync) return "SYNC";
  if (cob_id == robot.sensor.request_id) return "what asks the force/torque sensor";
  if (cob_id == kStopCobId) return "stop of all drives";
  if (cob_id >= tenon::canopen::kHeartbeat) return "heartbeat of the master's node";
  return cob_id >= tenon::canopen::kSdoRequest ? "SDO download" : "setpoint of a drive";
}

}  // namespace

std::string describe(const ArmFault& fault, const Robot& robot) {
  if (const auto line = describe_sensor(fault, robot.sensor)) return *line;
  switch (fault.kind) {
    case ArmFaultKind::kNone:
      return "no fault";
    case ArmFaultKind::kNoAnswer:
      return node_name(fault, robot) + no_answer(fault, robot);
    case ArmFaultKind::kConfiguration:
      return node_name(fault, robot) + configuration(fault, robot);
    case ArmFaultKind::kHeartbeatLost:
      return node_name(fault, robot) +
             format("no heartbeat for %u ms; expected 0x%03X every %u ms; check power and wiring",
                    robot.heartbeat_timeout_ms, tenon::canopen::kHeartbeat + fault.node,
                    robot.heartbeat_ms);
    case ArmFaultKind::kUnexpectedReset:
      return node_name(fault, robot) + unexpected_reset(fault);
    case ArmFaultKind::kDriveFault:
      return node_name(fault, robot) + drive_fault(fault);
    case ArmFaultKind::kDriveState:
      return node_name(fault, robot) + drive_state(fault);
    case ArmFaultKind::kFeedbackMissing:
      return node_name(fault, robot) +
             (fault.object != 0 ? wrong_length(fault) : feedback_missing(fault));
    case ArmFaultKind::kSensorStale:
      return node_name(fault, robot) + stale(fault, robot);
    case ArmFaultKind::kSensorInvalid:
      return node_name(fault, robot) + sensor_invalid(fault, robot);
    case ArmFaultKind::kBusDown:
      return "the CAN bus" + whose_bus(fault, robot) +
             " is gone (interface down or connection closed); check the adapter, or "
             "that the other end still runs";
    case ArmFaultKind::kOtherMaster:
      return format("another master runs on this bus: 0x%03X (%s) came from it; stop it first",
                    fault.code, master_frame_name(fault.code, robot));
    case ArmFaultKind::kQueueFull:
      return format(
          "the transmit queue was full in %u cycles in a row, at most %u are allowed; check bus "
          "load, bit rate and txqueuelen",
          fault.code, ArmSupervision::kRefusedCycles);
    case ArmFaultKind::kBusSilent:
      return format(
          "no node answered in %u cycles in a row, at most %u are allowed; check adapter, wiring "
          "and whether the interface was down",
          fault.code, ArmSupervision::kSilentCycles);
    case ArmFaultKind::kSetpointNotFinite:
    case ArmFaultKind::kSetpointUnsent:
      return node_name(fault, robot) + setpoint(fault);
    case ArmFaultKind::kBusOff:
      return "the CAN controller" + whose_bus(fault, robot) +
             " went bus-off (too many errors); check wiring, termination and bit rate";
  }
  return "unknown fault";
}

std::string describe(const SettingNote& note, const Robot& robot) {
  std::string line = node_name(note.node, robot) + object_name(note.object);
  switch (note.kind) {
    case SettingNote::Kind::kAbsent:
      return line + " does not exist; its profile allows that";
    case SettingNote::Kind::kOther:
      return line + format(" holds 0x%X (%u) where 0x%X (%u) was written; taken as it is",
                           note.found, note.found, note.wanted, note.wanted);
    case SettingNote::Kind::kNoStop:
      return node_name(note.node, robot) +
             format(
                 "has no free RPDO by which all drives are stopped at once: beyond "
                 "force_fault_N it stops with the next SYNC, up to %g ms after the others",
                 1e-3 * robot.cycle_us);
    case SettingNote::Kind::kTaken:
      return line + format(" = 0x%X (%u), left as it is", note.found, note.found) +
             (note.found == note.wanted ? "" : format(" (by the book 0x%X)", note.wanted));
  }
  return line;
}

}  // namespace tenon::hw
