#include "hw/check/mapping_check.h"

#include "shared/base/text.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

using Kind = MappingAnswer::Kind;

// Objects 0001h to 0007h stand for gaps of their data type.
constexpr std::uint16_t kLastDummy = 7;

MappingAnswer answer_to_gap(const DeviceFile& file, std::uint16_t type, bool received) {
  const std::string name = format("a gap of type %04Xh", static_cast<unsigned>(type));
  if (received && !file.dummies) return {Kind::kUnknown, name + ", without [DummyUsage]"};
  if (received && (*file.dummies >> type & 1U) != 0) return {};
  return {Kind::kRefused, name + " is not for its mappings (abort 0x06040041)"};
}

}  // namespace

MappingAnswer answer_to_mapping(const DeviceFile& file, std::uint16_t index, std::uint32_t entry) {
  const bool received = tenon::canopen::is_rpdo_mapping(index);
  const auto mapped = static_cast<std::uint16_t>(entry >> 16);
  const auto sub = static_cast<std::uint8_t>(entry >> 8 & 0xFF);
  const unsigned bits = entry & 0xFF;
  if (entry == 0) return {};
  if (mapped <= kLastDummy) return answer_to_gap(file, mapped, received);
  const std::string name = format("%04Xh:%u", static_cast<unsigned>(mapped), unsigned{sub});
  const DeviceObject* object = file.find(mapped, sub);
  if (object == nullptr) {
    return {Kind::kRefused, file.has_index(mapped)
                                ? name + " is no sub-index that it has (abort 0x06090011)"
                                : name + " is no object that it has (abort 0x06020000)"};
  }
  if (!(received ? object->goes_into_rpdo() : object->goes_into_tpdo())) {
    return {Kind::kRefused,
            name + format(" goes into no %cPDO (abort 0x06040041)", received ? 'R' : 'T')};
  }
  const unsigned held = data_type_bits(object->type);
  if (held == bits) return {};
  return {Kind::kRefused,
          name + format(" has %u bits where %u are mapped (abort 0x06070010)", held, bits)};
}

}  // namespace tenon::hw
