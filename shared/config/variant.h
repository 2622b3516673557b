#pragma once
// Several settings in one file. Under the top-level key `variants` stand mappings by name, each of
// the same keys as the file; the one that is asked for is laid over the file. Offline.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "shared/config/yaml_value.h"

namespace tenon::config {

/// "FILE#VARIANT" taken apart.
struct VariantOfFile {
  std::filesystem::path file;
  std::optional<std::string> variant;
};
/// A file whose own name holds a '#' is taken as it is.
[[nodiscard]] VariantOfFile split_variant(const std::filesystem::path& name);

/// In the file's order.
[[nodiscard]] std::vector<std::string> variant_names(const Value& document);

/// The document with this variant laid over it. Refuses one that is not there.
[[nodiscard]] Value with_variant(const Value& document, const std::string& variant);

}  // namespace tenon::config
