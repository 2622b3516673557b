#pragma once
// A reader of EDS files for tests, written from CiA 306 alone: sections of "key=value" lines, keys
// and sections without regard to case, numbers decimal or 0x, $NODEID in a sum.

#include <cctype>
#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace tenon::sim {

struct EdsEntry {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::string name;
  std::size_t bytes = 0;  ///< 0: a text
  bool is_signed = false;
  std::string access;
  std::string default_text;
  bool has_low = false;
  bool has_high = false;
  std::int64_t low = 0;
  std::int64_t high = 0;
  bool mappable = false;
};

class EdsFileReader {
 public:
  using Section = std::map<std::string, std::string>;

  explicit EdsFileReader(const std::string& text) {
    std::istringstream in(text);
    Section* section = nullptr;
    for (std::string line; std::getline(in, line);) {
      if (line.empty() || line.back() != '\r') throw std::runtime_error("line without CR LF");
      line.pop_back();
      if (line.empty()) continue;
      if (line.front() == '[') {
        const std::string name = lower(line.substr(1, line.size() - 2));
        if (sections.count(name) != 0) throw std::runtime_error("section twice: " + name);
        section = &sections[name];
        continue;
      }
      const std::size_t equals = line.find('=');
      if (section == nullptr || equals == std::string::npos) throw std::runtime_error(line);
      (*section)[lower(line.substr(0, equals))] = line.substr(equals + 1);
    }
  }

  [[nodiscard]] std::string value(const std::string& section, const std::string& key) const {
    return sections.at(lower(section)).at(lower(key));
  }
  [[nodiscard]] std::int64_t number(const std::string& section, const std::string& key) const {
    return number_of(value(section, key), 0);
  }

  /// The indices that a list names.
  [[nodiscard]] std::vector<std::uint16_t> listed(const std::string& list) const {
    std::vector<std::uint16_t> indices;
    for (std::int64_t i = 1; i <= number(list, "SupportedObjects"); ++i) {
      indices.push_back(static_cast<std::uint16_t>(number(list, std::to_string(i))));
    }
    return indices;
  }

  /// What can be read or written, of all listed indices.
  [[nodiscard]] std::vector<EdsEntry> entries() const {
    std::vector<EdsEntry> found;
    for (const char* list : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"}) {
      for (const std::uint16_t index : listed(list)) append(found, index);
    }
    return found;
  }

  static std::int64_t number_of(const std::string& text, std::uint8_t node) {
    if (text.rfind("$NODEID+", 0) == 0) return node + std::stoll(text.substr(8), nullptr, 0);
    return std::stoll(text, nullptr, 0);
  }

  std::map<std::string, Section> sections;

 private:
  static std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  }
  static std::string hex4(std::uint16_t index) {
    std::ostringstream out;
    out << std::hex << index;
    return out.str();
  }

  void append(std::vector<EdsEntry>& found, std::uint16_t index) const {
    const std::string name = hex4(index);
    if (number(name, "ObjectType") == 7) return found.push_back(entry(name, index, 0));
    std::int64_t subs = 0;
    for (int sub = 0; sub <= 0xFE; ++sub) {
      std::ostringstream sub_name;
      sub_name << name << "sub" << std::hex << sub;
      if (sections.count(sub_name.str()) == 0) continue;
      found.push_back(entry(sub_name.str(), index, static_cast<std::uint8_t>(sub)));
      ++subs;
    }
    if (subs != number(name, "SubNumber")) throw std::runtime_error(name + ": SubNumber");
  }

  [[nodiscard]] EdsEntry entry(const std::string& name, std::uint16_t index,
                               std::uint8_t sub) const {
    static const std::map<std::int64_t, std::pair<std::size_t, bool>> kTypes = {
        {2, {1, true}},  {3, {2, true}},  {4, {4, true}}, {5, {1, false}},
        {6, {2, false}}, {7, {4, false}}, {9, {0, false}}};
    const Section& section = sections.at(name);
    EdsEntry entry;
    entry.index = index;
    entry.sub = sub;
    entry.name = value(name, "ParameterName");
    std::tie(entry.bytes, entry.is_signed) = kTypes.at(number(name, "DataType"));
    entry.access = value(name, "AccessType");
    entry.default_text = value(name, "DefaultValue");
    entry.has_low = section.count("lowlimit") != 0;
    entry.has_high = section.count("highlimit") != 0;
    if (entry.has_low) entry.low = number(name, "LowLimit");
    if (entry.has_high) entry.high = number(name, "HighLimit");
    entry.mappable = number(name, "PDOMapping") == 1;
    return entry;
  }
};

}  // namespace tenon::sim
