#include "hw/canopen/pdo.h"

#include "shared/canopen/constants.h"

namespace tenon::hw::canopen {

using Action = ObjectSetting::Action;

void append_pdo(std::vector<ObjectSetting>& settings, const PdoConfiguration& pdo) {
  const bool transmit = pdo.direction == PdoConfiguration::Direction::kTransmit;
  const unsigned offset = pdo.number - 1u;
  const auto communication = static_cast<std::uint16_t>(
      (transmit ? tenon::canopen::kTpdoCommunication : tenon::canopen::kRpdoCommunication) +
      offset);
  const auto mapping = static_cast<std::uint16_t>(
      (transmit ? tenon::canopen::kTpdoMapping : tenon::canopen::kRpdoMapping) + offset);
  const std::uint32_t cob_id = pdo.cob_id | (transmit ? tenon::canopen::kPdoNoRtr : 0u);
  // A node may drop bit 30: nobody sends it a remote frame anyway.
  const std::uint32_t mask = ~tenon::canopen::kPdoNoRtr;

  const auto append = [&settings](Action action, std::uint16_t index, std::uint8_t sub,
                                  std::uint8_t size, std::uint32_t value,
                                  std::uint32_t compare = 0xFFFFFFFF) {
    settings.push_back({action, index, sub, size, value, compare});
  };
  const auto entry_count = static_cast<std::uint8_t>(pdo.entries.size());
  const auto append_entries = [&](Action action) {
    std::uint8_t sub = 0;
    for (const PdoEntry& entry : pdo.entries) {
      append(action, mapping, ++sub, 4,
             static_cast<std::uint32_t>(entry.index) << 16 |
                 static_cast<std::uint32_t>(entry.sub) << 8 | entry.bits);
    }
  };
  append(Action::kCompare, mapping, 0, 1, entry_count);
  append_entries(Action::kCompare);
  append(Action::kWrite, communication, 1, 4, cob_id | tenon::canopen::kPdoInvalid, mask);
  append(Action::kWrite, communication, 2, 1, pdo.transmission_type);
  append(Action::kWriteIfOther, mapping, 0, 1, 0);
  append_entries(Action::kWriteIfOther);
  append(Action::kWriteIfOther, mapping, 0, 1, entry_count);
  append(Action::kWrite, communication, 1, 4, cob_id, mask);
}

void append_unused_tpdo(std::vector<ObjectSetting>& settings, std::uint8_t node,
                        std::uint8_t number) {
  const unsigned offset = number - 1u;
  const std::uint32_t predefined = tenon::canopen::kTpdo1 + 0x100u * offset + node;
  settings.push_back({Action::kWriteIfExists,
                      static_cast<std::uint16_t>(tenon::canopen::kTpdoCommunication + offset), 1, 4,
                      tenon::canopen::kPdoInvalid | tenon::canopen::kPdoNoRtr | predefined,
                      tenon::canopen::kPdoInvalid});
}

}  // namespace tenon::hw::canopen
