#include "sim/cell/devices/drive_objects.h"

#include <array>
#include <cmath>
#include <limits>

#include "shared/base/time_units.h"

namespace tenon::sim {
namespace {

using enum DataType;
constexpr Access kRo = Access::kReadOnly;
constexpr Access kRw = Access::kReadWrite;
constexpr Mappable kNo = Mappable::kNo;
constexpr Mappable kRpdo = Mappable::kReceive;
constexpr Mappable kTpdo = Mappable::kTransmit;
constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();  // the type's own
constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();

struct Row {
  std::uint16_t index;
  std::uint8_t sub;
  const char* name;
  DataType type;
  Access access;
  Mappable mappable;
  std::int64_t value = 0;
  std::int64_t low = kMin;
  std::int64_t high = kMax;
};

// A window of 0 is off, and it starts so: as with some real drives, it must be written. The
// defaults that differ between drives come from DriveParameters.
constexpr std::array kRows = {
    Row{0x2030, 0, "Drive temperature", kI16, kRo, kTpdo},
    Row{0x2031, 0, "Drive temperature of warning", kI16, kRw, kNo},
    Row{0x2032, 0, "Drive temperature of fault", kI16, kRw, kNo},
    Row{0x2033, 0, "Lowest DC link circuit voltage", kU32, kRw, kNo},
    Row{0x6007, 0, "Abort connection option code", kI16, kRw, kNo, 1, 0, 3},
    Row{0x603F, 0, "Error code", kU16, kRo, kTpdo},
    Row{0x6040, 0, "Controlword", kU16, kRw, kRpdo},
    Row{0x6041, 0, "Statusword", kU16, kRo, kTpdo},
    Row{0x605A, 0, "Quick stop option code", kI16, kRw, kNo, 2, 0, 6},
    Row{0x605B, 0, "Shutdown option code", kI16, kRw, kNo, 0, 0, 1},
    Row{0x605C, 0, "Disable operation option code", kI16, kRw, kNo, 1, 0, 1},
    Row{0x605D, 0, "Halt option code", kI16, kRw, kNo, 1, 1, 2},
    Row{0x605E, 0, "Fault reaction option code", kI16, kRw, kNo, 2, 0, 2},
    Row{0x6060, 0, "Modes of operation", kI8, kRw, kRpdo},
    Row{0x6061, 0, "Modes of operation display", kI8, kRo, kTpdo},
    Row{0x6062, 0, "Position demand value", kI32, kRo, kTpdo},
    Row{0x6064, 0, "Position actual value", kI32, kRo, kTpdo},
    Row{0x6065, 0, "Following error window", kU32, kRw, kNo},
    Row{0x6066, 0, "Following error time out", kU16, kRw, kNo},
    Row{0x606C, 0, "Velocity actual value", kI32, kRo, kTpdo},
    Row{0x6072, 0, "Max torque", kU16, kRw, kRpdo},
    Row{0x6076, 0, "Motor rated torque", kU32, kRo, kNo},
    Row{0x6077, 0, "Torque actual value", kI16, kRo, kTpdo},
    Row{0x6079, 0, "DC link circuit voltage", kU32, kRo, kTpdo},
    Row{0x607A, 0, "Target position", kI32, kRw, kRpdo},
    Row{0x607D, 0, "Highest sub-index supported", kU8, kRo, kNo, 2},
    Row{0x607D, 1, "Min position limit", kI32, kRw, kNo, -2147483648LL},
    Row{0x607D, 2, "Max position limit", kI32, kRw, kNo, 2147483647},
    Row{0x6084, 0, "Profile deceleration", kU32, kRw, kNo, 0, 1},
    Row{0x6085, 0, "Quick stop deceleration", kU32, kRw, kNo, 0, 1},
    Row{0x60C1, 0, "Highest sub-index supported", kU8, kRo, kNo, 1},
    Row{0x60C1, 1, "Interpolation data record 1", kI32, kRw, kRpdo},
    Row{0x60C2, 0, "Highest sub-index supported", kU8, kRo, kNo, 2},
    Row{0x60C2, 1, "Interpolation time period value", kU8, kRw, kNo, 8, 1},
    Row{0x60C2, 2, "Interpolation time index", kI8, kRw, kNo, -3, -6, 0},
    Row{0x60F4, 0, "Following error actual value", kI32, kRo, kTpdo},
    Row{0x6502, 0, "Supported drive modes", kU32, kRo, kNo},
};

/// 605Ah: slowing down at the current or voltage limit (3, 4, 7, 8) this drive cannot.
std::uint32_t check_quick_stop(std::int64_t option) {
  return option == 3 || option == 4 ? canopen::kAbortValue : 0;
}

ObjectDictionary& add_rows(ObjectDictionary& dictionary, const DriveObjects::Hooks& hooks) {
  for (const Row& row : kRows) {
    ObjectEntry entry{.name = row.name,
                      .type = row.type,
                      .access = row.access,
                      .mappable = row.mappable,
                      .value = row.value,
                      .low = row.low,
                      .high = row.high};
    if (row.index == canopen::kControlword) entry.on_write = hooks.on_controlword;
    if (row.index == canopen::kMode) entry.on_write = hooks.on_mode;
    if (row.index == canopen::kQuickStopOption) entry.on_write = check_quick_stop;
    dictionary.add(object_id(row.index, row.sub), std::move(entry));
  }
  dictionary.describe(canopen::kPositionLimits, {"Software position limit", Structure::kArray});
  dictionary.describe(canopen::kInterpolationData,
                      {"Interpolation data record", Structure::kArray});
  dictionary.describe(canopen::kInterpolationPeriod,
                      {"Interpolation time period", Structure::kRecord});
  return dictionary;
}

std::int64_t tenths(double celsius) { return std::llround(10.0 * celsius); }
std::int64_t millis(double volts) { return std::llround(1000.0 * volts); }

}  // namespace

DriveObjects::DriveObjects(ObjectDictionary& dictionary, const DriveParameters& parameters,
                           const Hooks& hooks)
    : dictionary_(add_rows(dictionary, hooks)) {
  set_default(torque_max_permille, parameters.effort_max_permille);
  set_default(at(0x6076), parameters.rated_effort_mNm);
  set_default(deceleration, parameters.quick_stop_counts_ps2);
  set_default(quick_stop_deceleration, parameters.quick_stop_counts_ps2);
  set_default(at(canopen::kSupportedModes), std::int64_t{1} << (parameters.mode - 1));
  set_default(temperature_tenths, tenths(parameters.ambient_degC));
  set_default(warning_tenths, tenths(parameters.warning_degC));
  set_default(fault_tenths, tenths(parameters.fault_degC));
  set_default(supply_mV, millis(parameters.supply_V));
  set_default(supply_min_mV, millis(parameters.supply_min_V));
}

StopOptions DriveObjects::stop_options() const {
  return {.quick_stop = quick_stop_option.value,
          .shutdown = shutdown_option.value,
          .disable = disable_option.value,
          .fault_reaction = fault_reaction_option.value};
}

std::int64_t DriveObjects::interpolation_period_ns() const {
  std::int64_t period_ns = interpolation_value.value * kNanosecondsPerSecond;
  for (std::int64_t i = interpolation_exponent.value; i < 0; ++i) period_ns /= 10;
  return period_ns;
}

}  // namespace tenon::sim
