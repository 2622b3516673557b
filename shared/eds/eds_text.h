#pragma once
// Numbers and names of sections as EDS files write them (CiA 306-1). Pure.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "shared/eds/device_file.h"

namespace tenon {

/// All of a text, without a sign; unset: it is no number of that base.
[[nodiscard]] std::optional<std::uint64_t> digits(std::string_view text, int base);

/// Decimal, 0x.., or octal with a leading 0, as in C; with a sign. 64 bits as they are.
[[nodiscard]] std::optional<std::int64_t> parsed_number(std::string_view text);

/// A sum of numbers: "0x40000180", "0x40000000+0x180".
[[nodiscard]] std::optional<std::int64_t> parsed_sum(std::string_view text);

/// Without what stands behind a semicolon, as some write a comment.
[[nodiscard]] std::string without_comment(const std::string& text);

/// "1018" or "1018sub0" of a section's name in small letters.
[[nodiscard]] std::optional<DeviceObjectId> object_of_section(const std::string& name);

/// How the names of a record's sections begin: "1018sub".
[[nodiscard]] std::string sub_prefix(std::uint16_t index);

}  // namespace tenon
