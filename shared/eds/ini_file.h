#pragma once
// Sections of "key=value" lines as EDS files have them: names in any case, comments after a
// semicolon, any end of line. Set-up code, allocates, pure.

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tenon {

/// Text in small letters, ASCII.
[[nodiscard]] std::string lower_case(std::string_view text);
/// Without white space at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

struct IniValue {
  std::string text;
  int line = 0;
};

struct IniSection {
  std::string name;  ///< as it stands in the file
  int line = 0;
  std::map<std::string, IniValue> values;  ///< by the key in small letters

  [[nodiscard]] const IniValue* find(const std::string& key) const {
    const auto found = values.find(key);
    return found == values.end() ? nullptr : &found->second;
  }
};

class IniFile {
 public:
  /// Doubles that agree are read once and listed among the slips. Of those that contradict each
  /// other the first is taken where nothing is decided by the key; else they are refused. Throws
  /// InputError.
  /// @param deciding keys in small letters
  IniFile(const std::string& name, const std::string& text,
          std::span<const std::string_view> deciding);

  [[nodiscard]] const std::map<std::string, IniSection>& sections() const { return sections_; }
  /// @param key in small letters
  [[nodiscard]] const IniSection* find(const std::string& key) const;
  /// At most 200, and then how many more there were.
  [[nodiscard]] std::vector<std::string> take_slips();

  /// "FILE:LINE: "
  [[nodiscard]] std::string place(int line) const;
  void slip(int line, const std::string& what);
  [[noreturn]] void refuse(int line, const std::string& what) const;

 private:
  IniSection* open_section(std::string_view line, int number);
  void add_value(IniSection& section, std::string_view line, int number,
                 std::span<const std::string_view> deciding);

  std::string name_;
  std::map<std::string, IniSection> sections_;  ///< by the name in small letters, without blanks
  std::vector<std::string> slips_;
  std::size_t slips_untold_ = 0;
};

}  // namespace tenon
