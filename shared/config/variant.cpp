#include "shared/config/variant.h"

#include <string_view>
#include <system_error>
#include <vector>

#include "shared/base/did_you_mean.h"

namespace tenon::config {
namespace {

constexpr const char* kVariants = "variants";

}  // namespace

VariantOfFile split_variant(const std::filesystem::path& name) {
  const std::string text = name.string();
  const std::size_t mark = text.rfind('#');
  std::error_code ignored;
  if (mark == std::string::npos || std::filesystem::exists(name, ignored)) return {name, {}};
  return {text.substr(0, mark), text.substr(mark + 1)};
}

std::vector<std::string> variant_names(const Value& document) {
  const std::optional<Value> variants = document.peek(kVariants);
  return variants && !variants->is_empty() ? variants->keys() : std::vector<std::string>{};
}

Value with_variant(const Value& document, const std::string& variant) {
  const std::optional<Value> variants = document.peek(kVariants);
  if (!variants) document.refuse("has no variant '" + variant + "', nor any other");
  const std::optional<Value> chosen = variants->peek(variant);
  if (!chosen) {
    const std::vector<std::string> known = variants->keys();
    std::string names;
    for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
    const std::vector<std::string_view> views(known.begin(), known.end());
    variants->refuse("has no '" + variant + "', there are: " + names +
                     did_you_mean(variant, views));
  }
  if (const auto nested = chosen->peek(kVariants)) nested->refuse("a variant has none itself");
  return document.overlaid_with(*chosen);
}

}  // namespace tenon::config
