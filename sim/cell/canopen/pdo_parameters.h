#pragma once
// Communication and mapping parameters of one PDO (CiA 301, 7.5.2.35 to 38). They live in the
// object dictionary; this puts them there with the rules of changing them:
//   the identifier     changes only while bit 31 says invalid
//   a mapping entry    changes only while its sub-index 0 is 0
//   the entries' count changes only while the PDO is invalid
//   inhibit time and SYNC start value change only while the PDO is invalid
// and reads them back. Sub-index 4 does not exist, 6 only of what is sent. One thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/cell/canopen/object_dictionary.h"

namespace tenon::sim {

enum class PdoDirection : std::uint8_t { kReceive, kTransmit };

struct PdoDefaults {
  std::uint32_t cob_id = 0;  ///< with bit 31 where it starts invalid
  std::uint8_t transmission_type = 255;
  std::vector<std::uint32_t> mapping;  ///< index << 16 | sub-index << 8 | bits
};

class PdoParameters {
 public:
  /// @param number from 0  @param dictionary must outlive this
  PdoParameters(ObjectDictionary& dictionary, PdoDirection direction, std::uint8_t number,
                const PdoDefaults& defaults);
  PdoParameters(const PdoParameters&) = delete;  // the dictionary's hooks point here
  PdoParameters& operator=(const PdoParameters&) = delete;

  [[nodiscard]] bool valid() const;
  [[nodiscard]] std::uint32_t cob_id() const;
  /// Bit 30 of the COB-ID is clear: a remote frame may ask for the PDO.
  [[nodiscard]] bool remote_allowed() const;
  [[nodiscard]] std::uint8_t transmission_type() const;
  /// Types 0 to 240: tied to SYNC.
  [[nodiscard]] bool synchronous() const { return transmission_type() <= 240; }
  [[nodiscard]] std::int64_t inhibit_ns() const;
  /// Sent: the period of repetition. Received: the deadline for the next one.
  [[nodiscard]] std::int64_t event_timer_ns() const;
  /// Counter value of the SYNC that counts as the first; 0: any.
  [[nodiscard]] std::uint8_t sync_start() const;
  [[nodiscard]] std::size_t mapped_count() const;
  /// i < mapped_count(); null: a dummy of bits(i) bits.
  [[nodiscard]] ObjectEntry* mapped(std::size_t i) const;
  [[nodiscard]] ObjectId mapped_id(std::size_t i) const;
  [[nodiscard]] std::size_t bytes(std::size_t i) const;
  [[nodiscard]] std::size_t total_bytes() const;

 private:
  static constexpr std::size_t kEntriesMax = 8;

  void add_communication(const PdoDefaults& defaults);
  void add_mapping(const PdoDefaults& defaults);
  [[nodiscard]] std::uint32_t check_cob_id(std::int64_t value) const;
  [[nodiscard]] std::uint32_t check_count(std::int64_t count) const;
  [[nodiscard]] std::uint32_t check_entry(std::int64_t mapping) const;
  /// For what may change only while the PDO is invalid.
  [[nodiscard]] std::uint32_t check_invalid() const;

  ObjectDictionary& dictionary_;
  PdoDirection direction_;
  std::uint16_t communication_;
  std::uint16_t mapping_;
  // Into the dictionary, set by the constructor.
  ObjectEntry* cob_id_ = nullptr;
  ObjectEntry* transmission_type_ = nullptr;
  ObjectEntry* inhibit_ = nullptr;
  ObjectEntry* event_timer_ = nullptr;
  ObjectEntry* sync_start_ = nullptr;  ///< sent PDOs only
  ObjectEntry* count_ = nullptr;
  std::array<ObjectEntry*, kEntriesMax> entries_{};
};

/// Identifiers that no PDO, SYNC or EMCY may take (CiA 301, table of restricted COB-IDs).
[[nodiscard]] bool is_restricted_cob_id(std::uint32_t id);

}  // namespace tenon::sim
