#pragma once
// The words of a text file, line by line. Pure; no copy of the text.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "shared/base/error.h"

namespace tenon {

class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {}

  /// The words of the next line, `#` and what follows left out. False at the end of the text.
  [[nodiscard]] bool next(std::vector<std::string_view>& words) {
    if (rest_.empty()) return false;
    ++number_;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    line = line.substr(0, line.find('#'));
    words.clear();
    constexpr std::string_view kBlank = " \t\r\v\f";
    for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;
         at = line.find_first_not_of(kBlank, at)) {
      const std::size_t behind = std::min(line.find_first_of(kBlank, at), line.size());
      words.push_back(line.substr(at, behind - at));
      at = behind;
    }
    return true;
  }

  [[nodiscard]] std::size_t number() const { return number_; }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError("line " + std::to_string(number_) + ": " + what);
  }

  /// A finite number.
  [[nodiscard]] double number_of(std::string_view word) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      refuse("'" + std::string(word) + "' must be a finite number");
    }
    return value;
  }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

}  // namespace tenon
