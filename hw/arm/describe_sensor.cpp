#include "hw/arm/describe_sensor.h"

#include <array>
#include <utility>

#include "shared/base/text.h"
#include "shared/canopen/constants.h"
#include "shared/sensors/ati_netcanoem.h"
#include "shared/sensors/robotous_rft.h"

namespace tenon::hw {
namespace {

/// Axes, and rows of a matrix, by their place.
constexpr const char* kAxes[] = {"fx", "fy", "fz", "tx", "ty", "tz"};

const char* rft_command(std::uint32_t what) {
  switch (what) {
    case rft::kSetRate:
      return "set rate (0Fh)";
    case rft::kStart:
      return "start (0Bh)";
  }
  return "its command";
}

std::string rft_no_answer(const ArmFault& fault, const ForceTorqueSensor& sensor) {
  return std::string("no answer to ") + rft_command(fault.object) +
         format(
             " on 0x%03X in three tries, sent on 0x%03X; check power, wiring, that the bus runs at "
             "1 "
             "Mbit/s, and that the sensor has these identifiers",
             sensor.sample_ids[0], sensor.request_id);
}

std::string rft_refusal(const ArmFault& fault, const ForceTorqueSensor& sensor) {
  return format(
      "refused its rate of %d Hz (0Fh, error code %u); take another rate_hz, and see its manual "
      "for the code",
      sensor.rate_hz, fault.code);
}

std::string rft_overload(std::uint32_t status) {
  std::string axes;
  for (unsigned bit = 0; bit < 6; ++bit) {
    if ((status >> bit & 1U) != 0) axes += std::string(axes.empty() ? "" : " ") + kAxes[bit];
  }
  return format("reports overload 0x%02X (", status) + (axes.empty() ? "no axis" : axes) +
         "); the load is too high or the sensor is damaged";
}

std::string ati_question(std::uint32_t object) {
  const std::uint32_t operation = object & 0xFFU;
  switch (operation) {
    case ati::kReadMatrixRow:
      return format("read matrix row %u (operation 2)", object >> 8U);
    case ati::kReadCounts:
      return "read counts per unit (operation 7)";
    case ati::kReadUnits:
      return "read units (operation 8)";
  }
  return "read gauges (operation 0)";
}

std::string ati_no_answer(const ArmFault& fault, const ForceTorqueSensor& sensor) {
  return "no answer to " + ati_question(fault.object) +
         format(
             " on 0x%03X in three tries; check power, wiring, bit rate, and that its base "
             "identifier is 0x%02X",
             sensor.request_id | (fault.object & 0xFFU), sensor.request_id / ati::kOperations);
}

std::string ati_status(std::uint32_t status) {
  static constexpr std::array<std::pair<std::uint16_t, const char*>, 13> kBits = {{
      {ati::kWatchdogReset, "watchdog reset"},
      {ati::kExcitationHigh, "excitation too high"},
      {ati::kExcitationLow, "excitation too low"},
      {ati::kGroundOff, "artificial ground out of range"},
      {ati::kSupplyHigh, "supply too high"},
      {ati::kSupplyLow, "supply too low"},
      {ati::kBadCalibration, "bad calibration"},
      {ati::kMemoryFailure, "memory failure"},
      {ati::kBadConfiguration, "bad configuration"},
      {ati::kTooHot, "too hot"},
      {ati::kTooCold, "too cold"},
      {ati::kBusError, "CAN error"},
      {ati::kAnyError, "some error"},
  }};
  std::string names;
  for (const auto& [bit, name] : kBits) {
    if ((status & bit) != 0) names += std::string(names.empty() ? "" : ", ") + name;
  }
  return format("reports status 0x%04X (", status) + (names.empty() ? "bits not known" : names) +
         "); check its supply and cable, and switch it off and on";
}

std::string ati_reach(const ArmFault& fault, const ForceTorqueSensor& sensor) {
  const std::uint32_t row = fault.object >> 8U;
  const bool force = row < 3;
  return format(
      "by its calibration and units %s reads no more than %u %s with all gauges at their ends, its "
      "range is said to be %g: this is another sensor, calibration or unit, or correct %s",
      row < 6 ? kAxes[row] : "?", fault.code, force ? "N" : "Nm",
      force ? sensor.force_range_N : sensor.torque_range_Nm,
      force ? "force_range_N" : "torque_range_Nm");
}

std::string ati_configuration(const ArmFault& fault, const ForceTorqueSensor& sensor) {
  const std::uint32_t place = fault.object >> 8U;
  const char* what = place == 0 ? "force" : "torque";
  switch (fault.object & 0xFFU) {
    case ati::kReadMatrixRow:
      if (fault.code != 0) return ati_reach(fault, sensor);
      return format(
          "row %u (%s) of its calibration matrix is zero or no numbers; it is not "
          "calibrated, or another calibration must be chosen in it",
          place, place < 6 ? kAxes[place] : "?");
    case ati::kReadCounts:
      return std::string("its counts a unit of ") + what +
             " are 0; it is not calibrated, or another calibration must be chosen in it";
    case ati::kReadUnits:
      return format("its unit of %s has the code %u, must be 1 to 6; see its manual", what,
                    fault.code);
  }
  return ati_status(fault.code);
}

std::string wrong_length(const ArmFault& fault, const ForceTorqueSensor& sensor) {
  return format(
      "its frames come with %u bytes, and another length is theirs; check that nobody else sends "
      "on "
      "0x%03X and 0x%03X",
      fault.code, sensor.sample_ids[0], sensor.sample_ids[1]);
}

}  // namespace

std::string sensor_name(const ForceTorqueSensor& sensor) {
  return "force/torque sensor " + sensor.profile + ": ";
}

std::optional<std::string> describe_sensor(const ArmFault& fault, const ForceTorqueSensor& sensor) {
  const bool node = sensor.protocol == SensorProtocol::kNode;
  if (node || sensor.absent() || fault.node != 0) return std::nullopt;
  const std::string name = sensor_name(sensor);
  const bool ati = sensor.protocol == SensorProtocol::kAtiNetcanoem;
  if (fault.kind == ArmFaultKind::kNoAnswer) {
    return name + (ati ? ati_no_answer(fault, sensor) : rft_no_answer(fault, sensor));
  }
  if (fault.kind == ArmFaultKind::kConfiguration) {
    return name + (ati ? ati_configuration(fault, sensor) : rft_refusal(fault, sensor));
  }
  const bool its_word = fault.object >> 8 == tenon::canopen::kSensorStatus;
  if (fault.kind == ArmFaultKind::kSensorInvalid && its_word) {
    return name + (ati ? ati_status(fault.code) : rft_overload(fault.code));
  }
  if (fault.kind == ArmFaultKind::kSensorStale && fault.object != 0) {
    return name + wrong_length(fault, sensor);
  }
  return std::nullopt;
}

std::string describe_start(const ForceTorqueSensor& sensor) {
  if (sensor.absent())
    return "no force/torque sensor: the joints' efforts (6077h) tell the force\n";
  if (sensor.protocol == SensorProtocol::kNode) return {};
  std::string text = sensor_name(sensor);
  if (sensor.protocol == SensorProtocol::kRobotousRft) {
    text += format(
        "stopped (0Ch), set to %d Hz (0Fh), started (0Bh) on 0x%03X; answers on 0x%03X and "
        "0x%03X\n",
        sensor.rate_hz, sensor.request_id, sensor.sample_ids[0], sensor.sample_ids[1]);
  } else {
    text += format(
        "asked for its matrix (2), counts (7) and units (8), then polled (0) every %d cycles, on "
        "0x%03X to 0x%03X\n",
        sensor.cycles_per_sample, sensor.request_id, sensor.request_id + ati::kOperations - 1);
  }
  for (const std::string& line : sensor.unverified) text += "  unverified: " + line + "\n";
  return text;
}

}  // namespace tenon::hw
