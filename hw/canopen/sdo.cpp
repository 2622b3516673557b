#include "hw/canopen/sdo.h"

#include <algorithm>
#include <cassert>

#include "shared/base/bytes.h"
#include "shared/canopen/constants.h"

namespace tenon::hw::canopen {
namespace {

CanFrame request(std::uint8_t node, unsigned command) {
  CanFrame frame;
  frame.id = tenon::canopen::kSdoRequest + node;
  frame.length = 8;
  frame.data[0] = static_cast<std::uint8_t>(command);
  return frame;
}

CanFrame request(const SdoAddress& address, unsigned command) {
  CanFrame frame = request(address.node, command);
  store_le(std::span(frame.data).subspan(1), address.index);
  frame.data[3] = address.sub;
  return frame;
}

}  // namespace

CanFrame sdo_download_expedited(const SdoAddress& address, std::span<const std::uint8_t> data) {
  assert(!data.empty() && data.size() <= 4);
  CanFrame frame = request(address, 0x23u | static_cast<unsigned>(4 - data.size()) << 2);
  std::copy(data.begin(), data.end(), frame.data.begin() + 4);
  return frame;
}

CanFrame sdo_download_segmented(const SdoAddress& address, std::uint32_t size_bytes) {
  CanFrame frame = request(address, 0x21u);
  store_le(std::span(frame.data).subspan(4), size_bytes);
  return frame;
}

CanFrame sdo_download_segment(std::uint8_t node, bool toggle, bool last,
                              std::span<const std::uint8_t> data) {
  assert(!data.empty() && data.size() <= 7);
  const unsigned unused = static_cast<unsigned>(7 - data.size());
  CanFrame frame = request(node, (toggle ? 0x10u : 0u) | unused << 1 | (last ? 1u : 0u));
  std::copy(data.begin(), data.end(), frame.data.begin() + 1);
  return frame;
}

CanFrame sdo_upload(const SdoAddress& address) { return request(address, 0x40u); }

CanFrame sdo_upload_segment(std::uint8_t node, bool toggle) {
  return request(node, toggle ? 0x70u : 0x60u);
}

CanFrame sdo_abort(const SdoAddress& address, std::uint32_t code) {
  CanFrame frame = request(address, 0x80u);
  store_le(std::span(frame.data).subspan(4), code);
  return frame;
}

const char* sdo_abort_text(std::uint32_t code) {
  switch (code) {
    case 0x05030000:
      return "toggle bit not alternated";
    case 0x05040000:
      return "SDO protocol timed out";
    case 0x05040001:
      return "command not valid";
    case 0x05040005:
      return "out of memory";
    case 0x06010000:
      return "access not supported";
    case 0x06010001:
      return "object is write-only";
    case 0x06010002:
      return "object is read-only";
    case 0x06020000:
      return "object does not exist";
    case 0x06040041:
      return "object cannot be mapped to a PDO";
    case 0x06040042:
      return "mapped objects exceed the PDO's length";
    case 0x06040043:
      return "parameters are incompatible";
    case 0x06040047:
      return "incompatible inside the device";
    case 0x06060000:
      return "hardware error";
    case 0x06070010:
      return "length does not match";
    case 0x06070012:
      return "too long";
    case 0x06070013:
      return "too short";
    case 0x06090011:
      return "sub-index does not exist";
    case 0x06090030:
      return "value out of range";
    case 0x06090031:
      return "value too high";
    case 0x06090032:
      return "value too low";
    case 0x06090036:
      return "maximum is less than minimum";
    case 0x08000000:
      return "general error";
    case 0x08000020:
      return "cannot be stored";
    case 0x08000021:
      return "cannot be stored: local control";
    case 0x08000022:
      return "cannot be stored in this device state";
    case 0x08000023:
      return "no object dictionary";
  }
  return nullptr;
}

}  // namespace tenon::hw::canopen
