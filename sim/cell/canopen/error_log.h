#pragma once
// What is wrong with a node, as the bus sees it (CiA 301, 7.2.7): the error register 1001h, the
// last eight errors 1003h, and the emergencies, whose COB-ID is 1014h. An error stays until the one
// who raised it clears it; raising it twice says it once. One thread.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "shared/ports/can_bus.h"
#include "sim/cell/canopen/object_dictionary.h"

namespace tenon::sim {

/// Who raised an error: the node's communication, which an NMT communication reset renews, or the
/// device behind it.
enum class ErrorSource : std::uint8_t { kCommunication, kDevice };

class ErrorLog {
 public:
  /// @param dictionary must outlive this; gets 1001h, 1003h and 1014h
  ErrorLog(ObjectDictionary& dictionary, std::uint8_t node);
  ErrorLog(const ErrorLog&) = delete;  // the dictionary's hooks point here
  ErrorLog& operator=(const ErrorLog&) = delete;

  /// @return the emergency to send, if there is one
  [[nodiscard]] std::optional<CanFrame> raise(std::uint16_t code, ErrorSource source);
  [[nodiscard]] std::optional<CanFrame> clear(std::uint16_t code, ErrorSource source);

  /// After the dictionary's reset. Errors of a device that was not reset stay.
  void reset(bool device_too);

 private:
  static constexpr std::size_t kHistoryMax = 8;

  struct Error {
    std::uint16_t code = 0;
    ErrorSource source = ErrorSource::kDevice;
    friend bool operator==(const Error&, const Error&) = default;
  };

  void add_history();
  void remember(std::uint16_t code);
  [[nodiscard]] bool known(std::uint16_t code) const;
  void update_register();
  [[nodiscard]] std::optional<CanFrame> emergency(std::uint16_t code) const;

  ObjectDictionary& dictionary_;
  ObjectEntry& register_;
  ObjectEntry& cob_id_;
  ObjectEntry* history_count_ = nullptr;
  std::array<ObjectEntry*, kHistoryMax> history_{};
  std::vector<Error> errors_;
};

}  // namespace tenon::sim
