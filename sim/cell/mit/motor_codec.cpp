#include "sim/cell/mit/motor_codec.h"

#include <algorithm>
#include <cmath>

#include "shared/mit/constants.h"

namespace tenon::sim {
namespace {

constexpr unsigned kFrameBits = 64;
constexpr unsigned kLong = 16;
constexpr unsigned kShort = 12;

std::uint64_t largest(unsigned bits) { return (std::uint64_t{1} << bits) - 1; }

/// The frame as one number, fields taken from its upper end.
class BitReader {
 public:
  explicit BitReader(const CanFrame& frame) {
    for (const std::uint8_t byte : frame.data) word_ = word_ << 8U | byte;
  }
  double between(double low, double high, unsigned bits) {
    left_ -= bits;
    const auto field = static_cast<double>(word_ >> left_ & largest(bits));
    return low + (high - low) * field / static_cast<double>(largest(bits));
  }

 private:
  std::uint64_t word_ = 0;
  unsigned left_ = kFrameBits;
};

class BitWriter {
 public:
  void put(std::uint64_t value, unsigned bits) { word_ = word_ << bits | (value & largest(bits)); }
  void put_about_zero(double value, double most, unsigned bits) {
    const auto top = static_cast<double>(largest(bits));
    const double exact = 0.5 * top * (1.0 + value / most);
    // A tie goes down.
    put(static_cast<std::uint64_t>(std::ceil(std::clamp(exact, 0.0, top) - 0.5)), bits);
  }
  [[nodiscard]] std::uint64_t word() const { return word_; }

 private:
  std::uint64_t word_ = 0;
};

}  // namespace

MotorOrder read_order(const CanFrame& frame, const MotorRanges& ranges) {
  BitReader bits(frame);
  MotorOrder order;
  order.position_rad = bits.between(-ranges.position_rad, ranges.position_rad, kLong);
  order.velocity_radps = bits.between(-ranges.velocity_radps, ranges.velocity_radps, kShort);
  order.stiffness_Nmprad = bits.between(0.0, mit::kStiffnessMax, kShort);
  order.damping_Nmsprad = bits.between(0.0, mit::kDampingMax, kShort);
  order.torque_Nm = bits.between(-ranges.torque_Nm, ranges.torque_Nm, kShort);
  return order;
}

CanFrame report_frame(std::uint32_t id, const MotorReport& report, const MotorRanges& ranges) {
  BitWriter bits;
  bits.put(report.state, 4);
  bits.put(report.number, 4);
  bits.put_about_zero(report.position_rad, ranges.position_rad, kLong);
  bits.put_about_zero(report.velocity_radps, ranges.velocity_radps, kShort);
  bits.put_about_zero(report.torque_Nm, ranges.torque_Nm, kShort);
  bits.put(report.board_degC, 8);
  bits.put(report.coil_degC, 8);
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  for (unsigned i = 0; i < 8; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(bits.word() >> (kFrameBits - 8 * (i + 1)));
  }
  return frame;
}

}  // namespace tenon::sim
