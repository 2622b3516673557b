#include "hw/sensors/ati_netcanoem_start.h"

#include <cmath>
#include <cstddef>
#include <span>

#include "shared/base/bytes.h"
#include "shared/sensors/ati_netcanoem.h"

namespace tenon::hw {
namespace {

constexpr unsigned kAllParts = 0b111;
/// Of what is wrong in an answer, for the fault's object: operation, and a row or place above it.
constexpr std::uint32_t object_of(std::uint32_t operation, std::uint32_t place) {
  return place << 8U | operation;
}

}  // namespace

SensorStart::Question AtiNetcanoemStart::question(std::size_t which) const {
  Question question;
  std::uint32_t operation = ati::kReadGauges;
  std::uint32_t place = 0;
  if (which < kRows) {
    operation = ati::kReadMatrixRow;
    place = static_cast<std::uint32_t>(which);
    question.frame.length = 1;
    question.frame.data[0] = static_cast<std::uint8_t>(which);
  } else if (which == kCounts) {
    operation = ati::kReadCounts;
  } else if (which == kUnits) {
    operation = ati::kReadUnits;
  }
  question.frame.id = request_id_ | operation;
  question.object = object_of(operation, place);
  return question;
}

// An answer is of one try: what came of an earlier one is forgotten.
void AtiNetcanoemStart::begin(std::size_t /*which*/) { parts_ = 0; }

SensorStart::Heard AtiNetcanoemStart::hear(std::size_t which, const CanFrame& frame,
                                           ArmFault& fault) {
  const bool ours =
      !frame.extended && !frame.remote && (frame.id & ~(ati::kOperations - 1U)) == request_id_;
  if (!ours) return Heard::kNothing;
  const std::uint32_t operation = frame.id & (ati::kOperations - 1U);
  if (which < kRows) {
    const std::uint32_t part = operation - ati::kReadMatrixRow;
    return part < 3 && frame.length == 8 ? hear_row(which, part, frame) : Heard::kNothing;
  }
  if (which == kCounts) {
    const bool answers = operation == ati::kReadCounts && frame.length == 8;
    return answers ? hear_counts(frame, fault) : Heard::kNothing;
  }
  if (which == kUnits) {
    const bool answers = operation == ati::kReadUnits && frame.length == 2;
    return answers ? hear_units(frame, fault) : Heard::kNothing;
  }
  const bool half = parts_ != 0;
  if (half && operation == ati::kGaugesSecond && frame.length == 6) return Heard::kAnswer;
  if (operation != ati::kReadGauges || frame.length != 8) return Heard::kNothing;
  parts_ = 1;
  const auto status = load_be<std::uint16_t>(std::span(frame.data));
  if (status == 0) return Heard::kNothing;
  fault.code = status;
  return Heard::kWrong;
}

SensorStart::Heard AtiNetcanoemStart::hear_row(std::size_t row, std::uint32_t part,
                                               const CanFrame& frame) {
  const std::span<const std::uint8_t> bytes(frame.data);
  const auto r = static_cast<Eigen::Index>(row);
  const auto column = static_cast<Eigen::Index>(2 * part);
  matrix_(r, column) = load_be<float>(bytes);
  matrix_(r, column + 1) = load_be<float>(bytes.subspan(4));
  parts_ |= 1U << part;
  if (parts_ != kAllParts) return Heard::kNothing;
  parts_ = 0;
  const bool good = matrix_.row(r).allFinite() && !matrix_.row(r).isZero(0.0);
  return good ? Heard::kAnswer : Heard::kWrong;
}

SensorStart::Heard AtiNetcanoemStart::hear_counts(const CanFrame& frame, ArmFault& fault) {
  const std::span<const std::uint8_t> bytes(frame.data);
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts_[i] = load_be<std::uint32_t>(bytes.subspan(4 * i));
    if (counts_[i] > 0.0) continue;
    fault.object = object_of(ati::kReadCounts, static_cast<std::uint32_t>(i));
    return Heard::kWrong;
  }
  return Heard::kAnswer;
}

SensorStart::Heard AtiNetcanoemStart::hear_units(const CanFrame& frame, ArmFault& fault) {
  const std::array<std::span<const double>, 2> units = {ati::kForceUnits_N, ati::kTorqueUnits_Nm};
  Matrix scaled = matrix_;
  for (std::size_t i = 0; i < units.size(); ++i) {
    const std::uint8_t code = frame.data[i];
    if (code == 0 || code >= units[i].size()) {
      fault.object = object_of(ati::kReadUnits, static_cast<std::uint32_t>(i));
      fault.code = code;
      return Heard::kWrong;
    }
    scaled.middleRows<3>(static_cast<Eigen::Index>(3 * i)) *= units[i][code] / counts_[i];
  }
  if (!spans_ranges(scaled, fault)) return Heard::kWrong;
  source_.calibrate(scaled);
  return Heard::kAnswer;
}

bool AtiNetcanoemStart::spans_ranges(const Matrix& calibration, ArmFault& fault) const {
  constexpr double kGaugeMax = 32767.0;
  for (Eigen::Index row = 0; row < 6; ++row) {
    const double reach = kGaugeMax * calibration.row(row).lpNorm<1>();
    if (reach >= ranges_[row < 3 ? 0 : 1]) continue;
    fault.object = object_of(ati::kReadMatrixRow, static_cast<std::uint32_t>(row));
    fault.code = static_cast<std::uint32_t>(std::ceil(reach));
    return false;
  }
  return true;
}

}  // namespace tenon::hw
