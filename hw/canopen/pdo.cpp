#include "hw/canopen/pdo.h"

#include "shared/canopen/constants.h"

namespace tenon::hw::canopen {

using Action = ObjectSetting::Action;

namespace {

/// Of a PDO's communication parameters: bit 31 is off while anything changes.
void append_communication(std::vector<ObjectSetting>& settings, std::uint16_t index,
                          std::uint32_t cob_id, const PdoConfiguration& pdo,
                          const PdoFreedom& freedom) {
  // A node may drop bit 30: nobody sends it a remote frame anyway.
  const std::uint32_t mask = ~tenon::canopen::kPdoNoRtr;
  const std::uint32_t off = cob_id | tenon::canopen::kPdoInvalid;
  if (freedom.identifier) {
    settings.push_back({Action::kWrite, index, 1, 4, off, mask});
  } else if (freedom.mapping) {
    settings.push_back({Action::kWriteIfOther, index, 1, 4, off, mask});
  }
  if (freedom.transmission_type) {
    settings.push_back({Action::kWrite, index, 2, 1, pdo.transmission_type});
  }
}

void append_communication_on(std::vector<ObjectSetting>& settings, std::uint16_t index,
                             std::uint32_t cob_id, const PdoConfiguration& pdo,
                             const PdoFreedom& freedom) {
  const std::uint32_t mask = ~tenon::canopen::kPdoNoRtr;
  if (freedom.identifier) {
    settings.push_back({Action::kWrite, index, 1, 4, cob_id, mask});
  } else {
    if (freedom.mapping) settings.push_back({Action::kWriteIfOther, index, 1, 4, cob_id, mask});
    settings.push_back({Action::kExpect, index, 1, 4, cob_id, mask});
  }
  if (!freedom.transmission_type && pdo.direction == PdoConfiguration::Direction::kTransmit) {
    settings.push_back({Action::kExpect, index, 2, 1, pdo.transmission_type});
  }
}

}  // namespace

void append_pdo(std::vector<ObjectSetting>& settings, const PdoConfiguration& pdo,
                const PdoFreedom& freedom) {
  const bool transmit = pdo.direction == PdoConfiguration::Direction::kTransmit;
  const unsigned offset = pdo.number - 1u;
  const auto communication = static_cast<std::uint16_t>(
      (transmit ? tenon::canopen::kTpdoCommunication : tenon::canopen::kRpdoCommunication) +
      offset);
  const auto mapping = static_cast<std::uint16_t>(
      (transmit ? tenon::canopen::kTpdoMapping : tenon::canopen::kRpdoMapping) + offset);
  const std::uint32_t cob_id = pdo.cob_id | (transmit ? tenon::canopen::kPdoNoRtr : 0u);
  const auto entry_count = static_cast<std::uint8_t>(pdo.entries.size());
  const auto append_entries = [&](Action action) {
    std::uint8_t sub = 0;
    for (const PdoEntry& entry : pdo.entries) {
      settings.push_back({action, mapping, ++sub, 4,
                          static_cast<std::uint32_t>(entry.index) << 16 |
                              static_cast<std::uint32_t>(entry.sub) << 8 | entry.bits});
    }
  };
  const Action look = freedom.mapping ? Action::kCompare : Action::kExpect;
  settings.push_back({look, mapping, 0, 1, entry_count});
  append_entries(look);
  append_communication(settings, communication, cob_id, pdo, freedom);
  if (freedom.mapping) {
    settings.push_back({Action::kWriteIfOther, mapping, 0, 1, 0});
    append_entries(Action::kWriteIfOther);
    settings.push_back({Action::kWriteIfOther, mapping, 0, 1, entry_count});
  }
  append_communication_on(settings, communication, cob_id, pdo, freedom);
}

void append_optional_pdo(std::vector<ObjectSetting>& settings, const PdoConfiguration& pdo) {
  std::vector<ObjectSetting> all;
  append_pdo(all, pdo, {});
  for (ObjectSetting& setting : all) {
    if (setting.action == Action::kCompare) continue;
    setting.action = Action::kTry;
    settings.push_back(setting);
  }
}

void append_unused_pdo(std::vector<ObjectSetting>& settings, PdoConfiguration::Direction direction,
                       std::uint8_t node, std::uint8_t number) {
  const bool transmit = direction == PdoConfiguration::Direction::kTransmit;
  const unsigned offset = number - 1u;
  const std::uint32_t base =
      transmit ? tenon::canopen::kTpdo1 | tenon::canopen::kPdoNoRtr : tenon::canopen::kRpdo1;
  const auto index = static_cast<std::uint16_t>(
      (transmit ? tenon::canopen::kTpdoCommunication : tenon::canopen::kRpdoCommunication) +
      offset);
  // One that stays on to receive does no harm: nobody sends it.
  settings.push_back({transmit ? Action::kWrite : Action::kWriteOrTake, index, 1, 4,
                      tenon::canopen::kPdoInvalid | (base + 0x100u * offset + node),
                      tenon::canopen::kPdoInvalid, true});
}

}  // namespace tenon::hw::canopen
