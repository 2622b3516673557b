#pragma once
// Frames of SDO transfers, client's side (CiA 301, 7.2.4.3). Pure functions; SdoClient strings them
// together. All frames have 8 bytes; requests leave on 600h + node, answers come on 580h + node.
//
//   | byte 0 of a request          |                                  | bytes 1-7              |
//   | 20h | (4-n) << 2 | 3         | download n = 1..4 bytes, expedited | index, sub, data       |
//   | 21h                          | download, segmented               | index, sub, u32 size   |
//   | t << 4 | (7-n) << 1 | last   | download segment of n bytes       | data                   |
//   | 40h                          | upload                            | index, sub, 0          |
//   | 60h | t << 4                 | upload segment                    | 0                      |
//   | 80h                          | abort                             | index, sub, u32 code   |
//
//   | byte 0 of an answer          |                                  | bytes 1-7              |
//   | 60h                          | download accepted                 | index, sub             |
//   | 20h | t << 4                 | segment accepted                  |                        |
//   | 40h | (4-n) << 2 | 3         | uploaded n = 1..4 bytes, expedited | index, sub, data       |
//   | 42h                          | the same, size not indicated: 4   | index, sub, data       |
//   | 41h                          | upload, segmented                 | index, sub, u32 size   |
//   | t << 4 | (7-n) << 1 | last   | uploaded segment of n bytes       | data                   |
//   | 80h                          | abort                             | index, sub, u32 code   |
//
// t is the toggle bit, 0 in the first segment.

#include <cstddef>
#include <cstdint>
#include <span>

#include "shared/ports/can_bus.h"

namespace tenon::hw::canopen {

/// An object's entry on a node.
struct SdoAddress {
  std::uint8_t node = 0;
  std::uint16_t index = 0;
  std::uint8_t sub = 0;

  friend bool operator==(const SdoAddress&, const SdoAddress&) = default;
};

/// @param data 1..4 bytes
[[nodiscard]] CanFrame sdo_download_expedited(const SdoAddress& address,
                                              std::span<const std::uint8_t> data);
[[nodiscard]] CanFrame sdo_download_segmented(const SdoAddress& address, std::uint32_t size_bytes);
/// @param data 1..7 bytes
[[nodiscard]] CanFrame sdo_download_segment(std::uint8_t node, bool toggle, bool last,
                                            std::span<const std::uint8_t> data);
[[nodiscard]] CanFrame sdo_upload(const SdoAddress& address);
[[nodiscard]] CanFrame sdo_upload_segment(std::uint8_t node, bool toggle);
[[nodiscard]] CanFrame sdo_abort(const SdoAddress& address, std::uint32_t code);

/// What an abort code means, nullptr where CiA 301 does not list it.
[[nodiscard]] const char* sdo_abort_text(std::uint32_t code);

}  // namespace tenon::hw::canopen
