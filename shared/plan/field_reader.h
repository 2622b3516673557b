#pragma once
// Reads the fields of a plan file one after the other, each against its limits. Private to this
// folder. Never throws; the bytes are the caller's.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "shared/base/bytes.h"
#include "shared/plan/codec.h"
#include "shared/plan/format.h"

namespace tenon::plan_format {

/// An interval; the upper end belongs to it, the lower one unless `open_low`.
struct Limits {
  double low;
  double high;
  bool open_low = false;
};
/// Reads fields and remembers the first thing that is wrong; after it every field reads as zero.
class FieldReader {
 public:
  explicit FieldReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <WireNumber T>
  T raw(const char* field) {
    at_ = bytes_.offset();
    const T value = bytes_.read<T>();
    if (!bytes_.ok()) fail(PlanError::kTruncated, field);
    return ok() ? value : T{};
  }
  template <std::unsigned_integral T>
  T whole(const char* field, T low, T high, PlanError error = PlanError::kRange) {
    const T value = raw<T>(field);
    if (value < low || value > high) fail(error, field);
    return ok() ? value : T{};
  }
  template <std::floating_point T>
  double real(const char* field, const Limits& limits) {
    const double value = raw<T>(field);
    if (!std::isfinite(value)) fail(PlanError::kNotFinite, field);
    if ((limits.open_low ? value <= limits.low : value < limits.low) || value > limits.high) {
      fail(PlanError::kRange, field);
    }
    return ok() ? value : 0.0;
  }
  double f32(const char* field, const Limits& limits) { return real<float>(field, limits); }
  double f64(const char* field, const Limits& limits) { return real<double>(field, limits); }

  std::string text(const char* field) {
    const auto size = whole<std::uint8_t>(field, 0, kNameMax, PlanError::kText);
    at_ = bytes_.offset();
    const std::span<const std::uint8_t> letters = bytes_.take(size);
    if (!bytes_.ok()) fail(PlanError::kTruncated, field);
    const bool printable = std::all_of(letters.begin(), letters.end(),
                                       [](std::uint8_t c) { return c >= ' ' && c <= '~'; });
    if (!printable) fail(PlanError::kText, field);
    return ok() ? std::string(letters.begin(), letters.end()) : std::string();
  }
  ContactSignature signature(const char* field) {
    return {whole<std::uint16_t>(field, 0, kAllContacts.bits)};
  }

  /// Fails at the field read last.
  void fail(PlanError error, const char* field) {
    if (!ok()) return;
    error_ = error;
    field_ = field;
    offset_ = at_;
  }
  [[nodiscard]] bool ok() const { return error_ == PlanError::kNone; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.remaining(); }
  [[nodiscard]] DecodedPlan failure() const { return {std::nullopt, error_, offset_, field_}; }

 private:
  ByteReader bytes_;
  std::size_t at_ = 0;  ///< where the field read last begins
  PlanError error_ = PlanError::kNone;
  std::size_t offset_ = 0;
  const char* field_ = "";
};

}  // namespace tenon::plan_format
