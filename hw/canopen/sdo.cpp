#include "hw/canopen/sdo.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

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

/// CiA 301, 7.2.4.3.17.
constexpr std::array<std::pair<std::uint32_t, const char*>, 31> kAbortTexts = {{
    {0x05030000, "toggle bit not alternated"},
    {0x05040000, "SDO protocol timed out"},
    {0x05040001, "command not valid"},
    {0x05040002, "invalid block size"},
    {0x05040003, "invalid sequence number"},
    {0x05040004, "checksum wrong"},
    {0x05040005, "out of memory"},
    {0x06010000, "access not supported"},
    {0x06010001, "object is write-only"},
    {0x06010002, "object is read-only"},
    {0x06020000, "object does not exist"},
    {0x06040041, "object cannot be mapped to a PDO"},
    {0x06040042, "mapped objects exceed the PDO's length"},
    {0x06040043, "parameters are incompatible"},
    {0x06040047, "incompatible inside the device"},
    {0x06060000, "hardware error"},
    {0x06070010, "length does not match"},
    {0x06070012, "too long"},
    {0x06070013, "too short"},
    {0x06090011, "sub-index does not exist"},
    {0x06090030, "value out of range"},
    {0x06090031, "value too high"},
    {0x06090032, "value too low"},
    {0x06090036, "maximum is less than minimum"},
    {0x060A0023, "resource not available"},
    {0x08000000, "general error"},
    {0x08000020, "cannot be stored"},
    {0x08000021, "cannot be stored: local control"},
    {0x08000022, "cannot be stored in this device state"},
    {0x08000023, "no object dictionary"},
    {0x08000024, "no data available"},
}};

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
  const auto found = std::find_if(kAbortTexts.begin(), kAbortTexts.end(),
                                  [code](const auto& entry) { return entry.first == code; });
  return found == kAbortTexts.end() ? nullptr : found->second;
}

}  // namespace tenon::hw::canopen
