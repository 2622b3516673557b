#include "shared/eds/ini_file.h"

#include <algorithm>

#include "shared/base/error.h"
#include "shared/base/printable.h"
#include "shared/eds/eds_text.h"

namespace tenon {
namespace {

constexpr std::size_t kSlipsMax = 200;
constexpr std::size_t kShownMax = 60;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\0' || c == '\v' || c == '\f'; }

std::string shown(std::string_view text) { return shortened(std::string(text), kShownMax); }

/// Names are compared without blanks and without case, an index without its 0x.
std::string key_of_section(std::string_view name) {
  std::string key = lower_case(name);
  std::erase_if(key, is_space);
  if (key.starts_with("0x")) key.erase(0, 2);
  return key;
}

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

/// 7, 0x7 and 0x07 are one number.
bool is_same(const std::string& a, const std::string& b) {
  if (lower_case(a) == lower_case(b)) return true;
  const auto number = parsed_number(without_comment(a));
  return number && number == parsed_number(without_comment(b));
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

IniFile::IniFile(const std::string& name, const std::string& text,
                 std::span<const std::string_view> deciding)
    : name_(name) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view rest = text;
  if (rest.starts_with("\xFF\xFE") || rest.starts_with("\xFE\xFF")) {
    refuse(1, "is in UTF-16; save it as plain text (ASCII or UTF-8)");
  }
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  IniSection* section = nullptr;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find_first_of("\r\n");
    const std::string_view line = trimmed(rest.substr(0, end));
    if (end == std::string_view::npos) {
      rest = {};
    } else {
      rest.remove_prefix(rest.substr(end).starts_with("\r\n") ? end + 2 : end + 1);
    }
    if (line.empty() || line.front() == ';' || line.front() == '#') continue;
    if (line.front() == '[') {
      section = open_section(line, number);
    } else if (section == nullptr) {
      slip(number, "stands before the first section and is ignored: " + shown(line));
    } else {
      add_value(*section, line, number, deciding);
    }
  }
}

IniSection* IniFile::open_section(std::string_view line, int number) {
  const std::size_t end = line.find(']');
  if (end == std::string_view::npos) refuse(number, shown(line) + " lacks its ]");
  const std::string name(trimmed(line.substr(1, end - 1)));
  const auto [found, fresh] = sections_.try_emplace(key_of_section(name));
  if (fresh) {
    found->second = {name, number, {}};
  } else {
    slip(number, "section [" + shown(name) + "] stands in line " +
                     std::to_string(found->second.line) + " already; both are read as one");
  }
  return &found->second;
}

void IniFile::add_value(IniSection& section, std::string_view line, int number,
                        std::span<const std::string_view> deciding) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) {
    return slip(number, "is no key=value and is ignored: " + shown(line));
  }
  const std::string key = lower_case(trimmed(line.substr(0, equals)));
  const std::string text(unquoted(trimmed(line.substr(equals + 1))));
  const auto [found, fresh] = section.values.try_emplace(key, IniValue{text, number});
  if (fresh || is_same(found->second.text, text)) return;
  const std::string both = "[" + shown(section.name) + "] " + shown(key) + " = " + shown(text) +
                           " contradicts line " + std::to_string(found->second.line) +
                           ", which says " + shown(found->second.text);
  if (std::find(deciding.begin(), deciding.end(), key) != deciding.end()) {
    refuse(number, both + "; remove one of them");
  }
  slip(number, both + "; the first is taken");
}

const IniSection* IniFile::find(const std::string& key) const {
  const auto found = sections_.find(key);
  return found == sections_.end() ? nullptr : &found->second;
}

std::string IniFile::place(int line) const { return name_ + ":" + std::to_string(line) + ": "; }

void IniFile::slip(int line, const std::string& what) {
  if (slips_.size() < kSlipsMax) {
    slips_.push_back(printable(place(line) + what));
  } else {
    ++slips_untold_;
  }
}

std::vector<std::string> IniFile::take_slips() {
  if (slips_untold_ > 0) {
    slips_.push_back(name_ + ": and " + std::to_string(slips_untold_) + " slips more");
  }
  return std::move(slips_);
}

void IniFile::refuse(int line, const std::string& what) const {
  throw InputError(place(line) + what);
}

}  // namespace tenon
