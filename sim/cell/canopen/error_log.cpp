#include "sim/cell/canopen/error_log.h"

#include <algorithm>
#include <string>

#include "shared/canopen/constants.h"
#include "sim/cell/canopen/pdo_parameters.h"

namespace tenon::sim {
namespace {

constexpr std::uint16_t kErrorHistory = 0x1003;
constexpr std::uint16_t kEmergencyCobId = 0x1014;
constexpr std::uint32_t kAbortNoData = 0x08000024;

/// Bits of 1001h by the class of the error code (CiA 301, 7.2.7.1 and 7.5.2.2).
std::uint8_t register_bits(std::uint16_t code) {
  constexpr std::uint8_t kGeneric = 0x01;
  constexpr std::uint8_t kCurrent = 0x02;
  constexpr std::uint8_t kVoltage = 0x04;
  constexpr std::uint8_t kTemperature = 0x08;
  constexpr std::uint8_t kCommunication = 0x10;
  constexpr std::uint8_t kProfile = 0x20;
  constexpr std::uint8_t kManufacturer = 0x80;
  const unsigned top = code >> 8;
  if (top == 0x81 || top == 0x82) return kGeneric | kCommunication;
  switch (code >> 12) {
    case 0x2:
      return kGeneric | kCurrent;
    case 0x3:
      return kGeneric | kVoltage;
    case 0x4:
      return kGeneric | kTemperature;
    case 0x7:
    case 0x8:
      return kGeneric | kProfile;
    case 0xF:
      return kGeneric | kManufacturer;
    default:  // 5xxxh hardware, 6xxxh software, 9xxxh outside: no bit of their own
      return kGeneric;
  }
}

std::uint32_t check_cob_id(std::int64_t value) {
  const std::uint32_t wanted = static_cast<std::uint32_t>(value);
  if ((wanted & canopen::kPdoInvalid) != 0) return 0;
  return is_restricted_cob_id(wanted) ? canopen::kAbortValue : 0;
}

}  // namespace

ErrorLog::ErrorLog(ObjectDictionary& dictionary, std::uint8_t node)
    : dictionary_(dictionary),
      register_(dictionary.add(
          object_id(canopen::kErrorRegister),
          {.name = "Error register", .type = DataType::kU8, .mappable = Mappable::kTransmit})),
      cob_id_(dictionary.add(object_id(kEmergencyCobId), {.name = "COB-ID EMCY",
                                                          .type = DataType::kU32,
                                                          .access = Access::kReadWrite,
                                                          .value = canopen::kEmergency + node,
                                                          .contains_node = true,
                                                          .on_write = check_cob_id})) {
  add_history();
}

void ErrorLog::add_history() {
  dictionary_.describe(kErrorHistory, {"Pre-defined error field", Structure::kArray});
  // Writing 0 empties it; nothing else may be written.
  history_count_ =
      &dictionary_.add(object_id(kErrorHistory), {.name = "Number of errors",
                                                  .access = Access::kReadWrite,
                                                  .is_command = true,
                                                  .on_write = [this](std::int64_t value) {
                                                    if (value != 0) {
                                                      return canopen::kAbortValue;
                                                    }
                                                    history_count_->value = 0;
                                                    return 0U;
                                                  }});
  for (std::uint8_t sub = 1; sub <= kHistoryMax; ++sub) {
    history_[sub - 1U] = &dictionary_.add(
        object_id(kErrorHistory, sub),
        {.name = "Standard error field " + std::to_string(sub),
         .type = DataType::kU32,
         .on_read = [this, sub] { return sub <= history_count_->value ? 0 : kAbortNoData; }});
  }
}

std::optional<CanFrame> ErrorLog::raise(std::uint16_t code, ErrorSource source) {
  const Error error{code, source};
  if (std::find(errors_.begin(), errors_.end(), error) != errors_.end()) return std::nullopt;
  const bool news = !known(code);
  errors_.push_back(error);
  update_register();
  if (!news) return std::nullopt;
  remember(code);
  return emergency(code);
}

std::optional<CanFrame> ErrorLog::clear(std::uint16_t code, ErrorSource source) {
  if (std::erase(errors_, Error{code, source}) == 0 || known(code)) return std::nullopt;
  update_register();
  return emergency(canopen::kEmergencyReset);
}

void ErrorLog::reset(bool device_too) {
  std::erase_if(errors_, [device_too](const Error& error) {
    return device_too || error.source == ErrorSource::kCommunication;
  });
  update_register();
}

bool ErrorLog::known(std::uint16_t code) const {
  return std::any_of(errors_.begin(), errors_.end(),
                     [code](const Error& error) { return error.code == code; });
}

void ErrorLog::remember(std::uint16_t code) {
  for (std::size_t i = kHistoryMax - 1; i > 0; --i) history_[i]->value = history_[i - 1]->value;
  history_[0]->value = code;
  history_count_->value =
      std::min<std::int64_t>(history_count_->value + 1, static_cast<std::int64_t>(kHistoryMax));
}

void ErrorLog::update_register() {
  std::uint8_t bits = 0;
  for (const Error& error : errors_) bits |= register_bits(error.code);
  register_.value = bits;
}

std::optional<CanFrame> ErrorLog::emergency(std::uint16_t code) const {
  if ((cob_id_.value & canopen::kPdoInvalid) != 0) return std::nullopt;
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(cob_id_.value) & canopen::kIdMask;
  frame.length = 8;
  frame.data = {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code >> 8),
                static_cast<std::uint8_t>(register_.value)};
  return frame;
}

}  // namespace tenon::sim
